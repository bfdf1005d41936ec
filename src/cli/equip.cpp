#include "campaign/equip.hpp"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"

namespace clearway::cli {
namespace {

constexpr std::uint32_t usual_seeds = 10;  // FHWA's minimum number of replications
constexpr std::size_t most_signals = 10000;

struct Arguments {
    std::string scenario;
    ConditionWords conditions;
    scenario::Options options;
    campaign::EquipRequest request;
};

void add_study_options(CLI::App& app, const std::shared_ptr<Arguments>& arguments) {
    campaign::EquipRequest& request = arguments->request;
    app.add_option("--budget", request.budget, "How many signals to equip")
        ->required()
        ->check(CLI::Range(std::size_t{1}, most_signals))
        ->option_text(fmt::format("N, 1 to {} (required)", most_signals));
    add_condition_words(app, arguments->conditions);
    app.add_flag_callback(
        "--thorough", [&request] { request.search = analysis::Search::thorough; },
        "Try every signal for every place [those that could still be the best]");
    app.add_option("--seeds", request.replications, "Replications; all sets of signals share their demand")
        ->check(CLI::Range(2U, most_replications))
        ->option_text(fmt::format("N, 2 to {} [{}]", most_replications, request.replications));
    add_seed_option(app, request.seed);
    app.add_option("--out", request.run.folder,
                   "Folder of the result and of the runs; what was interrupted there is continued")
        ->option_text("DIR [runs/equip-SCENARIO-xxxxxx, a hash of what is run]");
    add_jobs_option(app, request.run.workers);
    add_limit_options(app, request.run.limits);
    add_json_option(app, request.run.publish.printing, "the result");
}

}  // namespace

Action configure_equip(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    arguments->request.replications = usual_seeds;
    add_scenario_argument(app, arguments->scenario);
    add_study_options(app, arguments);
    add_own_condition_options(app, arguments->conditions.own);
    add_scenario_options(app, arguments->options);
    return [arguments](const Invocation& invocation) {
        campaign::EquipRequest& request = arguments->request;
        request.condition = shown_condition(chosen_conditions(arguments->conditions), "equip");
        request.scenario = scenario::load(arguments->scenario, arguments->options);
        request.run.command = invocation.command;
        return campaign::equip(request);
    };
}

}  // namespace clearway::cli
