#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <string_view>

namespace clearway::prediction {

/// One input of a net: a quantity divided by `scale` and clamped to +-`most`.
struct NetInput {
    std::string_view name;
    std::string_view unit;  ///< Of the quantity: `m`, `1` without a dimension, `flag` for 0 or 1.
    float scale = 1.0F;     ///< In the unit.
    float most = std::numeric_limits<float>::infinity();
    std::string_view doc;

    float number(float quantity) const { return std::clamp(quantity / scale, -most, most); }
};

/// A number without a bound.
inline constexpr float unbounded = std::numeric_limits<float>::infinity();

/// Place of an input in its table, at compile time: a name that the table lacks does not compile.
template <std::size_t Count>
consteval std::size_t input_index(const std::array<NetInput, Count>& table, std::string_view name) {
    for (std::size_t at = 0; at < Count; ++at) {
        if (table[at].name == name) return at;
    }
    throw std::logic_error("no input of this name");
}

/// Writes quantities into a row of numbers, one for each input of a table.
class NetInputRow {
  public:
    /// `numbers` has one entry per input of the table; entries that are not set keep their values.
    NetInputRow(std::span<const NetInput> table, std::span<float> numbers)
        : table_(table), numbers_(numbers) {
        assert(table.size() == numbers.size());
    }

    void set(std::size_t input, float quantity) {
        numbers_[input] = table_[input].number(quantity);
        assert(std::isfinite(numbers_[input]));
    }
    void set(std::size_t input, bool condition) { numbers_[input] = condition ? 1.0F : 0.0F; }

  private:
    std::span<const NetInput> table_;
    std::span<float> numbers_;
};

}  // namespace clearway::prediction
