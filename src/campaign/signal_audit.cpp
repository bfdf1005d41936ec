#include "campaign/signal_audit.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "campaign/run_name.hpp"
#include "report/text.hpp"
#include "roads/program_times.hpp"
#include "scenario/network.hpp"

namespace clearway::campaign {
namespace {

using report::counted;

/// Findings of a run that are printed in words; --json has all.
constexpr std::size_t shown_findings = 5;

struct Audited {
    std::map<std::string, analysis::SignalLimits> limits;
    double step_s = 0.0;
};

/// From the network in the folder, read anew.
Audited limits_of(const results::Store& store, const std::string& scenario) {
    const std::filesystem::path folder = store.scenario_folder(scenario);
    const scenario::ScenarioConfig config = scenario::load((folder / "scenario.toml").string());
    const scenario::BuiltNetwork built = scenario::open_network(config, folder / "network");
    Audited audited{{}, config.time.step_length_s};
    for (const roads::Signal& signal : built.network.signals()) {
        roads::ProgramTimes times = roads::program_times(signal);
        audited.limits[signal.id] = {std::move(times.yellow_s), std::move(times.red_s),
                                     std::move(times.green_s), signal.foes};
    }
    return audited;
}

std::string text_of(const analysis::SignalFinding& finding) {
    return fmt::format("{:.2f} s: signal {}, link {}: {} lasted {:.2f} s, its own program {:.2f} s",
                       finding.ended_s, finding.signal, finding.link, core::name(finding.what),
                       finding.lasted_s, finding.least_s);
}

struct Totals {
    std::uint64_t yellows = 0, reds = 0, greens = 0, findings = 0;
};

Totals totals_of(const AuditReport& report) {
    Totals totals;
    for (const AuditedRun& run : report.runs) {
        totals.yellows += run.audit.yellows;
        totals.reds += run.audit.reds;
        totals.greens += run.audit.greens;
        totals.findings += run.audit.findings.size();
    }
    return totals;
}

core::Json json_of(const std::vector<AuditedRun>& runs) {
    core::Json findings = core::Json::array();
    for (const AuditedRun& run : runs)
        for (const analysis::SignalFinding& finding : run.audit.findings)
            findings.push_back({{"run", run.run},
                                {"time_s", finding.ended_s},
                                {"signal", finding.signal},
                                {"link", finding.link},
                                {"what", core::name(finding.what)},
                                {"lasted_s", finding.lasted_s},
                                {"least_s", finding.least_s}});
    return findings;
}

/// The first findings of each run, in words.
std::string text_of(const AuditReport& report) {
    std::string text;
    for (const AuditedRun& run : report.runs) {
        if (run.audit.findings.empty()) continue;
        text += fmt::format("{}: {} too short\n", run.run, run.audit.findings.size());
        const std::size_t shown = std::min(shown_findings, run.audit.findings.size());
        for (std::size_t row = 0; row < shown; ++row)
            text += fmt::format("  {}\n", text_of(run.audit.findings[row]));
        if (shown < run.audit.findings.size())
            text += fmt::format("  and {} more: --json has all\n", run.audit.findings.size() - shown);
    }
    return text;
}

}  // namespace

AuditReport audit_runs(const results::Store& store, const std::vector<experiment::RunKey>& keys) {
    AuditReport report;
    std::map<std::string, Audited> audited;
    for (const experiment::RunKey& key : keys) {
        const auto events = store.read_signal_events(key);
        if (!events) {
            ++report.without_requests;
            continue;
        }
        if (!audited.contains(key.scenario)) audited[key.scenario] = limits_of(store, key.scenario);
        const Audited& owed = audited[key.scenario];
        report.runs.push_back(
            {run_name(store.folder(), key), analysis::audit_signals(*events, owed.limits, owed.step_s)});
    }
    return report;
}

Printout audit_printout(const AuditReport& report) {
    const Totals totals = totals_of(report);
    return {
        {{"audited", report.runs.size()},
         {"without_requests", report.without_requests},
         {"yellows", totals.yellows},
         {"red_clearances", totals.reds},
         {"greens", totals.greens},
         {"findings", json_of(report.runs)}},
        {},
        text_of(report) +
            fmt::format("{} audited, {} without requests to signals: {}, {} and {} checked, {} too short\n",
                        counted(report.runs.size(), "run"), report.without_requests,
                        counted(totals.yellows, "yellow"), counted(totals.reds, "red clearance"),
                        counted(totals.greens, "green"), totals.findings)};
}

bool nothing_audited(const AuditReport& report) {
    const Totals totals = totals_of(report);
    return totals.yellows + totals.reds + totals.greens == 0;
}

std::string nothing_audited_text(const AuditReport& report, const std::string& what) {
    if (report.runs.empty())
        return fmt::format(
            "{}: nothing to audit: none of its complete runs requests green. Audit runs of a signal policy, "
            "such as corridor",
            what);
    return fmt::format(
        "{}: nothing to audit: in {}, no signal showed a complete colour of its program. `clearway scenario "
        "signals SCENARIO` lists the signals of a scenario",
        what, counted(report.runs.size(), "run"));
}

core::ExitCode code_of(const AuditReport& report) {
    return totals_of(report).findings > 0 ? core::ExitCode::runs_failed : core::ExitCode::ok;
}

}  // namespace clearway::campaign
