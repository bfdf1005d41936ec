#include "campaign/mean_times.hpp"

#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"

namespace clearway::cli {

Action configure_mean_times(App& app) {
    struct MeanTimesArguments {
        std::string scenario;
        campaign::MeanTimesOrder order;
        scenario::Options options;
    };
    const auto arguments = std::make_shared<MeanTimesArguments>();
    campaign::MeanTimesOrder& order = arguments->order;
    add_scenario_argument(app, arguments->scenario);
    app.add_option("--out", order.file, "The CSV to write; never over a file")
        .required()
        .option_text("FILE (required)");
    app.add_option("--seeds", order.runs, "Runs to take the mean of")
        .range(1U, most_replications)
        .option_text(fmt::format("N, 1 to {} [{}]", most_replications, order.runs));
    add_seed_option(app, order.study_seed)
        .description("Study seed of these runs: another one than that of your studies");
    add_jobs_option(app, order.jobs);
    add_json_option(app, order.printing, "what was written");
    add_scenario_options(app, arguments->options);
    return [arguments](const Invocation&) {
        return campaign::write_mean_times(scenario::load(arguments->scenario, arguments->options),
                                          arguments->order);
    };
}

}  // namespace clearway::cli
