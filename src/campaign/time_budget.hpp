#pragma once

#include "campaign/study_run.hpp"
#include "core/error.hpp"
#include "study/config.hpp"

namespace clearway::campaign {

/// The study with as many replications as `within_s` of wall time allows by the estimated cost of its runs,
/// at least those of run_within's first round. Names the folder as run_within does. Throws core::InputError
/// where measured demand cannot be read.
study::StudyConfig fitted(study::StudyConfig config, double within_s, RunOptions& options);

/// Runs as many replications of a study as `within_s` of wall time allows, and publishes its folder. The
/// first round has as many as an interval needs (analysis::fewest_for_interval); each further one has as many
/// as fit, at the pace so far, into nine tenths of the time left. Their number depends on times and never on
/// results, so intervals keep their level. A folder that is complete already gets more of them. An empty
/// `options.folder` becomes `runs/NAME-xxxxxx-timed`.
core::ExitCode run_within(study::StudyConfig config, double within_s, RunOptions options);

}  // namespace clearway::campaign
