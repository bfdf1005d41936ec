#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "sumo/session.hpp"

namespace clearway::test {

/// The id of an `element` that starts in a line, or empty.
inline std::string id_of(const std::string& element, const std::string& line) {
    const std::string start = "<" + element + " id=\"";
    const std::size_t at = line.find(start);
    if (at == std::string::npos) return {};
    const std::size_t from = at + start.size();
    return line.substr(from, line.find('"', from) - from);
}

/// The names in a network file, in the order of the file.
inline sumo::Names read_names(const std::filesystem::path& network) {
    sumo::Names names;
    std::ifstream file(network);
    for (std::string line; std::getline(file, line);) {
        if (const std::string id = id_of("edge", line); !id.empty()) names.edges.push_back(id);
        if (const std::string id = id_of("lane", line); !id.empty()) names.lanes.push_back(id);
        if (const std::string id = id_of("tlLogic", line); !id.empty()) names.signals.push_back(id);
    }
    return names;
}

}  // namespace clearway::test
