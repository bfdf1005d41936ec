#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/run_plan.hpp"
#include "cli/verb.hpp"
#include "core/number_range.hpp"

namespace clearway::cli {

Action configure_report(CLI::App& app) {
    struct Arguments {
        std::string folder;
        Printing printing = Printing::text;
        double least_relevant_s = report::usual_least_relevant_s;
    };
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("folder", arguments->folder, "Run folder of run, study or reproduce, complete or not")
        ->required()
        ->option_text("DIR (required)");
    app.add_option("--least-difference", arguments->least_relevant_s,
                   "Least difference of an EV's time that counts as an effect, s; 0: any")
        ->check(core::NumberRange{0.0, 1e6})
        ->option_text(fmt::format("SECONDS, 0 to 1e6 [{}]", arguments->least_relevant_s));
    add_json_option(app, arguments->printing, "the tables");
    return [arguments](const Invocation&) {
        return publish(results::Store::open(arguments->folder), arguments->printing,
                       arguments->least_relevant_s);
    };
}

}  // namespace clearway::cli
