#include "cli/detail/common_options.hpp"

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/estimate.hpp"
#include "campaign/publication.hpp"
#include "campaign/workers.hpp"
#include "cli/detail/app.hpp"
#include "core/number.hpp"
#include "experiment/loop_config.hpp"
#include "experiment/run_job.hpp"
#include "report/console.hpp"

namespace clearway::cli {
namespace {

/// `90s`, `10min` or `2h` in seconds; nothing for other text and for times outside 1 s to 1000 h.
std::optional<double> duration_from(std::string_view text) {
    const std::size_t unit_at = text.find_first_not_of("0123456789.");
    if (unit_at == std::string_view::npos) return std::nullopt;
    const std::string_view unit = text.substr(unit_at);
    const auto number = core::number_from(text.substr(0, unit_at));
    if (!number || (unit != "s" && unit != "min" && unit != "h")) return std::nullopt;
    const double seconds = *number * (unit == "s" ? 1.0 : unit == "min" ? 60.0 : 3600.0);
    if (!(seconds >= 1.0 && seconds <= 3.6e6)) return std::nullopt;
    return seconds;
}

}  // namespace

void add_json_option(App& app, Printing& printing, const std::string& what) {
    app.add_flag_callback(
        "--json", [&printing] { printing = Printing::json; },
        fmt::format("Print {} as JSON, with units in the field names [text]", what));
}

void add_tables_option(App& app, report::Tables& tables) {
    app.add_flag_callback(
        "--tables", [&tables] { tables = report::Tables::all; },
        "Print the tables of all measures [verdicts and the two main measures]");
}

void add_response_option(App& app, std::optional<double>& threshold_s) {
    constexpr double longest_s = 86400.0;
    app.add_option("--response-threshold", threshold_s,
                   "An EV trip is in time if it takes no longer; one that does not arrive is late")
        .range(0.1, longest_s)
        .option_text("SECONDS, 0.1 to 86400 [100 s per km of the mean EV route]");
}

void add_shown_condition_option(App& app, std::string& condition) {
    app.add_option("--condition", condition,
                   "Condition, by name or title, that headline, map, trip, journeys and replays show")
        .option_text("NAME [of each scenario the one that helps most]");
}

void add_record_option(App& app, experiment::StepRecording& recording) {
    app.add_flag_callback(
        "--record", [&recording] { recording = experiment::StepRecording::on; },
        "Keep every step below recordings/, for clearway replay; changes no result [off]");
}

void add_jobs_option(App& app, unsigned& jobs) {
    app.add_option("--jobs", jobs, "Worker processes at a time; 0: one per core. Changes no result")
        .range(0U, 4096U)
        .option_text(fmt::format("N, 0 to 4096 [{}]", jobs));
}

Option add_seed_option(App& app, std::uint64_t& seed) {
    constexpr std::int64_t greatest =
        std::numeric_limits<std::int64_t>::max();  // the greatest that TOML can write
    return app.add_option("--seed", seed, "Study seed: equal seeds, equal results")
        .range(std::int64_t{0}, greatest)
        .option_text(fmt::format("N, 0 to 2^63-1 [{}]", seed));
}

Option add_seeds_option(App& app, std::uint32_t& seeds) {
    return app
        .add_option("--seeds", seeds,
                    "Replications; in each, all conditions share demand, drivers and failures")
        .range(1U, most_replications)
        .option_text(fmt::format("N, 1 to {} [{}]", most_replications, seeds));
}

Option add_within_option(App& app, double& within_s) {
    const auto set = [&within_s](const std::string& text) { within_s = duration_from(text).value(); };
    return app
        .add_option_function<std::string>(
            "--within", set,
            fmt::format("As many seeds as this time allows, {} at least, in place of a number of them",
                        analysis::fewest_for_interval))
        .check([](const std::string& text) {
            return duration_from(text)
                       ? std::string()
                       : fmt::format("`{}` is no time from 1 s to 1000 h, such as 90s, 10min or 2h", text);
        })
        .option_text("TIME, such as 10min [none]");
}

void add_limit_options(App& app, experiment::RunLimits& limits) {
    app.add_option("--run-time-limit", limits.wall_s, "Wall time after which a run is ended, s")
        .range(0.001, 1e7)
        .option_text(fmt::format("SECONDS, 0.001 to 1e7 [{:g}]", limits.wall_s));
    app.add_option("--memory-limit", limits.memory_mib, "Memory above which a run is ended, MiB; 0: none")
        .range(0L, 100000000L)
        .option_text(fmt::format("MIB, 0 to 1e8 [{}]", limits.memory_mib));
}

void add_most_runs_option(App& app, std::uint64_t& most_runs) {
    app.add_option("--most-runs", most_runs, "A study with more runs is refused")
        .range(std::uint64_t{1}, results::greatest_most_runs)
        .option_text(fmt::format("N, 1 to {} [{}]", results::greatest_most_runs, most_runs));
}

void add_retry_option(App& app, campaign::RetriedRuns& retried) {
    app.add_flag_callback(
        "--retry-failed", [&retried] { retried = campaign::RetriedRuns::all_failed; },
        "Try all failed runs in the run folder again [those that a signal, a limit or the machine ended]");
}

void add_publish_options(App& app, campaign::Publication& publication) {
    const auto digits = [](std::size_t least, std::size_t most) {
        return [least, most](const std::string& text) {
            const bool is_hexadecimal = text.find_first_not_of("0123456789abcdef") == std::string::npos;
            return is_hexadecimal && text.size() >= least && text.size() <= most
                       ? std::string()
                       : fmt::format("`{}` is not {} to {} digits 0 to f", text, least, most);
        };
    };
    const Option file = app.add_option("--publish", publication.file,
                                       "Write the results as rows of this CSV file, replacing earlier ones")
                            .option_text("results/FILE.csv [none]");
    app.add_option("--tree", publication.tree, "Commit of the tree that made the runs, for the rows")
        .needs(file)
        .check(digits(7, 40))
        .option_text("COMMIT [that of this tree]");
    app.add_option("--behaviour", publication.behaviour, "What scripts/render-docs --behaviour prints there")
        .needs(file)
        .check(digits(12, 12))
        .option_text("DIGITS [that of this tree]");
}

std::vector<Option> add_link_options(App& app, experiment::LinkSettings& links) {
    return {app.add_option("--link-radius", links.link_radius_m, "Vehicles nearer than this are linked, m")
                .range(1.0, 1000.0)
                .option_text(fmt::format("METRES, 1 to 1000 [{}]", links.link_radius_m)),
            app.add_flag_callback(
                "--automated-links", [&links] { links.automated_links = 1; },
                "Two automated vehicles may be linked, too [no]")};
}

}  // namespace clearway::cli
