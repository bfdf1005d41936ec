#pragma once

#include <map>
#include <string>
#include <vector>

#include "roads/route.hpp"
#include "scenario/prepare.hpp"
#include "scratch.hpp"

namespace clearway::scenario {

/// Prepares demand with study seed 1; each network is built once a test.
class PreparedDemand : public ScratchTest {
  protected:
    Prepared prepared(const std::string& name, const Options& options = {}, std::uint32_t replication = 0) {
        const ScenarioConfig config = load(name, options);
        if (!networks_.contains(name))
            networks_.emplace(name, build_network(config, folder() / "networks" / config.name));
        return prepare(config, networks_.at(name), core::StudySeed{1}, core::Replication{replication},
                       folder() / "demand" / std::to_string(++folders_));
    }
    const roads::Network& network(const std::string& name) const { return networks_.at(name).network; }
    double length_m(const std::string& name, const std::vector<std::string>& edges) const {
        std::vector<core::EdgeIndex> route;
        for (const std::string& id : edges)
            route.push_back(network(name).find_edge(id).value());
        return roads::route_length(network(name), route).value;
    }

  private:
    std::map<std::string, BuiltNetwork> networks_;
    int folders_ = 0;
};

}  // namespace clearway::scenario
