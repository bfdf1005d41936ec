#pragma once

#include <ostream>
#include <string>

#include "report/facts.hpp"

namespace clearway::report {

/// A section of the page that another module makes. Trusted markup.
struct Replays {
    std::string markup;         ///< Empty: no such section.
    std::string script_source;  ///< What the page's policy allows for its script: 'sha256-...'.
};

/// Writes the report: one self-contained HTML page. Its scripts are the program's own, allowed
/// by their hashes, and nothing is fetched. Every text of
/// `study` is escaped, but for `ScenarioFacts::network_svg`, which must be trusted markup, as `replays` is.
/// Written section by section, so the whole page is never held in memory.
void write_html(const StudyFacts& study, std::ostream& page, const Replays& replays = {});

}  // namespace clearway::report
