#include "campaign/equip.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "campaign/detail/run_cost.hpp"
#include "campaign/equip_rounds.hpp"
#include "campaign/names.hpp"
#include "campaign/printout.hpp"
#include "core/error.hpp"
#include "core/json.hpp"
#include "core/leftovers.hpp"
#include "core/own_output.hpp"
#include "core/temporary_folder.hpp"
#include "core/terminal.hpp"
#include "experiment/conditions.hpp"
#include "experiment/equipped_signals.hpp"
#include "experiment/settings.hpp"
#include "policy/policy.hpp"
#include "python/part_name.hpp"
#include "report/equipment.hpp"
#include "report/text.hpp"
#include "scenario/network.hpp"
#include "scenario/signal_sheet.hpp"

namespace clearway::campaign {
namespace {

bool has_own_code(const experiment::ConditionSpec& base) {
    return std::ranges::any_of(
        base.policies, [](const std::string& policy) { return python::part_name_from(policy).has_value(); });
}

[[noreturn]] void refuse_all_equipped() {
    throw core::InputError({experiment::equipped_setting, "says that every signal is equipped today",
                            "ids of those that are, separated by commas, or none", "Leave it out for none"});
}

void check_condition(const experiment::ConditionSpec& base) {
    check_names({base});
    const auto today = base.settings.find(experiment::equipped_setting);
    if (today != base.settings.end() && today->second == experiment::all_equipped) refuse_all_equipped();
    const bool has_signals = !experiment::policies_with(base, traffic::Trait::asks_signals).empty();
    if (!has_signals && !has_own_code(base))
        throw core::InputError(
            {"condition " + base.name, "has no policy that requests green from signals",
             fmt::format("one with {}, such as corridor",
                         core::listed(policy::policies().names(traffic::Trait::asks_signals))),
             "Leave out --condition and --policy to use corridor"});
}

struct Signals {
    scenario::BuiltNetwork built;
    EquipCandidates candidates;
    std::vector<std::string> all_streets;  ///< By core::SignalIndex.
    std::vector<bool> today;               ///< Which are equipped; empty: none.

    /// As `clearway scenario signals` counts, from 1.
    std::size_t number(std::size_t candidate) const { return candidates.signals.at(candidate).value + 1U; }
    const std::string& streets(std::size_t candidate) const {
        return all_streets.at(candidates.signals.at(candidate).value);
    }
    const std::string& id(std::size_t candidate) const {
        return built.network.signal(candidates.signals.at(candidate)).id;
    }
    std::vector<std::string> ids_of_today() const {
        std::vector<std::string> ids;
        for (std::size_t signal = 0; signal < today.size(); ++signal)
            if (today[signal]) ids.push_back(built.network.signals()[signal].id);
        return ids;
    }
};

/// `Via Po / Via Roma`, each once.
std::string streets_of(const scenario::SignalSheet& sheet) {
    std::vector<std::string> names;
    for (const scenario::SignalApproach& approach : sheet.approaches) {
        if (!approach.street.empty() && std::ranges::find(names, approach.street) == names.end())
            names.push_back(approach.street);
    }
    return fmt::format("{}", fmt::join(names, " / "));
}

Signals signals_of(const study::StudyConfig& config, const EquipRequest& request,
                   const std::filesystem::path& folder) {
    const scenario::ScenarioConfig& scenario = config.scenarios.front();
    Signals signals{scenario::build_network(scenario, folder), {}, {}, {}};
    if (signals.built.network.signals().empty())
        throw core::InputError({"scenario " + scenario.name, "has no signals", "a network with signals",
                                "`clearway scenario signals SCENARIO` lists those of a scenario"});
    signals.today = experiment::equipped_signals(request.condition, signals.built.network);
    if (signals.ids_of_today().size() == signals.built.network.signals().size()) refuse_all_equipped();
    signals.candidates = equip_candidates(config, signals.built, signals.today, request.most_candidates);
    for (const scenario::SignalSheet& sheet : scenario::signal_sheets(signals.built.network, {}))
        signals.all_streets.push_back(streets_of(sheet));
    return signals;
}

EquipQuestion question_of(const study::StudyConfig& config, const EquipRequest& request,
                          const Signals& signals) {
    EquipQuestion question{.config = config,
                           .base = request.condition,
                           .signals = {},
                           .today = signals.ids_of_today(),
                           .passed = signals.candidates.passed,
                           .pairs = signals.candidates.neighbours,
                           .budget = request.budget,
                           .search = request.search};
    question.base.settings.erase(experiment::equipped_setting);  // with all equipped
    analysis::SignalSet all;
    for (std::size_t candidate = 0; candidate < signals.candidates.signals.size(); ++candidate) {
        all.push_back(candidate);
        question.signals.push_back(signals.id(candidate));
    }
    // A user's code may ask signals that no emergency vehicle passes.
    if (has_own_code(request.condition)) question.passed.assign(config.replications, all);
    return question;
}

analysis::MaybeEstimate less(const analysis::Values& before, const analysis::Values& after,
                             double level = analysis::usual_level) {
    return analysis::estimate_paired(before, after, analysis::MetricKind::quantity, level);
}

analysis::MaybeEstimate mean(const EquipOutcome& outcome) {
    return analysis::estimate_values(outcome.emergency_s, analysis::MetricKind::quantity);
}

void add_candidates(const analysis::EquipPlan& plan, const Signals& signals, report::EquipmentFacts& facts) {
    for (std::size_t candidate = 0; candidate < plan.candidates.size(); ++candidate) {
        const analysis::EquipCandidate& found = plan.candidates[candidate];
        facts.candidates.push_back({signals.number(candidate), signals.id(candidate),
                                    signals.streets(candidate), signals.candidates.trips[candidate],
                                    found.gain, found.left_race, std::nullopt});
    }
    for (std::size_t rank = 0; rank < plan.steps.size(); ++rank)
        facts.candidates.at(plan.steps[rank].candidate).rank = rank + 1;
}

void add_outcomes(const analysis::EquipPlan& plan, const Signals& signals, const FreshOutcomes& fresh,
                  report::EquipmentFacts& facts) {
    const auto gain = [&](const EquipOutcome& after) {
        return less(fresh.none.emergency_s, after.emergency_s);
    };
    const auto loss = [&](const EquipOutcome& after) { return less(after.others_s, fresh.none.others_s); };
    facts.baseline_s = mean(fresh.baseline);
    facts.none_s = mean(fresh.none);
    facts.all_s = mean(fresh.all);
    facts.alone_s = mean(fresh.alone);
    facts.all_gain = gain(fresh.all);
    facts.all_others = loss(fresh.all);
    const double together = 1.0 - (1.0 - analysis::usual_level) /
                                      static_cast<double>(std::max<std::size_t>(plan.steps.size(), 1));
    for (std::size_t rank = 0; rank < plan.steps.size(); ++rank) {
        const analysis::EquipStep& step = plan.steps[rank];
        const EquipOutcome& before = rank == 0 ? fresh.none : fresh.chosen[rank - 1];
        const EquipOutcome& after = fresh.chosen.at(rank);
        facts.ranked.push_back(
            {signals.number(step.candidate), signals.id(step.candidate), signals.streets(step.candidate),
             less(before.emergency_s, after.emergency_s, together), gain(after), loss(after), step.gain});
    }
}

void add_pairs(const analysis::EquipPlan& plan, const Signals& signals, const FreshOutcomes& fresh,
               report::EquipmentFacts& facts) {
    for (std::size_t row = 0; row < plan.pairs.size(); ++row) {
        const std::array<std::size_t, 2>& both = signals.candidates.neighbours.at(row);
        report::EquipPairFacts& pair = facts.pairs.emplace_back();
        pair.numbers = {signals.number(both[0]), signals.number(both[1])};
        pair.gain = plan.pairs[row].gain;
        pair.left_race = plan.pairs[row].left_race;
        const auto chosen = std::ranges::find_if(plan.steps, [&](const analysis::EquipStep& step) {
            return step.candidate == both[0] && step.partner == both[1];
        });
        if (chosen == plan.steps.end()) continue;
        pair.chosen = true;
        const auto rank = static_cast<std::size_t>(chosen - plan.steps.begin());
        pair.both_gain = less((rank == 0 ? fresh.none : fresh.chosen.at(rank - 1)).emergency_s,
                              fresh.chosen.at(rank + 1).emergency_s);
    }
}

report::EquipmentFacts facts_of(const study::StudyConfig& config, const EquipRequest& request,
                                const Signals& signals) {
    report::EquipmentFacts facts;
    facts.scenario = config.scenarios.front().name;
    facts.title = config.scenarios.front().title;
    facts.attribution = config.scenarios.front().network.attribution;
    facts.condition = request.condition.name;
    facts.command = request.run.command;
    facts.seed = config.seed;
    facts.replications = config.replications;
    facts.step_length_s = config.scenarios.front().time.step_length_s;
    facts.budget = request.budget;
    facts.signals = signals.built.network.signals().size();
    facts.met = signals.candidates.met;
    facts.not_passed = signals.candidates.not_passed;
    facts.switched_off = signals.candidates.switched_off;
    facts.equipped_today = signals.ids_of_today();
    facts.equipped_and_passed = signals.candidates.equipped;
    facts.seldom_passed = signals.candidates.seldom_passed;
    return facts;
}

void write_files(const report::EquipmentFacts& facts, const std::filesystem::path& folder) {
    std::ostringstream page;
    report::write_equipment_page(facts, page);
    core::write_output(folder / "report.html", page.str());
    core::write_output(folder / "equip.csv", report::equipment_csv(facts));
    core::write_output(folder / "candidates.csv", report::candidates_csv(facts));
    core::write_output(folder / "pairs.csv", report::pairs_csv(facts));
    core::write_output(folder / "equip.json", report::equipment_json(facts));
    core::write_output(folder / "curve.svg", report::equipment_curve(facts));
    core::write_output(folder / "map.svg", report::equipment_map(facts));
}

/// `runs/equip-SCENARIO-xxxxxx`, where the hash stands for what is run.
std::filesystem::path usual_folder(study::StudyConfig config, const experiment::ConditionSpec& base) {
    config.conditions = {experiment::baseline_for(base), base};
    RunOptions options;
    plan_for(config, options);
    return options.folder;
}

/// It can be written, and may hold nothing, or the rounds of an earlier call.
void check_folder(const std::filesystem::path& folder) {
    core::require_own(folder, {"clearway equip", {EquipRounds::first_round}});
    core::require_writable(folder);
}

/// What both verbs begin with.
struct Search {
    study::StudyConfig config;
    Signals signals;
    EquipRounds rounds;
};

Search search_of(EquipRequest& request, const std::filesystem::path& network_folder) {
    check_condition(request.condition);
    study::StudyConfig config = study_of(request.scenario, {}, request.seed, request.replications);
    config.name = "equip-" + config.name;
    Signals signals = signals_of(config, request, network_folder);
    if (request.run.folder.empty()) request.run.folder = usual_folder(config, request.condition);
    check_folder(request.run.folder);
    EquipQuestion question = question_of(config, request, signals);
    return {std::move(config), std::move(signals), EquipRounds(std::move(question), request.run)};
}

/// Of a run of the scenario, s: from earlier runs in the folder or beside it, else rough or nothing.
RunCost cost_of(const Search& search, const EquipRequest& request) {
    study::StudyConfig config = search.config;
    config.conditions = {experiment::baseline_for(request.condition), request.condition};
    RunOptions options = request.run;
    const study::Plan plan = plan_for(config, options);
    RunCost cost;
    for (const std::filesystem::path& folder : {request.run.folder / "round-01", request.run.folder}) {
        cost =
            CostBook(folder).of(config.scenarios.front(), plan.manifest.scenarios.front().configuration_hash,
                                request.condition.traffic_model);
        if (cost.basis == CostBasis::measured) break;
    }
    return cost;
}

/// What a first look of a quarter of an hour could be, the most seeds and then places, where what is asked
/// for takes longer; else empty. A run adds `run_s` to the time.
std::string short_plan(const EquipRounds& rounds, const EquipRequest& request, std::size_t candidates,
                       double run_s) {
    constexpr std::size_t minutes = 15;
    const auto seconds = [&](const EquipForecast& runs) {
        return static_cast<double>(runs.likely()) * run_s;
    };
    const auto fits = [&](const EquipForecast& runs) { return seconds(runs) <= 60.0 * minutes; };
    if (candidates == 0 || fits(rounds.forecast())) return "";
    for (std::uint32_t seeds = request.replications; seeds >= analysis::fewest_for_interval; --seeds) {
        for (std::size_t budget = std::min(request.budget, candidates); budget > 0; --budget)
            if (fits(rounds.forecast(budget, seeds)))
                return fmt::format(" A first look, in {} minutes: --seeds {} --budget {}.", minutes, seeds,
                                   budget);
    }
    // Which signals trips pass is known for the seeds that were asked for: more take as much each.
    const auto known = std::min<std::uint32_t>(request.replications, analysis::fewest_for_interval);
    const double least_s = seconds(rounds.forecast(1, known)) * analysis::fewest_for_interval / known;
    return fmt::format(
        " The smallest plan that can show something of {} takes about {}: --seeds {} --budget 1.{}",
        report::counted(candidates, "candidate"), clock_words(least_s), analysis::fewest_for_interval,
        candidates > 1 ? " Fewer --candidates take less." : "");
}

}  // namespace

core::ExitCode equip(EquipRequest request) {
    const core::TemporaryFolder network_folder;
    Search search = search_of(request, network_folder.path());
    EquipRounds& rounds = search.rounds;
    const analysis::EquipConfig config{.candidates = search.signals.candidates.signals.size(),
                                       .budget = request.budget,
                                       .replications = request.replications,
                                       .search = request.search,
                                       .pairs = search.signals.candidates.neighbours};
    const analysis::EquipPlan plan = analysis::equip_greedily(
        config, [&](const std::vector<analysis::SignalSet>& sets, std::size_t replications) {
            return rounds.measure(sets, replications);
        });
    analysis::SignalSet chosen;
    for (const analysis::EquipStep& step : plan.steps)
        chosen.push_back(step.candidate);
    const FreshOutcomes fresh = rounds.estimate(chosen);
    report::EquipmentFacts facts = facts_of(search.config, request, search.signals);
    facts.fresh_seed = rounds.fresh_seed();
    facts.runs = rounds.runs();
    facts.unsound = fresh.unsound;
    facts.end = plan.end;
    add_candidates(plan, search.signals, facts);
    add_outcomes(plan, search.signals, fresh, facts);
    add_pairs(plan, search.signals, fresh, facts);
    facts.roads = report::road_map(results::Store::open(rounds.fresh_folder()), facts.scenario);
    write_files(facts, request.run.folder);
    fmt::print("{}", request.run.publish.printing == Printing::json ? report::equipment_json(facts)
                                                                    : report::equipment_text(facts));
    fmt::print(stderr, "clearway: written: {}\n", (request.run.folder / "report.html").string());
    return rounds.failed_runs() == 0 ? core::ExitCode::ok : core::ExitCode::runs_failed;
}

core::ExitCode equip_dry_run(EquipRequest request) {
    const core::TemporaryFolder network_folder;
    const Search search = search_of(request, network_folder.path());
    const EquipForecast runs = search.rounds.forecast();
    const RunCost cost = cost_of(search, request);
    const unsigned processes =
        request.run.workers > 0 ? request.run.workers : std::max(1U, std::thread::hardware_concurrency());
    const auto seconds = [&](std::size_t count) -> core::Json {
        if (!cost.wall_s) return nullptr;
        return static_cast<double>(count) * *cost.wall_s / processes;
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
    add(fmt::format("place 1: on {} seeds, if none drops out", request.replications), runs.race, runs.race);
    add("later places", runs.later, runs.later_most);
    add("fresh seeds: estimate", runs.fresh, runs.fresh);
    const std::string size =
        fmt::format("{} likely, {} at most, into {}; runs that it holds are not made again.",
                    report::counted(runs.likely(), "run"), runs.most(), request.run.folder.string());
    const std::string vain =
        request.replications < analysis::fewest_for_interval
            ? fmt::format(" Nothing can be shown by fewer than {} seeds.", analysis::fewest_for_interval)
            : "";
    const std::string time =
        cost.wall_s ? fmt::format("About {} with {}, warm-ups left out ({}).", clock(runs.likely()),
                                  report::counted(processes, "worker"), words(cost.basis))
                    : "Time unknown: a run of this scenario beside that folder tells.";
    const std::string few = request.budget > candidates
                                ? fmt::format(" The budget is {}, and {} could gain.", request.budget,
                                              report::counted(candidates, "signal"))
                                : "";
    const std::string shorter =
        cost.wall_s ? short_plan(search.rounds, request, candidates, *cost.wall_s / processes) : "";
    const report::SignalsMet& met = search.signals.candidates.met;
    print({{{"folder", request.run.folder.string()},
            {"share_of_trips_with_signals", core::to_json_value(met.share())},
            {"signals_per_trip", core::to_json_value(met.mean())},
            {"candidates", candidates},
            {"runs", runs.likely()},
            {"most_runs", runs.most()},
            {"estimated_time_s", seconds(runs.likely())},
            {"estimate_measured", cost.basis == CostBasis::measured}},
           {table},
           core::wrapped(size + few + vain, 0) + "\n" + core::wrapped(time + shorter, 0) + "\n",
           core::wrapped(met.words(), 0) + "\n\n"},
          request.run.publish.printing);
    return core::ExitCode::ok;
}

}  // namespace clearway::campaign
