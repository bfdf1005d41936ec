#include "sumo/detail/name_table.hpp"

#include <stdexcept>
#include <utility>

namespace clearway::sumo::detail {
namespace {

std::unordered_map<std::string, std::uint32_t> rows_of(const std::vector<std::string>& names) {
    std::unordered_map<std::string, std::uint32_t> rows;
    rows.reserve(names.size());
    for (std::uint32_t row = 0; row < names.size(); ++row) {
        rows.emplace(names[row], row);
    }
    return rows;
}

std::uint32_t row_of(const std::unordered_map<std::string, std::uint32_t>& rows, const char* what,
                     const std::string& name) {
    const auto found = rows.find(name);
    if (found == rows.end())
        throw std::invalid_argument(std::string(what) + " '" + name +
                                    "' of SUMO's network is not among the names given to the session");
    return found->second;
}

}  // namespace

NameTable::NameTable(Names names)
    : names_(std::move(names)), lanes_(rows_of(names_.lanes)), edges_(rows_of(names_.edges)) {}

core::LaneIndex NameTable::lane(const std::string& name) const {
    return core::LaneIndex{row_of(lanes_, "lane", name)};
}

core::EdgeIndex NameTable::edge(const std::string& name) const {
    return core::EdgeIndex{row_of(edges_, "edge", name)};
}

std::vector<core::EdgeIndex> NameTable::edges(const std::vector<std::string>& names) const {
    std::vector<core::EdgeIndex> result;
    result.reserve(names.size());
    for (const std::string& name : names) {
        result.push_back(edge(name));
    }
    return result;
}

}  // namespace clearway::sumo::detail
