#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiment/unit.hpp"

namespace clearway::experiment {

/// A simulation that runs elsewhere, and the condition under which it is to go on.
struct AttachOrder {
    std::string host;
    int port = 0;
    std::filesystem::path network;       ///< Empty: the file that SUMO names.
    std::vector<std::string> automated;  ///< Vehicle types of SUMO that count as such.
    std::vector<std::string> emergency;
    std::uint64_t study_seed = 1;
    ConditionSpec condition;
    std::filesystem::path output;  ///< Run folder; made.

    bool operator==(const AttachOrder&) const = default;
};

/// JSON, for the worker's command line. `read_attach_order` throws core::InputError with every problem.
std::string to_json(const AttachOrder& order);
AttachOrder read_attach_order(const std::filesystem::path& file);

}  // namespace clearway::experiment
