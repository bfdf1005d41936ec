#pragma once

#include <ostream>
#include <string>

#include "report/facts.hpp"

namespace clearway::report {

/// Writes the report: one self-contained HTML page without scripts and without any address to load from.
/// Every text of `study` is escaped, but for `ScenarioFacts::network_svg`, which must be trusted markup.
/// Written section by section, so the page is never held as a whole.
void write_html(const StudyFacts& study, std::ostream& page);

}  // namespace clearway::report
