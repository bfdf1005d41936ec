#include <memory>

#include <fmt/format.h>

#include "campaign/run_name.hpp"
#include "campaign/verification.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/trust_option.hpp"
#include "cli/verb.hpp"

namespace clearway::cli {

Action configure_verify(App& app) {
    const auto arguments = std::make_shared<campaign::VerifyRequest>();
    app.add_option("run", arguments->what,
                   fmt::format("Run to repeat: {}; with --all, --sample or --signals a folder",
                               campaign::run_name_form))
        .required()
        .option_text("RUN|DIR (required)");
    const Option all = app.add_flag("--all", arguments->all, "Every complete run of the folder [off]");
    app.add_option("--sample", arguments->sample,
                   "Number of complete runs, evenly spread over the sorted list")
        .range(std::size_t{1}, std::size_t{1000000000})
        .option_text("N, 1 or more [off]")
        .excludes(all);
    const Option out = app.add_option("--out", arguments->out, "New run folder that keeps the repeated runs")
                           .option_text("DIR [a temporary one, removed at the end]");
    app.add_flag("--signals", arguments->signals,
                 "Audit signals instead: no yellow, red clearance or green below the "
                 "signal's own program in any event log [off]")
        .excludes(out);
    add_trust_option(app, arguments->trust);
    add_jobs_option(app, arguments->workers);
    add_json_option(app, arguments->printing, "the verdicts");
    app.footer(
        app.get_footer() +
        "\n  clearway verify runs/city --sample 20\n\n"
        "The runs are repeated elsewhere, from the configurations and networks in the folder, and all that\n"
        "their records hold is compared. Exit codes: 0 all the same, 7 one differs (two results for one\n"
        "run), 3 a stored record is damaged or a scenario or network was changed, 1 a run fails now, 5 the\n"
        "run is not complete in the folder, 4 SUMO or Clearway is of another version than the study's:\n"
        "such runs need not agree.\n\n"
        "With --signals nothing is repeated; exit code 1 tells findings, and 5 also that there was nothing\n"
        "to audit.");
    return [arguments](const Invocation&) { return campaign::verify_runs(*arguments); };
}

}  // namespace clearway::cli
