#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/run_plan.hpp"
#include "cli/verb.hpp"

namespace clearway::cli {

Action configure_report(CLI::App& app) {
    struct Arguments {
        std::string folder;
        Printing printing = Printing::text;
    };
    const auto arguments = std::make_shared<Arguments>();
    app.add_option("folder", arguments->folder, "Run folder of run, study or reproduce, complete or not")
        ->required()
        ->option_text("DIR (required)");
    add_json_option(app, arguments->printing, "the tables");
    return [arguments](const Invocation&) {
        return publish(results::Store::open(arguments->folder), arguments->printing);
    };
}

}  // namespace clearway::cli
