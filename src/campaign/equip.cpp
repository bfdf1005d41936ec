#include "campaign/equip.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "campaign/detail/equip_forecast.hpp"
#include "campaign/detail/equip_look.hpp"
#include "campaign/detail/equip_search.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/interruption.hpp"
#include "core/leftovers.hpp"
#include "core/temporary_folder.hpp"
#include "core/terminal.hpp"
#include "experiment/related_conditions.hpp"
#include "experiment/settings.hpp"
#include "report/configuration.hpp"
#include "report/equipment.hpp"

namespace clearway::campaign {

using detail::chosen_words;
using detail::interim_words;
using detail::less_time;
using detail::Look;
using detail::Search;
using detail::search_of;
using detail::Signals;

namespace {

analysis::MaybeEstimate mean(const EquipOutcome& outcome) {
    return analysis::estimate_values(outcome.emergency_s, analysis::MetricKind::quantity);
}

void add_candidates(const analysis::EquipPlan& plan, const Signals& signals, report::EquipmentFacts& facts) {
    for (std::size_t candidate = 0; candidate < plan.candidates.size(); ++candidate) {
        const analysis::EquipCandidate& found = plan.candidates[candidate];
        facts.candidates.push_back({signals.number(candidate), signals.id(candidate),
                                    signals.streets(candidate), signals.candidates.trips[candidate],
                                    found.gain, found.left_race, std::nullopt, found.later});
    }
    for (std::size_t rank = 0; rank < plan.steps.size(); ++rank)
        facts.candidates.at(plan.steps[rank].candidate).rank = rank + 1;
}

void add_outcomes(const analysis::EquipPlan& plan, const Signals& signals, const FreshOutcomes& fresh,
                  report::EquipmentFacts& facts) {
    const auto gain = [&](const EquipOutcome& after) {
        return less_time(fresh.none.emergency_s, after.emergency_s);
    };
    const auto loss = [&](const EquipOutcome& after) {
        return less_time(after.others_s, fresh.none.others_s);
    };
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
        facts.ranked.push_back({signals.number(step.candidate), signals.id(step.candidate),
                                signals.streets(step.candidate),
                                less_time(before.emergency_s, after.emergency_s, together), gain(after),
                                loss(after), step.gain});
    }
}

/// What all that were chosen do over none besides the means of times.
void add_sums(const Search& search, const analysis::EquipPlan& plan, const FreshOutcomes& fresh,
              report::EquipmentFacts& facts) {
    if (plan.steps.empty()) return;
    std::vector<core::SignalIndex> chosen;
    for (const analysis::EquipStep& step : plan.steps)
        chosen.push_back(search.signals.candidates.signals.at(step.candidate));
    study::StudyConfig config = search.config;
    config.seed = search.rounds.fresh_seed();
    facts.split = analysis::split_gain(fresh.none.trips_s, fresh.chosen.back().trips_s,
                                       trips_past(chosen, config, search.signals.built));
    for (std::size_t event = 0; event < equip_events.size(); ++event) {
        const analysis::Values& none = fresh.none.events.at(event);
        const analysis::Values& with = fresh.chosen.back().events.at(event);
        constexpr auto count = analysis::MetricKind::count;
        facts.events.push_back({equip_events.at(event).title, analysis::estimate_values(none, count),
                                analysis::estimate_values(with, count),
                                analysis::estimate_paired(with, none, count)});
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
        pair.both_gain = less_time((rank == 0 ? fresh.none : fresh.chosen.at(rank - 1)).emergency_s,
                                   fresh.chosen.at(rank + 1).emergency_s);
    }
}

report::EquipmentFacts facts_of(const study::StudyConfig& config, const EquipRequest& request,
                                const Signals& signals) {
    report::EquipmentFacts facts;
    facts.scenario = config.scenarios.front().name;
    facts.title = config.scenarios.front().title;
    facts.attribution = config.scenarios.front().network.attribution;
    facts.assumptions =
        report::simulated_sentence(scenario::to_toml(config.scenarios.front()), signals.built.network,
                                   experiment::baseline_for(request.condition));
    facts.condition = request.condition.name;
    facts.command = request.run.command;
    facts.study = request.study;
    facts.more_seeds = request.more_seeds;
    facts.density = request.density;
    facts.other_parts = experiment::policies_with(request.condition, traffic::Trait::renews_requests);
    facts.seed = config.seed;
    facts.replications = config.replications;
    facts.step_length_s = config.scenarios.front().time.step_length_s;
    facts.budget = request.budget;
    facts.signals = signals.built.network.signals().size();
    facts.met = signals.candidates.met;
    facts.outlook = scenario::outlook_sentence(signals.candidates.outlook);
    facts.red_s = signals.candidates.outlook.red_s;
    facts.not_passed = signals.candidates.not_passed;
    facts.switched_off = signals.candidates.switched_off;
    facts.equipped_today = signals.ids_of_today();
    facts.equipped_and_passed = signals.candidates.equipped;
    facts.less_red = signals.candidates.less_red;
    return facts;
}

constexpr const char* text_name = "equip.txt";
constexpr const char* json_name = "equip.json";

void write_files(const report::EquipmentFacts& facts, const std::filesystem::path& folder) {
    std::ostringstream page;
    report::write_equipment_page(facts, page);
    core::write_output(folder / "report.html", page.str());
    core::write_output(folder / "equip.csv", report::equipment_csv(facts));
    core::write_output(folder / "candidates.csv", report::candidates_csv(facts));
    core::write_output(folder / "pairs.csv", report::pairs_csv(facts));
    core::write_output(folder / json_name, report::equipment_json(facts));
    core::write_output(folder / text_name, report::equipment_text(facts));
    core::write_output(folder / "curve.svg", report::equipment_curve(facts));
    core::write_output(folder / "map.svg", report::equipment_map(facts));
}

/// The plan, as EquipRounds finds it; `look` has what the race knows, also when it is interrupted.
analysis::EquipPlan raced(const EquipRequest& request, Search& search, Look& look) {
    const analysis::EquipConfig config{.candidates = search.signals.candidates.signals.size(),
                                       .budget = request.budget,
                                       .replications = request.replications,
                                       .search = request.search,
                                       .pairs = search.signals.candidates.neighbours};
    const EquipForecast forecast = search.rounds.forecast();
    const auto started = std::chrono::steady_clock::now();
    return analysis::equip_greedily(
        config, [&](const std::vector<analysis::SignalSet>& sets, std::size_t replications) {
            std::vector<analysis::Values> values = search.rounds.measure(sets, replications);
            const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - started;
            if (look.sets.empty())
                core::print_message(late_warning(forecast, spent.count(), request.within_s));
            look = {sets.front().empty() ? values.front() : look.none, sets, values, replications};
            return values;
        });
}

/// Keeps what was known when a search was interrupted, but not over a complete answer, whose files agree.
/// What cannot be written does not hide that it was interrupted.
void keep_interim(const std::string& words, const std::filesystem::path& folder) {
    if (std::filesystem::exists(folder / json_name)) return;
    try {
        core::write_output(folder / text_name, words);
    } catch (const core::Error& error) {
        core::print_message(fmt::format("clearway: {}\n", error.what()));
    }
}

/// What was chosen and what fresh runs make of it. Where they are interrupted, what was known is said first.
std::pair<analysis::EquipPlan, FreshOutcomes> measured(const EquipRequest& request, Search& search) {
    Look look;
    std::optional<analysis::EquipPlan> plan;
    try {
        plan = raced(request, search, look);
        analysis::SignalSet chosen;
        for (const analysis::EquipStep& step : plan->steps)
            chosen.push_back(step.candidate);
        FreshOutcomes fresh = search.rounds.estimate(chosen);
        return {*std::move(plan), std::move(fresh)};
    } catch (const core::Error& error) {
        if (is_interrupted(error.exit_code())) {
            const std::string words =
                plan ? chosen_words(*plan, search.signals) : interim_words(look, search.signals);
            core::print_message(words);
            if (plan || look.is_complete()) keep_interim(words, request.run.folder);
        }
        throw;
    }
}

}  // namespace

core::ExitCode equip(EquipRequest request) {
    std::optional<core::InterruptionNotice> notice(std::in_place,
                                                   interrupted_between_runs(request.run.command));
    const core::TemporaryFolder network_folder;
    const scenario::BuiltNetwork built = detail::roads_of(request, network_folder.path());
    request = detail::fitted(std::move(request), built);
    notice.emplace(interrupted_between_runs(request.run.command));
    Search search = search_of(request, built);
    core::print_message(search.rounds.same_with_other_seeds());
    EquipRounds& rounds = search.rounds;
    const auto [plan, fresh] = measured(request, search);
    report::EquipmentFacts facts = facts_of(search.config, request, search.signals);
    facts.fresh_seed = rounds.fresh_seed();
    facts.study.insert(facts.study.end(), {"--seed", std::to_string(facts.fresh_seed + 1)});
    facts.runs = rounds.runs();
    facts.unsound = fresh.unsound;
    facts.end = plan.end;
    add_candidates(plan, search.signals, facts);
    add_outcomes(plan, search.signals, fresh, facts);
    add_pairs(plan, search.signals, fresh, facts);
    add_sums(search, plan, fresh, facts);
    facts.roads = report::road_map(results::Store::open(rounds.fresh_folder()), facts.scenario);
    write_files(facts, request.run.folder);
    fmt::print("{}", request.run.publish.printing == Printing::json ? report::equipment_json(facts)
                                                                    : report::equipment_text(facts));
    fmt::print(stderr, "clearway: written: {}\n", (request.run.folder / "report.html").string());
    return rounds.failed_runs() == 0 ? core::ExitCode::ok : core::ExitCode::runs_failed;
}

bool is_equip_folder(const std::filesystem::path& folder) {
    return std::filesystem::exists(folder / text_name) ||
           std::filesystem::exists(folder / EquipRounds::first_round / "manifest.json");
}

void refuse_round(const std::filesystem::path& folder) {
    const auto whole = std::filesystem::absolute(folder / "").lexically_normal().parent_path();
    const std::filesystem::path search = whole.parent_path();
    if (!whole.filename().string().starts_with("round-") || !is_equip_folder(search)) return;
    const std::string answer = search.lexically_proximate(std::filesystem::current_path()).string();
    throw core::InputError({folder.string(),
                            "is a round of a search, which drops candidates early: its runs are no study", "",
                            "The answer: clearway report " + core::shell_text({answer})});
}

void require_equip_file(const std::filesystem::path& folder, const char* name) {
    if (!std::filesystem::exists(folder / name))
        throw core::InputError({folder.string(), "is of a search by clearway equip that has no answer yet",
                                "", "The same `clearway equip` command continues it"});
}

void print_equip_folder(const std::filesystem::path& folder, Printing printing) {
    const char* const name = printing == Printing::json ? json_name : text_name;
    require_equip_file(folder, name);
    fmt::print("{}", core::read_file(folder / name));
}

}  // namespace clearway::campaign
