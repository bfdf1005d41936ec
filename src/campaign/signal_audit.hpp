#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/signal_audit.hpp"
#include "campaign/printout.hpp"
#include "core/error.hpp"
#include "results/store.hpp"

namespace clearway::campaign {

/// The audit of one run.
struct AuditedRun {
    std::string run;        ///< Its name.
    bool repeated = false;  ///< It kept no event log and was made again.
    analysis::SignalAudit audit;
};

/// What an audit covered.
struct AuditReport {
    std::vector<AuditedRun> runs;
    std::size_t without_requests = 0;  ///< Runs of conditions that ask no signal for anything.
    /// Runs that were repeated and failed, with why.
    std::vector<std::string> failed;
};

/// Makes runs again and returns the store that holds them.
using Repeat = std::function<results::Store(const std::vector<experiment::RunKey>& keys)>;

/// Audits the event logs of these complete runs against the programs of the networks in the folder. Runs that
/// kept none are made again by `repeat`. Throws core::InputError for a damaged log.
AuditReport audit_runs(const results::Store& store, const std::vector<experiment::RunKey>& keys,
                       const Repeat& repeat);

Printout audit_printout(const AuditReport& report);
/// Whether no run failed and yet not one colour was checked, so that the audit says nothing of any signal.
bool nothing_audited(const AuditReport& report);
/// Why, and what to do. `what` is the folder or run that was named.
std::string nothing_audited_text(const AuditReport& report, const std::string& what);
/// 1 with findings and for runs that failed, else 0.
core::ExitCode code_of(const AuditReport& report);

}  // namespace clearway::campaign
