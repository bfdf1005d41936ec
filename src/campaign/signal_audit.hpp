#pragma once

#include <string>
#include <vector>

#include "analysis/signal_audit.hpp"
#include "campaign/printout.hpp"
#include "core/error.hpp"
#include "results/store.hpp"

namespace clearway::campaign {

/// The audit of one run.
struct AuditedRun {
    std::string run;  ///< Its name.
    analysis::SignalAudit audit;
};

/// What an audit covered.
struct AuditReport {
    std::vector<AuditedRun> runs;
    std::size_t without_requests = 0;  ///< Runs of conditions that ask no signal for anything.
};

/// Audits the event logs of these complete runs against the programs of the networks in the folder. Throws
/// core::InputError for a damaged log.
AuditReport audit_runs(const results::Store& store, const std::vector<experiment::RunKey>& keys);

Printout audit_printout(const AuditReport& report);
/// Whether not one colour was checked, so that the audit says nothing of any signal.
bool nothing_audited(const AuditReport& report);
/// Why, and what to do. `what` is the folder or run that was named.
std::string nothing_audited_text(const AuditReport& report, const std::string& what);
/// 1 with findings, else 0.
core::ExitCode code_of(const AuditReport& report);

}  // namespace clearway::campaign
