#pragma once

#include <string>

#include <pugixml.hpp>

namespace clearway::scenario::detail {

/// An element as text, indented by one level, with a line end.
std::string element_text(pugi::xml_node element);
std::string document_text(const pugi::xml_document& document);

}  // namespace clearway::scenario::detail
