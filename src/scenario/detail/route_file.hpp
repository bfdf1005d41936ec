#pragma once

#include <filesystem>

#include <pugixml.hpp>

namespace clearway::scenario::detail {

/// A route file of SUMO. Throws core::InputError where it is no XML.
pugi::xml_document load_route_file(const std::filesystem::path& file);

}  // namespace clearway::scenario::detail
