#include "scenario/detail/network_document.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <zlib.h>

#include "core/error.hpp"

namespace clearway::scenario::detail {

namespace {

constexpr std::array<std::string_view, 7> newer_classes = {"cable_car", "subway", "aircraft", "wheelchair",
                                                           "scooter",   "drone",  "container"};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
    throw core::InputError(
        core::Problem{file.string(), what, "a SUMO network, .net.xml or .net.xml.gz", "choose another file"});
}

/// The bytes of a file, decompressed where it is compressed.
std::string inflated(const std::filesystem::path& file) {
    gzFile stream = gzopen(file.c_str(), "rb");
    if (stream == nullptr) refuse(file, "cannot be read");
    std::string bytes;
    std::array<char, 1 << 16> buffer{};
    int count = 0;
    while ((count = gzread(stream, buffer.data(), buffer.size())) > 0)
        bytes.append(buffer.data(), count);
    gzclose(stream);
    if (count < 0) refuse(file, "is damaged or cut short");
    return bytes;
}

std::string without_newer(std::string_view classes) {
    std::istringstream words{std::string(classes)};
    std::string kept;
    for (std::string word; words >> word;)
        if (std::find(newer_classes.begin(), newer_classes.end(), word) == newer_classes.end())
            kept += (kept.empty() ? "" : " ") + word;
    return kept;
}

struct TextWriter : pugi::xml_writer {
    std::string text;
    void write(const void* data, std::size_t size) override {
        text.append(static_cast<const char*>(data), size);
    }
};

/// Calls `visit` for every element of the document.
template <class Visit>
void walk(const pugi::xml_node& node, const Visit& visit) {
    for (pugi::xml_node child : node.children()) {
        visit(child);
        walk(child, visit);
    }
}

}  // namespace

NetworkDocument::NetworkDocument(const std::filesystem::path& file) {
    const std::string bytes = inflated(file);
    const pugi::xml_parse_result result =
        document_.load_buffer(bytes.data(), bytes.size(), pugi::parse_default | pugi::parse_declaration);
    if (!result) refuse(file, fmt::format("is not XML: {} at byte {}", result.description(), result.offset));
    if (std::string_view(document_.document_element().name()) != "net")
        refuse(file, fmt::format("has the root element <{}>", document_.document_element().name()));
}

NetworkDocument& NetworkDocument::without_newer_classes() {
    walk(document_, [](pugi::xml_node node) {
        if (pugi::xml_attribute disallow = node.attribute("disallow"))
            disallow.set_value(without_newer(disallow.value()).c_str());
        pugi::xml_attribute allow = node.attribute("allow");
        if (!allow) return;
        const std::string kept = without_newer(allow.value());
        allow.set_value(kept.c_str());
        if (!kept.empty()) return;
        node.remove_attribute(allow);  // An empty list would open the lane to all.
        node.append_attribute("disallow").set_value("all");
    });
    return *this;
}

void NetworkDocument::limit_speed(core::MetresPerSecond limit) {
    walk(document_, [&](pugi::xml_node node) {
        if (std::string_view(node.name()) != "lane") return;
        pugi::xml_attribute speed = node.attribute("speed");
        if (speed.as_double() > limit.value) speed.set_value(fmt::format("{:.2f}", limit.value).c_str());
    });
}

std::string NetworkDocument::text() const {
    TextWriter writer;
    document_.save(writer, "    ", pugi::format_indent, pugi::encoding_utf8);
    return std::move(writer.text);
}

}  // namespace clearway::scenario::detail
