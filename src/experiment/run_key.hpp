#pragma once

#include <compare>
#include <cstdint>
#include <string>

#include "core/fields.hpp"

namespace clearway::experiment {

/// Identifies a run of a study.
struct RunKey {
    std::string scenario;
    std::string condition;
    std::uint32_t replication = 0;

    auto operator<=>(const RunKey&) const = default;
};

/// `city/baseline/7`.
std::string to_text(const RunKey& key);

/// What a run was made from. Together with the manifest, this is enough to repeat it.
struct Provenance {
    std::string clearway_version;
    std::string sumo_version;
    std::string configuration_hash;  ///< As in the manifest.
    std::string demand_hash;
    std::uint64_t study_seed = 0;
    std::uint64_t simulator_seed = 0;
    std::string trace_hash;

    bool operator==(const Provenance&) const = default;

    static constexpr void fields(const auto& table) {
        using P = Provenance;
        using core::Field;
        table(Field{"clearway_version", "", &P::clearway_version, 0, 0, "Version of Clearway", ""},
              Field{"sumo_version", "", &P::sumo_version, 0, 0, "Version of SUMO", ""},
              Field{"configuration_hash", "", &P::configuration_hash, 0, 0,
                    "Hash of the scenario's effective configuration and own files", ""},
              Field{"demand_hash", "", &P::demand_hash, 0, 0, "Hash of vehicle types, routes and departures",
                    ""},
              Field{"study_seed", "1", &P::study_seed, 0, 1.9e19, "Seed of the study", ""},
              Field{"simulator_seed", "1", &P::simulator_seed, 0, 1.9e19, "Seed of SUMO's own generator", ""},
              Field{"trace_hash", "", &P::trace_hash, 0, 0, "Hash of every snapshot and lease", ""});
    }
};

}  // namespace clearway::experiment
