#include <memory>
#include <string>

#include <fmt/format.h>

#include "campaign/equip.hpp"
#include "campaign/study_run.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/trust_option.hpp"
#include "cli/verb.hpp"

namespace clearway::cli {

Action configure_report(App& app) {
    struct ReportArguments {
        std::string folder;
        campaign::PublishOptions how;
    };
    const auto arguments = std::make_shared<ReportArguments>();
    app.add_option("folder", arguments->folder, "Folder of run, study or equip, complete or not")
        .required()
        .option_text("DIR (required)");
    app.add_option("--least-difference", arguments->how.least_relevant_s,
                   "Smallest difference of an EV's time that counts as an effect, s; 0: any")
        .range(0.0, 1e6)
        .option_text(fmt::format("SECONDS, 0 to 1e6 [{}]", arguments->how.least_relevant_s));
    add_response_option(app, arguments->how.response_threshold_s);
    add_shown_condition_option(app, arguments->how.condition);
    app.add_flag_callback(
        "--replays", [arguments] { arguments->how.replays.make = campaign::MakeReplays::yes; },
        "Show the median, best and worst trip of each scenario in the report: makes up to six runs of each "
        "again to record them, those with code in Python only with --trust-code. Later reports keep them "
        "[off]");
    add_trust_option(app, arguments->how.replays.trust);
    add_json_option(app, arguments->how.printing, "the tables");
    add_tables_option(app, arguments->how.tables);
    return [arguments](const Invocation&) {
        if (campaign::is_equip_folder(arguments->folder)) {
            campaign::print_equip_folder(arguments->folder, arguments->how.printing);
            return core::ExitCode::ok;
        }
        campaign::refuse_round(arguments->folder);
        const results::Store store = results::Store::open(arguments->folder);
        return campaign::publish(store, arguments->how);
    };
}

}  // namespace clearway::cli
