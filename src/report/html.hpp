#pragma once

#include <ostream>

#include "report/facts.hpp"

namespace clearway::report {

/// Writes the report: one self-contained HTML page. Its one script is the program's own, allowed
/// by its hash, and nothing is fetched. Every text of
/// `study` is escaped, but for `ScenarioFacts::network_svg`, which must be trusted markup. Written section by
/// section, so the whole page is never held in memory.
void write_html(const StudyFacts& study, std::ostream& page);

}  // namespace clearway::report
