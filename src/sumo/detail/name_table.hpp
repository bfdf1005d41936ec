#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/ids.hpp"
#include "sumo/session.hpp"

namespace clearway::sumo::detail {

/// SUMO's names to table rows and back.
class NameTable {
  public:
    explicit NameTable(Names names);

    /// All three throw std::invalid_argument when the name is not in the table: the names belong to another
    /// network.
    core::LaneIndex lane(const std::string& name) const;
    core::EdgeIndex edge(const std::string& name) const;
    std::vector<core::EdgeIndex> edges(const std::vector<std::string>& names) const;
    bool has_edge(const std::string& name) const { return edges_.contains(name); }
    const Names& names() const { return names_; }

  private:
    Names names_;
    std::unordered_map<std::string, std::uint32_t> lanes_;
    std::unordered_map<std::string, std::uint32_t> edges_;
};

}  // namespace clearway::sumo::detail
