#include "campaign/detail/equip_search.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "campaign/names.hpp"
#include "core/error.hpp"
#include "core/own_output.hpp"
#include "core/process.hpp"
#include "experiment/conditions.hpp"
#include "experiment/equipped_signals.hpp"
#include "experiment/related_conditions.hpp"
#include "experiment/settings.hpp"
#include "policy/policy.hpp"
#include "python/part_name.hpp"
#include "scenario/signal_sheet.hpp"

namespace clearway::campaign::detail {
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

Signals signals_of(const study::StudyConfig& config, const EquipRequest& request,
                   const scenario::BuiltNetwork& built) {
    Signals signals{built, {}, {}, {}};
    if (built.network.signals().empty())
        throw core::InputError({"scenario " + request.scenario.name, "has no signals",
                                "a network with signals",
                                "`clearway scenario signals SCENARIO` lists those of a scenario"});
    signals.today = experiment::equipped_signals(request.condition, signals.built.network);
    if (signals.ids_of_today().size() == signals.built.network.signals().size()) refuse_all_equipped();
    signals.candidates = equip_candidates(config, signals.built, signals.today, request.most_candidates);
    for (const scenario::SignalSheet& sheet : scenario::signal_sheets(signals.built.network, {}))
        signals.all_streets.push_back(scenario::streets_of(sheet));
    return signals;
}

EquipQuestion question_of(const study::StudyConfig& config, const EquipRequest& request,
                          const Signals& signals) {
    EquipQuestion question{.config = config,
                           .base = request.condition,
                           .signals = {},
                           .numbers = {},
                           .today = signals.ids_of_today(),
                           .passed = signals.candidates.passed,
                           .pairs = signals.candidates.neighbours,
                           .budget = request.budget,
                           .search = request.search,
                           .calmer = core::shell_text(request.calmer)};
    question.base.settings.erase(experiment::equipped_setting);  // with all equipped
    analysis::SignalSet all;
    for (std::size_t candidate = 0; candidate < signals.candidates.signals.size(); ++candidate) {
        all.push_back(candidate);
        question.signals.push_back(signals.id(candidate));
        question.numbers.push_back(signals.number(candidate));
    }
    // A user's code may ask signals that no emergency vehicle passes.
    if (has_own_code(request.condition)) question.passed.assign(config.replications, all);
    return question;
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

}  // namespace

scenario::BuiltNetwork roads_of(const EquipRequest& request, const std::filesystem::path& folder) {
    check_condition(request.condition);
    return scenario::build_network(request.scenario, folder);
}

Search search_of(EquipRequest& request, const scenario::BuiltNetwork& built) {
    study::StudyConfig config = study_of(request.scenario, {}, request.seed, request.replications);
    config.name = "equip-" + config.name;
    Signals signals = signals_of(config, request, built);
    if (request.run.folder.empty()) request.run.folder = usual_folder(config, request.condition);
    check_folder(request.run.folder);
    EquipQuestion question = question_of(config, request, signals);
    return {std::move(config), std::move(signals), EquipRounds(std::move(question), request.run)};
}

}  // namespace clearway::campaign::detail
