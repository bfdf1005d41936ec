#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace clearway::scenario_import::detail {

/// An XML element with its contents.
struct Element {
    std::string name;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::vector<Element> children;
    std::string content;  ///< Text between its children, without leading and trailing blanks.
    unsigned long line = 0;
    std::string place = {};  ///< `stops.add.xml:12`; may be empty.

    /// Empty when there is no such attribute.
    const std::string& text(std::string_view attribute) const;
    bool has(std::string_view attribute) const;
    void set(std::string_view attribute, std::string value);
    void remove(std::string_view attribute);
    /// As XML, indented, with a line end.
    std::string xml(int depth = 1) const;
};

/// Reads a file, gzipped or not, and calls `take` for each child of its root, with one in memory at a time.
/// Throws core::InputError as core::stream_xml does.
void for_each_element(const std::filesystem::path& file, const std::function<void(Element&&)>& take);

/// Adds `by_s` to the times at which a `<stop>` ends; none becomes negative.
void delay_stop(Element& stop, double by_s);

/// A vehicle or person as it departs.
struct Departing {
    const std::string& id;
    const std::string& type;
    double depart_s = 0.0;
};
/// As XML, with id, type and departure first. All times, those of its stops too, count from `begin_s`.
std::string departing_xml(Element user, double begin_s, const Departing& departing);

/// A complete SUMO file with `content` in its root element.
std::string file_text(const char* root, const std::string& content);

/// Latest begin and departure, s: 31 years. Later ones are mistakes, and counts by time would fill the
/// memory.
inline constexpr double latest_departure_s = 1e9;
/// A time in SUMO's notation (`12.5`, `1:00:00`, `1:01:00:00`) in seconds. Nothing for other texts.
std::optional<double> time_s(std::string_view text);
/// Whether `text` is one of SUMO's words for true, in any case: `1`, `yes`, `true`, `on`, `x`, `t`.
bool is_true(std::string_view text);
/// Likewise for false: `0`, `no`, `false`, `off`, `-`, `f`.
bool is_false(std::string_view text);
/// All of `text` as a finite number.
std::optional<double> number(std::string_view text);
/// With small letters in place of the capitals of ASCII.
std::string lower(std::string_view text);
/// The non-empty parts of a list, split at any of `separators`.
std::vector<std::string> words(std::string_view text, std::string_view separators = " \t\r\n");

}  // namespace clearway::scenario_import::detail
