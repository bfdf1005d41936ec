#include <algorithm>
#include <cctype>
#include <string>

#include "report/read_facts.hpp"

namespace clearway::report {
namespace {

/// Whether the lower-case text holds an attribute on...=.
bool has_event_handler(std::string_view lower) {
    const auto is = [&](std::size_t at, int (*kind)(int)) {
        return at < lower.size() && kind(static_cast<unsigned char>(lower[at])) != 0;
    };
    for (std::size_t at = lower.find("on"); at != std::string_view::npos; at = lower.find("on", at + 1)) {
        if (at == 0 || std::string_view(" \t\r\n\f/\"'").find(lower[at - 1]) == std::string_view::npos)
            continue;
        std::size_t end = at;
        while (is(end, std::isalpha)) {
            ++end;
        }
        while (is(end, std::isspace)) {
            ++end;
        }
        if (end < lower.size() && lower[end] == '=') return true;
    }
    return false;
}

}  // namespace

bool is_safe_picture(std::string_view svg) {
    std::string lower(svg.substr(0, svg.find_last_not_of(" \n\r\t") + 1));
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    const std::size_t start = lower.find("<svg");
    if (start == std::string::npos || !lower.ends_with("</svg>")) return false;
    if (lower.find("<svg", start + 1) != std::string::npos || lower.find("</svg>") != lower.size() - 6)
        return false;
    for (const char* const forbidden :
         {"<!--",    "<![cdata[", "<script", "<foreignobject", "<image",   "<use",    "<a ",
          "<iframe", "<object",   "<embed",  "<set",           "<animate", "<html",   "<body",
          "<link",   "<meta",     "href",    "src=",           "url(",     "@import", "javascript:"}) {
        if (lower.find(forbidden, start) != std::string::npos) return false;
    }
    return !has_event_handler(std::string_view(lower).substr(start));
}

}  // namespace clearway::report
