#include "scenario/detail/xml_text.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::scenario::detail {
namespace {

struct TextWriter : pugi::xml_writer {
    std::string text;
    void write(const void* data, std::size_t size) override {
        text.append(static_cast<const char*>(data), size);
    }
};

}  // namespace

pugi::xml_document load_route_file(const std::filesystem::path& file) {
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_file(file.c_str());
    if (!result)
        throw core::InputError(core::Problem{fmt::format("{}: byte {}", file.string(), result.offset),
                                             result.description(), "a SUMO route file", "correct the file"});
    return document;
}

std::string element_text(pugi::xml_node element) {
    TextWriter writer;
    element.print(writer, "    ", pugi::format_indent, pugi::encoding_utf8, 1);
    return std::move(writer.text);
}

std::string document_text(const pugi::xml_document& document) {
    TextWriter writer;
    document.save(writer, "    ", pugi::format_indent, pugi::encoding_utf8);
    return std::move(writer.text);
}

}  // namespace clearway::scenario::detail
