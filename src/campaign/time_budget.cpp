#include "campaign/time_budget.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <regex>
#include <string>

#include <fmt/format.h>

#include "analysis/estimate.hpp"
#include "campaign/detail/run_cost.hpp"
#include "campaign/plan_text.hpp"
#include "campaign/stored_folder.hpp"
#include "core/counted.hpp"
#include "results/run_limit.hpp"
#include "study/side_files.hpp"

namespace clearway::campaign {
namespace {

constexpr std::uint32_t first_round = analysis::fewest_for_interval;
/// Of the time left: a pace is never exact.
constexpr double planned_share = 0.9;
/// A round that adds fewer is not worth its while.
constexpr double least_growth = 0.1;

/// How many more replications the limits of a study allow.
std::uint32_t room_of(const study::StudyConfig& config) {
    const std::uint64_t allowed = config.most_runs / (config.scenarios.size() * config.conditions.size());
    const auto most =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(allowed, results::most_replications));
    return most - std::min(most, config.replications);
}

/// How many more replications a study takes where each costs `each_s`.
std::uint32_t fitting(const study::StudyConfig& config, double left_s, double each_s) {
    return static_cast<std::uint32_t>(
        std::min<double>(planned_share * std::max(0.0, left_s) / each_s, room_of(config)));
}

/// Of the study in a run folder; 0 where there is none.
std::uint32_t replications_in(const std::filesystem::path& folder) {
    const auto stored = study_in(folder);
    return stored ? stored->replications : 0;
}

/// Where `options` name no folder, they get one that no study without a clock has.
void name_folder(study::StudyConfig config, RunOptions& options) {
    if (!options.folder.empty()) return;
    config.replications = first_round;
    plan_for(config, options);
    options.folder += "-timed";
}

/// The command with the number of replications that it came to, which gives these runs on any machine.
std::string repeatable(const std::string& command, std::uint32_t replications) {
    return std::regex_replace(command, std::regex("--within[ =]\\S+"),
                              fmt::format("--seeds {}", replications));
}

/// Says on standard error when the least that can be run is expected to take longer than the time given.
void warn_if_short(const TimeLeft& first, const study::StudyConfig& config, double within_s) {
    if (first.wall_s <= within_s) return;
    fmt::print(stderr,
               "clearway: the least, {} of each condition, takes about {}, more than the {} given: {}\n",
               core::counted(config.replications, "replication"), clock_words(first.wall_s),
               clock_words(within_s), words(first.basis));
}

}  // namespace

study::StudyConfig fitted(study::StudyConfig config, double within_s, RunOptions& options) {
    name_folder(config, options);
    config.replications = replications_in(options.folder) + first_round;
    const auto first = estimated_time_left(plan_for(config, options), options.folder, options.workers);
    if (!first)
        throw core::InputError({"--within", "the time of a run is unknown: its route files cannot be read",
                                "a scenario whose files can be read", "Give --seeds instead"});
    warn_if_short(*first, config, within_s);
    config.replications += fitting(config, within_s - first->wall_s, first->wall_s / first_round);
    return config;
}

core::ExitCode run_within(study::StudyConfig config, double within_s, RunOptions options) {
    const auto started = std::chrono::steady_clock::now();
    const auto elapsed_s = [started] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    };
    name_folder(config, options);
    const std::uint32_t before = replications_in(options.folder);
    config.replications = std::max(first_round, before);
    if (const auto first = estimated_time_left(plan_for(config, options), options.folder, options.workers))
        warn_if_short(*first, config, within_s);
    double made = 0.0;  // replications; without failed runs, which may be of an earlier command
    while (true) {
        const study::Plan plan = plan_for(config, options);
        const results::Store store = prepare_run_folder(plan, options);
        const StudyResult result = run_missing(plan, store, options);
        if (is_interrupted(result.exit_code)) return result.exit_code;
        const auto runs = static_cast<double>(result.progress.done - result.progress.resumed);
        made += runs * config.replications / static_cast<double>(plan.run_count());
        std::uint32_t more = 0;
        if (made > 0.0) {
            more = fitting(config, within_s - elapsed_s(), elapsed_s() / made);
            if (more < least_growth * config.replications) more = 0;
        } else if (config.replications == before) {  // complete before this command
            more = std::min(first_round, room_of(config));
        }
        if (more == 0) {
            study::keep_command(store, repeatable(options.command, config.replications), study::Growth::more);
            fmt::print(stderr, "clearway: {} in {}, of {} given; the same without a clock: --seeds {}\n",
                       core::counted(config.replications, "replication"), clock_words(elapsed_s()),
                       clock_words(within_s), config.replications);
            return publish(store, options.publish);
        }
        config.replications += more;
    }
}

}  // namespace clearway::campaign
