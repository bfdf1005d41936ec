#pragma once

#include <cstdlib>
#include <filesystem>

#include "roads/network.hpp"

namespace clearway::roads {

/// Where the packages of SUMO keep their files.
inline std::filesystem::path sumo_folder() {
    const char* home = std::getenv("SUMO_HOME");
    return home == nullptr ? "/usr/share/sumo" : home;
}

/// A part of Berlin that package sumo-tools installs.
inline Network berlin() {
    return Network::read(sumo_folder() / "tools/game/DRT/osm.net.xml");
}

}  // namespace clearway::roads
