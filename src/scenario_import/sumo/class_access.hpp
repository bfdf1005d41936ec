#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "roads/network.hpp"

namespace clearway::scenario_import::detail {

/// Which vehicle classes may use which lanes of a network file, for all classes; roads::Network only knows
/// cars, emergency vehicles and pedestrians.
class ClassAccess {
  public:
    /// Reads the lanes of `file`, the file of `network`.
    ClassAccess(const std::filesystem::path& file, const roads::Network& network);

    const roads::Network& network() const { return network_; }
    /// Whether a vehicle of a class (empty: passenger) may use any lane of an edge.
    bool opens(core::EdgeIndex edge, const std::string& vehicle_class) const;
    /// Whether it can drive from one edge directly to the next.
    bool joins(core::EdgeIndex from, core::EdgeIndex to, const std::string& vehicle_class) const;
    /// Whether it can drive a whole route.
    bool opens_way(const std::vector<core::EdgeIndex>& route, const std::string& vehicle_class) const;

  private:
    /// Attributes allow and disallow of a lane.
    using Lists = std::pair<std::string, std::string>;
    struct Rule {
        bool allows = false;  ///< Whether `classes` may use a lane, or may not.
        std::set<std::string> classes;
    };
    bool opens_lane(core::LaneIndex lane, const std::string& vehicle_class) const;

    const roads::Network& network_;
    std::vector<const Rule*> rules_;  ///< By lane index; null for lanes open to all.
    std::map<Lists, Rule> different_rules_;
};

}  // namespace clearway::scenario_import::detail
