#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace clearway::python {

/// An array of a sheet.
struct Column {
    const char* name;
    const char* type;  ///< As numpy spells it: `f4`, `u8`, ...
    const char* unit;
    const char* doc;
};

/// Name, type and meaning of each column, as the other side gets it once: a JSON array of arrays.
std::string to_json(std::span<const Column> columns);

/// Arrays in memory that two processes share. At the front stands a directory, for each column offset and
/// number of elements (u64 each); then the arrays, each at a multiple of 64 bytes. One process writes, the
/// other reads; whoever has rung last has handed the memory over (Channel).
class Sheet {
  public:
    /// `columns` outlives the sheet.
    Sheet(std::span<std::byte> memory, std::span<const Column> columns)
        : memory_(memory), columns_(columns), end_(align(columns.size() * sizeof(Entry))) {}

    /// Forgets all arrays.
    void clear();
    /// Room for `count` elements of the column `number`, not initialised, valid until `clear`. Throws
    /// std::length_error when the memory is full, std::logic_error for another type than the column's.
    template <class Value>
    std::span<Value> room(std::size_t number, std::size_t count) {
        check_type(number, sizeof(Value));
        return {reinterpret_cast<Value*>(take(number, count, sizeof(Value))), count};
    }
    template <class Value>
    void put(std::size_t number, const std::vector<Value>& values) {
        const std::span<Value> target = room<Value>(number, values.size());
        if (!values.empty()) std::memcpy(target.data(), values.data(), values.size() * sizeof(Value));
    }
    /// An array that the other side wrote. Throws std::out_of_range when it does not lie in the memory.
    template <class Value>
    std::span<const Value> read(std::size_t number) const {
        check_type(number, sizeof(Value));
        std::size_t count = 0;
        const std::byte* const begin = find(number, sizeof(Value), count);
        return {reinterpret_cast<const Value*>(begin), count};
    }

  private:
    struct Entry {
        std::uint64_t offset;
        std::uint64_t count;
    };
    static constexpr std::size_t align(std::size_t offset) { return (offset + 63) / 64 * 64; }
    Entry& entry(std::size_t number) const { return reinterpret_cast<Entry*>(memory_.data())[number]; }
    void check_type(std::size_t number, std::size_t size) const;
    std::byte* take(std::size_t number, std::size_t count, std::size_t size);
    const std::byte* find(std::size_t number, std::size_t size, std::size_t& count) const;

    std::span<std::byte> memory_;
    std::span<const Column> columns_;
    std::size_t end_;
};

}  // namespace clearway::python
