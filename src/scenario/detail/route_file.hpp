#pragma once

#include <filesystem>

#include <pugixml.hpp>

namespace clearway::scenario::detail {

/// Loads a SUMO route file. Throws core::InputError when it is not XML.
pugi::xml_document load_route_file(const std::filesystem::path& file);

}  // namespace clearway::scenario::detail
