#include "campaign/detail/failures.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "campaign/detail/abort_cure.hpp"
#include "campaign/run_name.hpp"
#include "core/counted.hpp"
#include "report/text.hpp"

namespace clearway::campaign {
namespace {

/// Kinds of failures that are told; more are in runs.csv.
constexpr std::size_t named_errors = 10;
/// Lines of a failure's message that are told: those of long tracebacks are in its file.
constexpr std::size_t told_lines = 16;

/// `: the last line of a log`, or nothing, as where the message holds it, or where what failed is not SUMO's:
/// its warnings say nothing of a part in Python.
std::string last_words(const results::RunError& error) {
    if (error.cause == results::ErrorCause::python) return "";
    std::string log = error.log_tail;
    while (log.ends_with('\n')) {
        log.pop_back();
    }
    const std::size_t line = log.rfind('\n');
    if (line != std::string::npos) log.erase(0, line + 1);
    return log.empty() || error.message.find(log) != std::string::npos ? "" : ": " + log;
}

/// What equal failures have in common: their first line without its numbers, such as times and keys of
/// vehicles, but with those of lines of code.
std::string kind_of(const results::RunError& error) {
    const std::string first = error.message.substr(0, error.message.find('\n')) + last_words(error);
    std::string kind = error.key.scenario + '/' + error.key.condition + ' ';
    for (const char letter : first)
        if (std::isdigit(static_cast<unsigned char>(letter)) == 0 ||
            kind.find(", line ") != std::string::npos)
            kind += letter;
    return kind;
}

/// The lines of a message, set in, without those in the middle of a long one.
std::string told(const std::string& message) {
    std::vector<std::string> lines;
    std::istringstream text(message);
    for (std::string line; std::getline(text, line);)
        lines.push_back(line);
    if (lines.size() > told_lines) {
        lines.erase(lines.begin() + 2, lines.end() - told_lines + 3);
        lines.insert(lines.begin() + 2, "...");
    }
    return fmt::format("{}", fmt::join(lines, "\n    "));
}

/// ` (in 3 of 3 runs)`, or nothing for one.
std::string in_runs(std::size_t count, const results::Manifest& manifest) {
    return count == 1 ? ""
                      : fmt::format(" (in {} of {})", count, core::counted(manifest.replications, "run"));
}

}  // namespace

void name_errors(const results::Store& store, const results::Results& results) {
    if (results.errors.empty()) return;
    fmt::print(stderr, "clearway: {} of {} failed; their logs are in {}\n", results.errors.size(),
               core::counted(results.manifest.run_count(), "run"), (store.folder() / "logs").string());
    std::set<std::string> cures;
    std::map<std::string, std::vector<const results::RunError*>> kinds;
    std::vector<std::string> order;
    for (const results::RunError& error : results.errors) {
        std::vector<const results::RunError*>& same = kinds[kind_of(error)];
        if (same.empty()) order.push_back(kind_of(error));
        same.push_back(&error);
    }
    for (const std::string& kind : std::span(order).first(std::min(order.size(), named_errors))) {
        const results::RunError& first = *kinds[kind].front();
        fmt::print(stderr, "  {}{}: {}{}\n    in full: {}\n", run_name(store.folder(), first.key),
                   in_runs(kinds[kind].size(), results.manifest), told(first.message), last_words(first),
                   store.error_file(first.key).string());
        if (const std::string cure = cure_of_abort(first); !cure.empty()) cures.insert(cure);
    }
    for (const std::string& cure : cures)
        fmt::print(stderr, "  {}\n", cure);
    if (order.size() > named_errors)
        fmt::print(stderr, "  and {} kinds of failure more, in {}\n", order.size() - named_errors,
                   store.runs_csv().string());
    const auto passing = std::ranges::count_if(results.errors, results::may_pass, &results::RunError::cause);
    if (passing == 0) {
        fmt::print(stderr, "  The same command does not repeat them; with --retry-failed it does\n");
        return;
    }
    fmt::print(stderr,
               "  The command of the study tries again those that a signal, a limit or the machine ended "
               "({}); with --retry-failed all of them\n",
               passing);
}

void tell_failed(const results::Results& results, const report::StudyFacts& facts, core::ExitCode code) {
    if (results.errors.empty()) return;
    std::set<std::string> without;
    for (const report::ScenarioFacts& scenario : facts.scenarios)
        for (const report::ConditionFacts& condition : scenario.conditions)
            if (condition.complete_runs == 0 && !condition.failed.empty())
                without.insert(report::printable(condition.label()));
    fmt::print(stderr, "clearway: {} of {} failed{}{} (exit code {})\n", results.errors.size(),
               core::counted(results.manifest.run_count(), "run"), without.empty() ? "" : ", all of ",
               fmt::join(without, ", "), static_cast<int>(code));
}

}  // namespace clearway::campaign
