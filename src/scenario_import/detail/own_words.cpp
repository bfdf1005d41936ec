#include "scenario_import/detail/own_words.hpp"

#include <cstdlib>
#include <cstring>
#include <iterator>

#include <fmt/format.h>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

namespace {

/// How surely a complaint is about an element: 2 with its name, 1 by its id alone, 0 not at all.
int match(const std::string& complaint, const NamedElement& element) {
    const std::string quoted = lower(fmt::format("'{}'", element.id));
    // `MSTriggeredRerouter works: ...`
    const std::string headed = lower(fmt::format("{} {}:", element.name, element.id));
    if (complaint.find(headed) != std::string::npos) return 2;
    if (complaint.find(quoted) == std::string::npos) return 0;
    return complaint.find(fmt::format("{} {}", lower(element.name), quoted)) != std::string::npos ? 2 : 1;
}

}  // namespace

std::string in_own_words(std::string text, const Import& import) {
    const std::string made = (import.scenario / "additional.add.xml").string();
    for (std::size_t at = text.find(made); at != std::string::npos; at = text.find(made, at + 1)) {
        const char* const end = text.c_str() + at + made.size();
        const unsigned long line = *end == ':' ? std::strtoul(end + 1, nullptr, 10) : 0;
        const auto place = import.additional.places.upper_bound(line);
        if (place == import.additional.places.begin()) continue;
        const std::size_t digits = fmt::formatted_size(":{}", line);
        text.replace(at, made.size() + digits, std::prev(place)->second);
    }
    for (const char* const prefix : {"'human.", "'automated."})
        for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at + 1))
            text.replace(at, std::strlen(prefix), "'");
    return text;
}

std::optional<std::string> place_of_complaint(const std::string& complaint, const Import& import) {
    const std::string text = lower(complaint);
    int best = 0;
    std::optional<std::string> place;
    for (const NamedElement& element : import.named) {
        const int rank = match(text, element);
        if (rank <= best || element.place.empty()) continue;
        best = rank;
        place = element.place;
    }
    return place;
}

}  // namespace clearway::scenario_import::detail
