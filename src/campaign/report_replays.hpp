#pragma once

#include <cstdint>
#include <string>

#include "campaign/stored_folder.hpp"
#include "report/facts.hpp"
#include "results/store.hpp"

namespace clearway::campaign {

/// Whether a report makes the replays that it lacks.
enum class MakeReplays : std::uint8_t { no, yes };

/// Which replays a report shall have.
struct ReplayRequest {
    MakeReplays make = MakeReplays::no;
    CodeTrust trust = CodeTrust::none;
};

/// The replays of a report: of each scenario the trip of an emergency vehicle with the median gain, the best
/// and the worst, beside the baseline.
struct ReportReplays {
    std::string markup;         ///< For a section of the report; empty without replays.
    std::string script_source;  ///< What the page's policy must allow for it.
};

/// Throws core::InputError for code in Python that would have to run and is not trusted.
void require_replayable(const results::Store& store, const results::Results& results,
                        const report::StudyFacts& study, const ReplayRequest& request);

/// Reads `replays.html` of the run folder if it fits the results and one of the conditions. With
/// `MakeReplays::yes` it is made: the few
/// runs that are not recorded are made again with a recording, which must give the same records, and those
/// recordings are removed. At most 4 MB; where that is too little, less is shown around the trips, and the
/// page says so. Throws as work_on and results::Store do.
ReportReplays replays_of(const results::Store& store, const results::Results& results,
                         const report::StudyFacts& study, const ReplayRequest& request);

}  // namespace clearway::campaign
