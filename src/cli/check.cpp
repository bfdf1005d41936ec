#include <memory>
#include <string>

#include "campaign/fitness.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"

namespace clearway::cli {

Action configure_check(App& app) {
    struct CheckArguments {
        std::string scenario;
        std::uint64_t seed = 1;
        std::uint32_t lock_trials = 0;
        campaign::RunOptions run;
        scenario::Options options;
    };
    const auto arguments = std::make_shared<CheckArguments>();
    add_scenario_argument(app, arguments->scenario);
    add_seed_option(app, arguments->seed);
    app.add_option(
           "--lock-trials", arguments->lock_trials,
           "Also look for locks: makes N more runs with time.ignore_junction_blocker_s, and N without")
        .range(0U, 1000U)
        .option_text("N, 0 to 1000 [0]");
    add_limit_options(app, arguments->run.limits);
    add_json_option(app, arguments->run.publish.printing, "the findings");
    add_scenario_options(app, arguments->options);
    return [arguments](const Invocation& invocation) {
        arguments->run.command = invocation.command;
        return campaign::check_scenario(scenario::load(arguments->scenario, arguments->options),
                                        arguments->seed, arguments->lock_trials, arguments->run);
    };
}

}  // namespace clearway::cli
