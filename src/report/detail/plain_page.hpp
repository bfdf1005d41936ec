#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace clearway::report::detail {

struct PageSection {
    const char* id;
    const char* title;
    std::string body;  ///< Markup.
};

/// A self-contained page without a script.
struct PlainPage {
    std::string title;
    std::string lead;
    std::vector<PageSection> sections;
    std::string footer;
};

/// Title, lead and footer are escaped here.
void write(const PlainPage& plain, std::ostream& page);

}  // namespace clearway::report::detail
