#include "python/sheet.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clearway::python {

std::string to_json(std::span<const Column> columns) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Column& column : columns)
        list.push_back({column.name, column.type, column.unit, column.doc});
    return list.dump();
}

void Sheet::clear() {
    end_ = align(columns_.size() * sizeof(Entry));
    for (std::size_t number = 0; number < columns_.size(); ++number)
        entry(number) = {0, 0};
}

void Sheet::check_type(std::size_t number, std::size_t size) const {
    const char* const type = columns_[number].type;
    if (static_cast<std::size_t>(type[1] - '0') != size)
        throw std::logic_error(fmt::format("column {} is {}", columns_[number].name, type));
}

std::byte* Sheet::take(std::size_t number, std::size_t count, std::size_t size) {
    const std::size_t offset = end_;
    if (offset + count * size > memory_.size())
        throw std::length_error(fmt::format("{} does not fit into {} bytes of shared memory",
                                            columns_[number].name, memory_.size()));
    entry(number) = {offset, count};
    end_ = align(offset + count * size);
    return memory_.data() + offset;
}

const std::byte* Sheet::find(std::size_t number, std::size_t size, std::size_t& count) const {
    const Entry found = entry(number);
    const bool fits = found.offset <= memory_.size() && found.count <= (memory_.size() - found.offset) / size;
    if (!fits) throw std::out_of_range(fmt::format("{} lies outside the memory", columns_[number].name));
    count = found.count;
    return memory_.data() + found.offset;
}

}  // namespace clearway::python
