#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "core/ids.hpp"

namespace clearway::trace::detail {

// Numbers as their difference from what a reader can foresee, in the fewest bytes: 7 bits a byte, the sign
// lowest. Reals are compared by their order among all reals of their size, so that neighbours differ by 1 and
// every bit comes back. `NumberWriter` and `NumberReader` have the same functions, so that one description of
// a struct serves both ways.

/// Place of a real among all of its size, NaN included; its own inverse.
constexpr std::int32_t order_of(std::int32_t bits) {
    return bits ^ ((bits >> 31) & std::numeric_limits<std::int32_t>::max());
}
constexpr std::int64_t order_of(std::int64_t bits) {
    return bits ^ ((bits >> 63) & std::numeric_limits<std::int64_t>::max());
}
/// Arithmetic does not define which not-a-number it gives: none is foreseen.
template <class Real>
Real number_or_zero(Real foreseen) {
    return std::isnan(foreseen) ? Real{0} : foreseen;
}
template <class Real>
using BitsOf = std::conditional_t<sizeof(Real) == sizeof(float), std::int32_t, std::int64_t>;

/// Difference modulo 2^64 with the sign lowest, and back.
constexpr std::uint64_t folded(std::uint64_t value, std::uint64_t foreseen) {
    const std::uint64_t difference = value - foreseen;
    return (difference << 1) ^ (0 - (difference >> 63));
}
constexpr std::uint64_t unfolded(std::uint64_t folded_difference, std::uint64_t foreseen) {
    return foreseen + ((folded_difference >> 1) ^ (0 - (folded_difference & 1)));
}

class NumberWriter {
  public:
    static constexpr bool reading = false;

    /// Integers and booleans.
    template <class Integer>
    void number(const Integer& value, std::type_identity_t<Integer> foreseen = {}) {
        put(folded(static_cast<std::uint64_t>(value), static_cast<std::uint64_t>(foreseen)));
    }
    template <class Tag>
    void number(const core::Index<Tag>& value, core::Index<Tag> foreseen = {}) {
        number(value.value, foreseen.value);
    }
    /// An enumerator below `count`.
    template <class Enum>
    void choice(const Enum& value, std::type_identity_t<Enum> foreseen, std::uint64_t /*count*/) {
        put(folded(static_cast<std::uint64_t>(value), static_cast<std::uint64_t>(foreseen)));
    }
    template <class Real>
    void real(const Real& value, std::type_identity_t<Real> foreseen = {}) {
        const std::int64_t order = order_of(std::bit_cast<BitsOf<Real>>(value));
        const std::int64_t expected = order_of(std::bit_cast<BitsOf<Real>>(number_or_zero(foreseen)));
        put(folded(static_cast<std::uint64_t>(order), static_cast<std::uint64_t>(expected)));
    }
    void size(std::size_t value) { put(value); }
    /// A text that may come again.
    void text(std::string_view value) {
        const auto [known, is_new] = texts_.try_emplace(std::string(value), texts_.size() + 1);
        put(is_new ? 0 : known->second);
        if (is_new) characters(value);
    }
    void characters(std::string_view value) {
        put(value.size());
        bytes_.append(value);
        if (!value.empty()) all_foreseen_ = false;
    }
    /// A vehicle: by its row in the roster when it is there.
    void key(const core::VehicleKey& value) {
        const auto known = rows_.find(value);
        put(known == rows_.end() ? 0 : known->second + 1);
        if (known == rows_.end()) put(value.value);
    }
    void register_key(core::VehicleKey value) { rows_.try_emplace(value, rows_.size()); }

    /// Numbers until `end_column` cost one byte when all are as foreseen.
    void begin_column() {
        column_ = bytes_.size();
        bytes_ += '\1';
        all_foreseen_ = true;
    }
    void end_column() {
        if (!all_foreseen_) return;
        bytes_.resize(column_ + 1);
        bytes_[column_] = '\0';
    }

    const std::string& bytes() const { return bytes_; }
    void clear() { bytes_.clear(); }

  private:
    void put(std::uint64_t word) {
        if (word != 0) all_foreseen_ = false;
        while (word >= 0x80) {
            bytes_ += static_cast<char>(word | 0x80);
            word >>= 7;
        }
        bytes_ += static_cast<char>(word);
    }

    std::string bytes_;
    std::size_t column_ = 0;
    bool all_foreseen_ = false;
    std::unordered_map<std::string, std::uint64_t> texts_;
    std::unordered_map<core::VehicleKey, std::uint64_t> rows_;
};

/// Throws std::runtime_error for bytes that no writer wrote.
class NumberReader {
  public:
    static constexpr bool reading = true;

    /// `bytes` outlive the reading of them.
    void open(std::string_view bytes) { rest_ = bytes; }
    bool at_end() const { return rest_.empty(); }

    template <class Integer>
    void number(Integer& value, std::type_identity_t<Integer> foreseen = {}) {
        const std::uint64_t word = unfolded(take(), static_cast<std::uint64_t>(foreseen));
        value = static_cast<Integer>(word);
        if (static_cast<std::uint64_t>(value) != word) throw std::runtime_error("a number is out of range");
    }
    template <class Tag>
    void number(core::Index<Tag>& value, core::Index<Tag> foreseen = {}) {
        number(value.value, foreseen.value);
    }
    template <class Enum>
    void choice(Enum& value, std::type_identity_t<Enum> foreseen, std::uint64_t count) {
        const std::uint64_t word = unfolded(take(), static_cast<std::uint64_t>(foreseen));
        if (word >= count) throw std::runtime_error("a choice is unknown");
        value = static_cast<Enum>(word);
    }
    template <class Real>
    void real(Real& value, std::type_identity_t<Real> foreseen = {}) {
        const std::int64_t expected = order_of(std::bit_cast<BitsOf<Real>>(number_or_zero(foreseen)));
        const auto order = static_cast<std::int64_t>(unfolded(take(), static_cast<std::uint64_t>(expected)));
        const auto bits = static_cast<BitsOf<Real>>(order);
        if (bits != order) throw std::runtime_error("a number is out of range");
        value = std::bit_cast<Real>(order_of(bits));
    }
    /// Of a list whose elements take at least one byte each.
    std::size_t size() {
        const std::uint64_t value = take();
        if (value > rest_.size()) throw std::runtime_error("a list is longer than its block");
        return value;
    }
    /// Lives as long as this object.
    const std::string& text() {
        const std::uint64_t known = take();
        if (known > texts_.size()) throw std::runtime_error("a text is unknown");
        if (known != 0) return texts_[known - 1];
        texts_.push_back(characters());
        return texts_.back();
    }
    std::string characters() {
        const std::size_t length = size();
        std::string value(rest_.substr(0, length));
        rest_.remove_prefix(length);
        return value;
    }
    void key(core::VehicleKey& value) {
        const std::uint64_t known = take();
        if (known > keys_.size()) throw std::runtime_error("a vehicle is unknown");
        value = known != 0 ? keys_[known - 1] : core::VehicleKey{take()};
    }
    void register_key(core::VehicleKey value) { keys_.push_back(value); }

    void begin_column() { all_foreseen_ = take() == 0; }
    void end_column() { all_foreseen_ = false; }

  private:
    std::uint64_t take() {
        if (all_foreseen_) return 0;
        std::uint64_t word = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            if (rest_.empty()) throw std::runtime_error("a block ends within a step");
            const auto byte = static_cast<unsigned char>(rest_.front());
            rest_.remove_prefix(1);
            word |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
            if (byte < 0x80) return word;
        }
        throw std::runtime_error("a number is too long");
    }

    std::string_view rest_;
    bool all_foreseen_ = false;
    std::deque<std::string> texts_;
    std::vector<core::VehicleKey> keys_;
};

}  // namespace clearway::trace::detail
