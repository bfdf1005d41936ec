#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiment/condition.hpp"

namespace clearway::experiment {

/// A simulation that runs elsewhere, and the condition under which it continues.
struct AttachJob {
    std::string host;
    int port = 0;
    std::filesystem::path network;
    std::vector<std::string> automated;
    std::vector<std::string> emergency;
    std::uint64_t study_seed = 1;
    ConditionSpec condition;
    std::filesystem::path output;

    /// All members but the condition.
    static constexpr void fields(const auto& table) {
        using Self = AttachJob;
        table(core::Field{"host", "", &Self::host, 0, 0, "Machine on which SUMO runs", "localhost"},
              core::Field{"port", "1", &Self::port, 1, 65535, "Its --remote-port", "given"},
              core::Field{"network", "", &Self::network, 0, 0, "Network file; empty: the one that SUMO names",
                          "as SUMO says"},
              core::Field{"automated", "", &Self::automated, 0, 0,
                          "Vehicle types of SUMO that count as automated", "none"},
              core::Field{"emergency", "", &Self::emergency, 0, 0,
                          "Vehicle types of SUMO that count as emergency vehicles", "none"},
              core::Field{"study_seed", "1", &Self::study_seed, 0, 1.8446744073709552e19,
                          "Seed of sensor failures", "any"},
              core::Field{"output", "", &Self::output, 0, 0, "Run folder; created", "given"});
    }
    bool operator==(const AttachJob&) const = default;
};

}  // namespace clearway::experiment
