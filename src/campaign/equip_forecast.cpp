#include "campaign/detail/equip_forecast.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "campaign/detail/equip_search.hpp"
#include "campaign/detail/run_cost.hpp"
#include "campaign/printout.hpp"
#include "core/error.hpp"
#include "core/json.hpp"
#include "core/process.hpp"
#include "core/supervisor.hpp"
#include "core/temporary_folder.hpp"
#include "core/terminal.hpp"
#include "experiment/related_conditions.hpp"
#include "report/equipment.hpp"
#include "report/text.hpp"
#include "report/verdict.hpp"

namespace clearway::campaign {

using detail::Search;
using detail::search_of;

namespace {

/// Of a run of the scenario, s: from earlier runs in the folder or beside it, else rough or nothing.
RunCost cost_of(const Search& search, const EquipRequest& request) {
    study::StudyConfig config = search.config;
    config.conditions = {experiment::baseline_for(request.condition), request.condition};
    RunOptions options = request.run;
    const study::Plan plan = plan_for(config, options);
    RunCost cost;
    for (const std::filesystem::path& folder :
         {request.run.folder / EquipRounds::first_round, request.run.folder}) {
        cost =
            CostBook(folder).of(config.scenarios.front(), plan.manifest.scenarios.front().configuration_hash,
                                request.condition.traffic_model);
        if (cost.basis == CostBasis::measured) break;
    }
    return cost;
}

/// The time of a whole search, s.
double time_of(const EquipRounds& rounds, const EquipRequest& request, std::size_t budget,
               std::uint32_t seeds, double run_s) {
    return static_cast<double>(rounds.forecast(budget, seeds).likely()) * run_s /
           static_cast<double>(core::process_count(request.run.workers));
}

void warn_of_least(const EquipRounds& rounds, const EquipRequest& request, const RunCost& cost) {
    const auto time_s = [&](std::size_t budget) {
        return time_of(rounds, request, budget, request.replications, *cost.wall_s);
    };
    std::size_t less = request.budget - 1;
    while (less > 1 && time_s(less) > request.within_s)
        --less;
    core::print_message(fmt::format(
        "clearway: the least, {} seeds, takes about {} from nothing, more than the {} given ({}), and is "
        "made all the same; {}fewer --candidates take less\n",
        request.replications, clock_words(time_s(request.budget)), clock_words(request.within_s),
        words(cost.basis),
        less > 0 ? fmt::format("--budget {} takes about {}, ", less, clock_words(time_s(less))) : ""));
}

/// As many seeds as the time allows. More seeds take more time than in proportion to the fewest, as their
/// vehicles may pass other signals: what that gives is therefore looked at again.
std::uint32_t seeds_within(EquipRequest request, const scenario::BuiltNetwork& built) {
    request.replications = analysis::fewest_for_interval;
    const Search least = search_of(request, built);
    const RunCost cost = cost_of(least, request);
    if (!cost.wall_s)
        throw core::InputError({"--within", "the time of a run is unknown: its route files cannot be read",
                                "a scenario whose files can be read", "Give --seeds instead"});
    const double least_s = time_of(least.rounds, request, request.budget, request.replications, *cost.wall_s);
    if (least_s > request.within_s) {
        warn_of_least(least.rounds, request, cost);
        return request.replications;
    }
    request.replications = static_cast<std::uint32_t>(std::min<double>(
        request.replications * request.within_s / least_s, analysis::most_equip_replications));
    const Search most = search_of(request, built);
    std::uint32_t seeds = request.replications;
    while (seeds > analysis::fewest_for_interval &&
           time_of(most.rounds, request, request.budget, seeds, *cost.wall_s) > request.within_s)
        --seeds;
    return seeds;
}

/// Complete runs of earlier calls; one that a later round took over counts once.
std::size_t runs_in_rounds_of(const std::filesystem::path& folder) {
    std::set<std::pair<std::uint64_t, experiment::RunKey>> runs;  // after the seed of the round
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
        if (!std::filesystem::exists(entry.path() / "manifest.json")) continue;
        const results::Store round = results::Store::open(entry.path());
        for (const experiment::RunKey& key : round.complete_runs())
            runs.emplace(round.manifest().study_seed, key);
    }
    return runs.size();
}

/// What becomes of gains over few seeds; empty for more.
const char* few_seeds_warning(std::uint32_t seeds) {
    return seeds < report::fewest_to_trust ? " So few seeds show large gains alone." : "";
}

/// What a first look of a quarter of an hour could be, the most places and then seeds, where what is asked
/// for takes longer; else empty. A run adds `run_s` to the time.
std::string short_plan(const EquipRounds& rounds, const EquipRequest& request, std::size_t candidates,
                       double run_s) {
    constexpr std::size_t minutes = 15;
    const auto seconds = [&](const EquipForecast& runs) {
        return static_cast<double>(runs.likely()) * run_s;
    };
    const auto fits = [&](const EquipForecast& runs) { return seconds(runs) <= 60.0 * minutes; };
    if (candidates == 0 || fits(rounds.forecast())) return "";
    for (std::size_t budget = std::min(request.budget, candidates); budget > 0; --budget) {
        for (std::uint32_t seeds = request.replications; seeds >= analysis::fewest_for_interval; --seeds)
            if (fits(rounds.forecast(budget, seeds)))
                return fmt::format(" A first look, within {} minutes: --seeds {} --budget {}.{}", minutes,
                                   seeds, budget, few_seeds_warning(seeds));
    }
    // Which signals trips pass is known for the seeds that were asked for: more take as much each.
    const auto known = std::min<std::uint32_t>(request.replications, analysis::fewest_for_interval);
    const double least_s = seconds(rounds.forecast(1, known)) * analysis::fewest_for_interval / known;
    return fmt::format(" The smallest plan with intervals, of {}, takes about {}: --seeds {} --budget 1.{}{}",
                       report::counted(candidates, "candidate"), clock_words(least_s),
                       analysis::fewest_for_interval, few_seeds_warning(analysis::fewest_for_interval),
                       candidates > 1 ? " Fewer --candidates take less." : "");
}

/// The words with a number of seeds in place of the time.
std::vector<std::string> timeless(std::vector<std::string> words, std::uint32_t seeds) {
    const auto found = std::ranges::find_if(
        words, [](const std::string& word) { return word == "--within" || word.starts_with("--within="); });
    if (found != words.end()) words.erase(found, found + (*found == "--within" ? 2 : 1));
    return core::with_option(std::move(words), "--seeds", std::to_string(seeds));
}

/// How many runs, and what speaks against so few seeds or so large a budget.
std::string amount_words(const EquipRequest& request, const EquipForecast& runs, std::size_t held,
                         std::size_t candidates, const std::string& small_map) {
    std::string words =
        fmt::format("{} likely, {} at most, of --seeds {}, into {}", report::counted(runs.likely(), "run"),
                    runs.most(), request.replications, request.run.folder.string());
    if (held > 0)
        words +=
            fmt::format(", which holds {} of earlier calls; those that it needs are not made again", held);
    words += ".";
    if (request.budget > candidates)
        words += fmt::format(" The budget is {}, and {} could gain.", request.budget,
                             report::counted(candidates, "signal"));
    if (request.replications < analysis::fewest_for_interval)
        words += fmt::format(" Nothing can be shown by fewer than {} seeds.", analysis::fewest_for_interval);
    if (!small_map.empty()) words += fmt::format(" Little to rank on this map: {}.", small_map);
    return words;
}

/// What held runs say of locks; without any, what would.
std::string lock_words(const EquipRounds& rounds, const EquipRequest& request) {
    const report::UnsoundRuns unsound = rounds.first_unsound();
    if (unsound.runs > 0) return lock_warning(unsound, core::shell_text(request.calmer));
    return core::wrapped(
               "Whether vehicles lock each other, runs alone tell: clearway scenario check with "
               "--lock-trials 6 "
               "looks before.",
               0) +
           "\n";
}

}  // namespace

EquipRequest detail::fitted(EquipRequest request, const scenario::BuiltNetwork& built) {
    if (request.within_s <= 0.0) return request;
    request.replications = seeds_within(request, built);
    for (std::vector<std::string>* const words : {&request.words, &request.calmer, &request.more_seeds})
        *words = timeless(*words, request.replications);
    request.run.command = core::shell_text(request.words);
    if (request.replications > analysis::fewest_for_interval)
        core::print_message(fmt::format("clearway: {} allow about --seeds {}\n",
                                        clock_words(request.within_s), request.replications));
    return request;
}

core::ExitCode equip_dry_run(EquipRequest request) {
    const core::TemporaryFolder network_folder;
    const scenario::BuiltNetwork built = detail::roads_of(request, network_folder.path());
    request = detail::fitted(std::move(request), built);
    const Search search = search_of(request, built);
    core::print_message(search.rounds.same_with_other_seeds());
    search.rounds.require_fits();
    const EquipForecast runs = search.rounds.forecast();
    const RunCost cost = cost_of(search, request);
    const std::size_t processes = core::process_count(request.run.workers);
    const double run_s = cost.wall_s.value_or(0.0) / static_cast<double>(processes);
    const auto seconds = [&](std::size_t count) -> core::Json {
        if (!cost.wall_s) return nullptr;
        return static_cast<double>(count) * run_s;
    };
    const auto clock = [&](std::size_t count) {
        const core::Json left_s = seconds(count);
        return left_s.is_null() ? "-" : clock_words(left_s.get<double>());
    };
    Table table{"stages",
                {{"stage", "stage"},
                 {"runs", "runs"},
                 {"most_runs", "at most"},
                 {"estimated_time_s", ""},
                 {"", "about"}},
                {}};
    const auto add = [&](const std::string& stage, std::size_t likely, std::size_t most) {
        table.rows.push_back({{stage, likely, most, seconds(likely), clock(likely)}});
    };
    const std::size_t candidates = search.signals.candidates.signals.size();
    const std::size_t first =
        std::min<std::size_t>(analysis::equip_looks(request.replications).front(), request.replications);
    const std::size_t pairs = request.budget > 1 ? search.signals.candidates.neighbours.size() : 0;
    add(fmt::format("place 1: {}{} on {} seeds", report::counted(candidates, "candidate"),
                    pairs > 0 ? " and " + report::counted(pairs, "pair") : "", first),
        runs.first_look, runs.first_look);
    if (runs.race > 0)
        add(fmt::format("place 1: on {} seeds, if none drops out", request.replications), runs.race,
            runs.race);
    add("later places", runs.later, runs.later_most);
    add("fresh seeds: estimate", runs.fresh, runs.fresh);
    const std::size_t held = runs_in_rounds_of(request.run.folder);
    const std::size_t rest = runs.likely() - std::min(held, runs.likely());
    const std::string first_told =
        held < runs.first_look
            ? fmt::format(" Nothing can be told before about {}.", clock(runs.first_look - held))
            : "";
    const std::string time =
        cost.wall_s
            ? fmt::format(
                  "About {}{} with {} ({}){}.{}", clock(rest), held == 0 ? "" : " for the rest",
                  report::counted(processes, "worker"), words(cost.basis),
                  cost.basis == CostBasis::measured ? "" : "; loading and warm-up of each seed come on top",
                  first_told)
            : "Time unknown: a run of this scenario beside that folder tells.";
    // Who gives a time has chosen how long it may take.
    const std::string shorter =
        cost.wall_s && request.within_s <= 0.0 ? short_plan(search.rounds, request, candidates, run_s) : "";
    const report::SignalsMet& met = search.signals.candidates.met;
    const std::string small_map = report::small_map_words(
        std::min(request.budget, candidates), candidates + search.signals.candidates.less_red, met);
    const std::string outlook = scenario::outlook_sentence(search.signals.candidates.outlook);
    print({{{"folder", request.run.folder.string()},
            {"share_of_trips_with_signals", core::to_json_value(met.share())},
            {"signals_per_trip", core::to_json_value(met.mean())},
            {"outlook", outlook},
            {"candidates", candidates},
            {"replications", request.replications},
            {"runs", runs.likely()},
            {"most_runs", runs.most()},
            {"held_runs", held},
            {"held_runs_say_little", search.rounds.first_unsound().say_little()},
            {"estimated_time_s", seconds(runs.likely())},
            {"estimate_measured", cost.basis == CostBasis::measured}},
           {table},
           core::wrapped(amount_words(request, runs, held, candidates, small_map), 0) + "\n" +
               core::wrapped(time + shorter, 0) + "\n" + lock_words(search.rounds, request),
           core::wrapped(met.words(), 0) + "\n" + core::wrapped(report::printable(outlook), 0) + "\n\n"},
          request.run.publish.printing);
    return core::ExitCode::ok;
}

}  // namespace clearway::campaign
