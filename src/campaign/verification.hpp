#pragma once

#include <cstddef>
#include <string>

#include "campaign/printing.hpp"
#include "campaign/stored_folder.hpp"
#include "core/error.hpp"

namespace clearway::campaign {

/// Which stored runs are made again.
struct VerifyRequest {
    std::string what;  ///< A run, or with `all` and `sample` a run folder.
    bool all = false;
    bool signals = false;    ///< Audit signals instead of comparing numbers.
    std::size_t sample = 0;  ///< So many of the complete runs, evenly spread; 0: all.
    std::string out;         ///< Run folder that keeps the repeated runs; empty: a temporary one.
    unsigned workers = 0;    ///< 0: one per core.
    CodeTrust trust = CodeTrust::none;
    Printing printing = Printing::text;
};

/// Makes stored runs again elsewhere, from the configurations and networks of their folder, compares all that
/// their records hold, and prints the verdicts. With `signals` it audits event logs instead, as
/// signal_audit.hpp says, and makes no run again. Edited tables of the folder are made anew. Returns the
/// worst verdict: conflict for a difference, bad_input for a damaged record, runs_failed; or how it was
/// interrupted. Throws core::InputError, as study::require_unchanged also for a scenario or a network that
/// was changed; core::EnvironmentError for other versions than the study's; and core::Error with incomplete
/// where there is nothing to compare.
core::ExitCode verify_runs(const VerifyRequest& request);

}  // namespace clearway::campaign
