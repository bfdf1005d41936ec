#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace clearway::scenario_import::detail {

/// An XML element with what it holds.
struct Element {
    std::string name;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::vector<Element> children;
    std::string content;  ///< Text between its children, without blanks at its ends.
    unsigned long line = 0;
    std::string place = {};  ///< `stops.add.xml:12`, where somebody noted it.

    /// Empty when there is no such attribute.
    const std::string& text(std::string_view attribute) const;
    bool has(std::string_view attribute) const;
    void set(std::string_view attribute, std::string value);
    void remove(std::string_view attribute);
    /// As XML, indented, with a line end.
    std::string xml(int depth = 1) const;
};

/// Reads a file, packed with gzip or not, and calls `take` for each child of its root, one in memory at a
/// time. Throws core::InputError as core::stream_xml does.
void for_each_element(const std::filesystem::path& file, const std::function<void(Element&&)>& take);

/// Takes `begin_s` from the times at which the `<stop>` of a vehicle or person end.
void shift_stops(Element& user, double begin_s);

/// A whole file of SUMO with `content` in its root.
std::string file_text(const char* root, const std::string& content);

/// Seconds of SUMO's time texts: `12.5`, `1:00:00`, `1:01:00:00`. Nothing for other texts.
std::optional<double> time_s(std::string_view text);
/// SUMO's words for a boolean, in any case: `1`, `yes`, `true`, `on`, `x`, `t`. Not for any other text.
bool is_true(std::string_view text);
/// Likewise `0`, `no`, `false`, `off`, `-`, `f`.
bool is_false(std::string_view text);
/// The whole of `text` as a finite number.
std::optional<double> number(std::string_view text);
/// Parts of a list, between any of `separators`, without empty ones.
std::vector<std::string> words(std::string_view text, std::string_view separators = " \t\r\n");

}  // namespace clearway::scenario_import::detail
