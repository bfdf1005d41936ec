#include "scenario/detail/route_file.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::scenario::detail {

pugi::xml_document load_route_file(const std::filesystem::path& file) {
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_file(file.c_str());
    if (!result)
        throw core::InputError(core::Problem{fmt::format("{}: byte {}", file.string(), result.offset),
                                             result.description(), "a SUMO route file", "correct the file"});
    return document;
}

}  // namespace clearway::scenario::detail
