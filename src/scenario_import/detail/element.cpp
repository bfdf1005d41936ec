#include "scenario_import/detail/element.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include "core/markup.hpp"
#include "core/xml_stream.hpp"

namespace clearway::scenario_import::detail {

namespace {

class TreeHandler : public core::XmlHandler {
  public:
    explicit TreeHandler(const std::function<void(Element&&)>& take) : take_(take) {}

    void start(std::string_view element, const core::XmlAttributes& attributes, unsigned long line) override {
        if (depth_++ == 0) return;
        Element& opened = open_.emplace_back();
        opened.name = element;
        opened.line = line;
        attributes.for_each([&](std::string_view name, std::string_view value) {
            opened.attributes.emplace_back(name, value);
        });
    }

    void characters(std::string_view part) override {
        constexpr std::string_view blanks = " \t\r\n";
        if (open_.empty()) return;
        std::string& content = open_.back().content;
        if (content.empty()) part.remove_prefix(std::min(part.find_first_not_of(blanks), part.size()));
        content += part;
    }

    void end(std::string_view) override {
        if (--depth_ == 0) return;
        Element closed = std::move(open_.back());
        open_.pop_back();
        closed.content.erase(closed.content.find_last_not_of(" \t\r\n") + 1);
        if (open_.empty()) return take_(std::move(closed));
        open_.back().children.push_back(std::move(closed));
    }

  private:
    const std::function<void(Element&&)>& take_;
    std::vector<Element> open_;
    int depth_ = 0;
};

bool is_one_of(std::string_view text, std::initializer_list<std::string_view> words) {
    return core::contains(words, lower(text));
}

}  // namespace

const std::string& Element::text(std::string_view attribute) const {
    static const std::string none;
    const auto found =
        std::ranges::find_if(attributes, [&](const auto& each) { return each.first == attribute; });
    return found == attributes.end() ? none : found->second;
}

bool Element::has(std::string_view attribute) const {
    return std::ranges::any_of(attributes, [&](const auto& each) { return each.first == attribute; });
}

void Element::set(std::string_view attribute, std::string value) {
    const auto found =
        std::ranges::find_if(attributes, [&](const auto& each) { return each.first == attribute; });
    if (found != attributes.end())
        found->second = std::move(value);
    else
        attributes.emplace_back(attribute, std::move(value));
}

void Element::remove(std::string_view attribute) {
    std::erase_if(attributes, [&](const auto& each) { return each.first == attribute; });
}

std::string Element::xml(int depth) const {
    const std::string indent(4 * static_cast<std::size_t>(depth), ' ');
    std::string text = indent + "<" + name;
    for (const auto& [key, value] : attributes)
        text += " " + key + "=\"" + core::escaped(value) + "\"";
    if (children.empty()) return text + "/>\n";
    text += ">\n";
    for (const Element& child : children)
        text += child.xml(depth + 1);
    return text + indent + "</" + name + ">\n";
}

void for_each_element(const std::filesystem::path& file, const std::function<void(Element&&)>& take) {
    TreeHandler handler(take);
    core::stream_xml(file, handler);
}

void delay_stop(Element& stop, double by_s) {
    for (const char* const name : {"until", "arrival", "started", "ended"}) {
        const auto at_s = stop.has(name) ? time_s(stop.text(name)) : std::nullopt;
        if (at_s) stop.set(name, fmt::format("{:.2f}", std::max(0.0, *at_s + by_s)));
    }
}

std::string departing_xml(Element user, double begin_s, const Departing& departing) {
    for (Element& stop : user.children)
        delay_stop(stop, -begin_s);
    const std::vector<std::pair<std::string, std::string>> head = {
        {"id", departing.id},
        {"type", departing.type},
        {"depart", fmt::format("{:.2f}", departing.depart_s - begin_s)}};
    user.attributes.insert(user.attributes.begin(), head.begin(), head.end());
    return user.xml();
}

std::string file_text(const char* root, const std::string& content) {
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<{0}>\n{1}</{0}>\n", root, content);
}

bool is_true(std::string_view text) {
    return is_one_of(text, {"1", "yes", "true", "on", "x", "t"});
}

bool is_false(std::string_view text) {
    return is_one_of(text, {"0", "no", "false", "off", "-", "f"});
}

std::optional<double> number(std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

std::optional<double> time_s(std::string_view text) {
    const std::vector<std::string> parts = words(text, ":");
    constexpr std::size_t with_days = 4;
    if (parts.size() != 1 && parts.size() != 3 && parts.size() != with_days) return std::nullopt;
    double total = 0.0;
    for (std::size_t row = 0; row < parts.size(); ++row) {
        const auto part = number(parts[row]);
        if (!part) return std::nullopt;
        const bool after_days = parts.size() == with_days && row == 1;
        total = total * (row == 0 ? 1.0 : after_days ? 24.0 : 60.0) + *part;
    }
    return total;
}

std::string lower(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](unsigned char c) { return std::tolower(c); });
    return result;
}

std::vector<std::string> words(std::string_view text, std::string_view separators) {
    std::vector<std::string> result;
    while (true) {
        const std::size_t begin = text.find_first_not_of(separators);
        if (begin == std::string_view::npos) return result;
        text.remove_prefix(begin);
        const std::size_t end = std::min(text.find_first_of(separators), text.size());
        result.emplace_back(text.substr(0, end));
        text.remove_prefix(end);
    }
}

}  // namespace clearway::scenario_import::detail
