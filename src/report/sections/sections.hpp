#pragma once

#include <span>

#include "report/detail/writer.hpp"
#include "report/facts.hpp"

namespace clearway::report::detail {

/// A section of the report. It is left out, also in the navigation, if it does not apply.
struct Section {
    /// Whether readers see it at once or unfold it. Print shows all sections.
    enum class Shown { open, folded };

    const char* id;
    const char* title;
    Shown shown;
    bool (*applies)(const StudyFacts& study);
    void (*write)(const StudyFacts& study, Writer& writer);
};

/// All sections in their order: the list is in sections/list.cpp, each section in a file of its own.
std::span<const Section> sections();

void overview_section(const StudyFacts& study, Writer& writer);
void plan_section(const StudyFacts& study, Writer& writer);
void verdict_section(const StudyFacts& study, Writer& writer);
void sensitivity_section(const StudyFacts& study, Writer& writer);
/// Whether the study varied a factor of its own, other than settings turned alone.
bool has_factors(const StudyFacts& study);
void factors_section(const StudyFacts& study, Writer& writer);
void tables_section(const StudyFacts& study, Writer& writer);
void differences_section(const StudyFacts& study, Writer& writer);
void travel_time_section(const StudyFacts& study, Writer& writer);
void failure_section(const StudyFacts& study, Writer& writer);
void cost_section(const StudyFacts& study, Writer& writer);
void safety_section(const StudyFacts& study, Writer& writer);
void journeys_section(const StudyFacts& study, Writer& writer);
void enough_section(const StudyFacts& study, Writer& writer);
void calibration_section(const StudyFacts& study, Writer& writer);
void networks_section(const StudyFacts& study, Writer& writer);
void training_section(const StudyFacts& study, Writer& writer);
void outcomes_section(const StudyFacts& study, Writer& writer);
void reproduce_section(const StudyFacts& study, Writer& writer);

}  // namespace clearway::report::detail
