#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "campaign/equip.hpp"
#include "campaign/equip_candidates.hpp"
#include "campaign/equip_rounds.hpp"
#include "scenario/network.hpp"
#include "study/config.hpp"

namespace clearway::campaign::detail {

/// The signals of a scenario, and which of them could gain.
struct Signals {
    const scenario::BuiltNetwork& built;  ///< Outlives this.
    EquipCandidates candidates;
    std::vector<std::string> all_streets;  ///< By core::SignalIndex.
    std::vector<bool> today;               ///< Which are equipped; empty: none.

    /// As `clearway scenario signals` counts, from 1.
    std::size_t number(std::size_t candidate) const { return candidates.signals.at(candidate).value + 1U; }
    const std::string& streets(std::size_t candidate) const {
        return all_streets.at(candidates.signals.at(candidate).value);
    }
    const std::string& id(std::size_t candidate) const {
        return built.network.signal(candidates.signals.at(candidate)).id;
    }
    std::vector<std::string> ids_of_today() const {
        std::vector<std::string> ids;
        for (std::size_t signal = 0; signal < today.size(); ++signal)
            if (today[signal]) ids.push_back(built.network.signals()[signal].id);
        return ids;
    }
};

/// What both verbs begin with.
struct Search {
    study::StudyConfig config;
    Signals signals;
    EquipRounds rounds;
};

/// Checks the condition of a request and builds its roads in a folder. Throws as `equip` does.
scenario::BuiltNetwork roads_of(const EquipRequest& request, const std::filesystem::path& folder);

/// Finds the signals of a request on roads that outlive the search, and gives it a folder where it names
/// none. Throws as `equip` does.
Search search_of(EquipRequest& request, const scenario::BuiltNetwork& built);

}  // namespace clearway::campaign::detail
