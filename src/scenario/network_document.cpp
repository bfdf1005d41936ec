#include "scenario/network_document.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/machine_failure.hpp"
#include "core/process.hpp"
#include "scenario/detail/xml_text.hpp"

namespace clearway::scenario {

namespace {

constexpr std::array<std::string_view, 7> newer_classes = {"cable_car", "subway", "aircraft", "wheelchair",
                                                           "scooter",   "drone",  "container"};

constexpr const char* network_kind = "a SUMO network, .net.xml or .net.xml.gz";

/// The words of a list of classes that are not in `left_out`.
std::string without(std::string_view classes, std::span<const std::string_view> left_out) {
    std::istringstream words{std::string(classes)};
    std::string kept;
    for (std::string word; words >> word;)
        if (!core::contains(left_out, word)) kept += (kept.empty() ? "" : " ") + word;
    return kept;
}

std::string without(std::string_view classes, std::string_view left_out) {
    return without(classes, std::span(&left_out, 1));
}

std::string without_newer(std::string_view classes) {
    return without(classes, newer_classes);
}

bool lists(std::string_view classes, std::string_view wanted) {
    return without(classes, wanted) != without(classes, std::span<const std::string_view>());
}

bool is_internal(pugi::xml_node edge) {
    return std::string_view(edge.attribute("function").value()) == "internal";
}

/// Calls `visit` for every element of the document.
template <class Visit>
void walk(const pugi::xml_node& node, const Visit& visit) {
    for (pugi::xml_node child : node.children()) {
        visit(child);
        walk(child, visit);
    }
}

}  // namespace

NetworkDocument::NetworkDocument(const std::filesystem::path& file)
    : document_(detail::load_xml(file, network_kind, pugi::parse_default | pugi::parse_declaration)) {
    const char* const root = document_.document_element().name();
    if (std::string_view(root) != "net")
        throw core::InputError(core::Problem{file.string(), fmt::format("has the root element <{}>", root),
                                             network_kind, "choose another file"});
    // A run writes tables of its own, and none at a path of the file's.
    for (pugi::xml_node program : document_.document_element().children("tlLogic"))
        while (program.remove_child(program.find_child_by_attribute("param", "key", "file"))) {
        }
}

NetworkDocument& NetworkDocument::without_newer_classes() {
    walk(document_, [this](pugi::xml_node node) {
        const auto repair = [this](pugi::xml_attribute list) {
            const std::string kept = without_newer(list.value());
            if (kept == list.value()) return false;
            ++repaired_lists_;
            list.set_value(kept.c_str());
            return true;
        };
        if (pugi::xml_attribute disallow = node.attribute("disallow")) repair(disallow);
        pugi::xml_attribute allow = node.attribute("allow");
        if (!allow || !repair(allow) || !std::string_view(allow.value()).empty()) return;
        node.remove_attribute(allow);  // An empty list would open the lane to all classes.
        node.append_attribute("disallow").set_value("all");
    });
    return *this;
}

int NetworkDocument::admit_emergency() {
    constexpr std::string_view guest = "emergency";
    int changed = 0;
    walk(document_, [&](pugi::xml_node node) {
        if (pugi::xml_attribute allow = node.attribute("allow")) {
            if (!lists(allow.value(), "passenger") || lists(allow.value(), guest)) return;
            allow.set_value(fmt::format("{} {}", allow.value(), guest).c_str());
            ++changed;
        } else if (pugi::xml_attribute disallow = node.attribute("disallow")) {
            if (lists(disallow.value(), "passenger") || !lists(disallow.value(), guest)) return;
            disallow.set_value(without(disallow.value(), guest).c_str());
            ++changed;
        }
    });
    return changed;
}

int NetworkDocument::part_two_way_edges() {
    const auto edges = document_.document_element().children("edge");
    std::set<std::string> wide;
    for (const pugi::xml_node edge : edges)
        if (edge.attribute("bidi") && edge.child("lane").next_sibling("lane"))
            wide.insert({edge.attribute("id").value(), edge.attribute("bidi").value()});
    int parted = 0;
    for (pugi::xml_node edge : edges)
        if (wide.contains(edge.attribute("id").value()) && edge.remove_attribute("bidi"))
            parted += is_internal(edge) ? 0 : 1;
    return parted;
}

bool NetworkDocument::has_edges() const {
    return std::ranges::any_of(document_.document_element().children("edge"),
                               [](pugi::xml_node edge) { return !is_internal(edge); });
}

std::string NetworkDocument::attribute(const char* name) const {
    return document_.document_element().attribute(name).value();
}

void NetworkDocument::name_controllers() {
    for (pugi::xml_node program : document_.document_element().children("tlLogic"))
        if (!program.attribute("type")) program.append_attribute("type").set_value("static");
}

void NetworkDocument::limit_speed(core::MetresPerSecond limit) {
    walk(document_, [&](pugi::xml_node node) {
        if (std::string_view(node.name()) != "lane") return;
        pugi::xml_attribute speed = node.attribute("speed");
        if (speed.as_double() > limit.value) speed.set_value(fmt::format("{:.2f}", limit.value).c_str());
    });
}

std::set<std::string> NetworkDocument::edges() const {
    std::set<std::string> ids;
    for (const pugi::xml_node edge : document_.document_element().children("edge"))
        if (!is_internal(edge)) ids.insert(edge.attribute("id").value());
    return ids;
}

void NetworkDocument::scale_speeds(const std::function<double(const std::string& edge)>& factor_of) {
    for (const pugi::xml_node edge : document_.document_element().children("edge")) {
        const double factor = factor_of(edge.attribute("id").value());
        for (const pugi::xml_node lane : edge.children("lane")) {
            pugi::xml_attribute speed = lane.attribute("speed");
            speed.set_value(fmt::format("{:.4f}", speed.as_double() * factor).c_str());
        }
    }
}

void NetworkDocument::begin_programs_at(double begin_s) {
    for (pugi::xml_node program : document_.document_element().children("tlLogic")) {
        double cycle_s = 0.0;
        for (const pugi::xml_node phase : program.children("phase"))
            cycle_s += phase.attribute("duration").as_double();
        if (cycle_s <= 0.0) continue;
        const double offset_s = std::fmod(program.attribute("offset").as_double() - begin_s, cycle_s);
        program.remove_attribute("offset");
        program.append_attribute("offset").set_value(
            fmt::format("{:.2f}", offset_s < 0.0 ? offset_s + cycle_s : offset_s).c_str());
    }
}

bool NetworkDocument::replace_programs(const std::string& id, const std::string& program) {
    pugi::xml_node root = document_.document_element();
    pugi::xml_node first = root.find_child_by_attribute("tlLogic", "id", id.c_str());
    if (!first) return false;
    pugi::xml_document made;
    made.load_string(program.c_str());
    root.insert_copy_before(made.document_element(), first);
    for (pugi::xml_node next; first; first = next) {
        next = first.next_sibling("tlLogic");
        if (first.attribute("id").value() == id) first.parent().remove_child(first);
    }
    return true;
}

std::string NetworkDocument::text() const {
    return detail::document_text(document_);
}

void require_whole(const std::filesystem::path& file) {
    if (core::tail(file, 1).find("</net>") == std::string::npos) throw core::cut_short(file);
}

}  // namespace clearway::scenario
