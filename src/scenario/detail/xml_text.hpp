#pragma once

#include <filesystem>
#include <string>

#include <pugixml.hpp>

namespace clearway::scenario::detail {

/// Loads a SUMO route file. Throws core::InputError when it is not XML.
pugi::xml_document load_route_file(const std::filesystem::path& file);

/// An element as text, indented by one level, with a line end.
std::string element_text(pugi::xml_node element);
std::string document_text(const pugi::xml_document& document);

}  // namespace clearway::scenario::detail
