#pragma once

#include <filesystem>
#include <string>

#include <pugixml.hpp>

namespace clearway::scenario::detail {

/// Loads an XML file, plain or gzipped, as a whole. `kind` says what is allowed: `a SUMO route file`. Throws
/// core::InputError when it is missing, damaged, not XML, larger than 512 MiB unpacked, or nested deeper than
/// core::most_xml_levels.
pugi::xml_document load_xml(const std::filesystem::path& file, const std::string& kind,
                            unsigned options = pugi::parse_default);

/// A vehicle, person or type as text, indented by one level, with a line end. Takes out the parameters that
/// let SUMO write files, at any path: a run writes tables of its own.
std::string element_text(pugi::xml_node element);
std::string document_text(const pugi::xml_document& document);

}  // namespace clearway::scenario::detail
