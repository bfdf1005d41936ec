#pragma once

#include <span>
#include <string>

#include "report/facts.hpp"

namespace clearway::report::detail {

/// A section of the report. It is left out, also in the navigation, if it does not apply.
struct Section {
    const char* id;
    const char* title;
    bool (*applies)(const StudyFacts& study);
    std::string (*body)(const StudyFacts& study);  ///< Markup.
};

/// All sections in their order.
std::span<const Section> sections();

// One function per section, in the order of the page.
std::string verdict_section(const StudyFacts& study);
std::string tables_section(const StudyFacts& study);
std::string forest_section(const StudyFacts& study);
std::string distribution_section(const StudyFacts& study);
std::string failure_section(const StudyFacts& study);
std::string plan_section(const StudyFacts& study);
std::string sensitivity_section(const StudyFacts& study);
std::string cost_section(const StudyFacts& study);
std::string safety_section(const StudyFacts& study);
std::string journeys_section(const StudyFacts& study);
std::string precision_section(const StudyFacts& study);
std::string calibration_section(const StudyFacts& study);
std::string networks_section(const StudyFacts& study);
std::string training_section(const StudyFacts& study);
std::string outcomes_section(const StudyFacts& study);
std::string reproduction_section(const StudyFacts& study);

}  // namespace clearway::report::detail
