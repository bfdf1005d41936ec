#include <charconv>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/common_options.hpp"
#include "cli/condition_options.hpp"
#include "cli/names.hpp"
#include "cli/run_plan.hpp"
#include "cli/verb.hpp"
#include "cli/worker_orders.hpp"
#include "experiment/attach_order.hpp"
#include "results/store.hpp"

namespace clearway::cli {
namespace {

struct Arguments {
    std::string place;
    std::string folder;
    experiment::AttachOrder order;
    Printing printing = Printing::text;
    report::Tables tables = report::Tables::essential;
};

/// Sets host and port of `HOST:PORT`, `:PORT` or `PORT`.
void read_place(const std::string& place, experiment::AttachOrder& order) {
    const std::size_t colon = place.rfind(':');
    order.host = colon == std::string::npos ? "" : place.substr(0, colon);
    if (order.host.empty()) order.host = "localhost";
    const std::string digits = colon == std::string::npos ? place : place.substr(colon + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), order.port);
    constexpr int last_port = 65535;
    if (error != std::errc() || end != digits.data() + digits.size() || order.port < 1 ||
        order.port > last_port)
        throw core::InputError({"HOST:PORT", fmt::format("`{}` is no place of a SUMO", place),
                                "a host and a port from 1 to 65535, localhost:8813",
                                "Give the port that SUMO was started with, --remote-port"});
}

core::ExitCode attach(const Arguments& arguments) {
    experiment::AttachOrder order = arguments.order;
    read_place(arguments.place, order);
    const std::filesystem::path folder =
        arguments.folder.empty() ? fmt::format("runs/attached-{}", order.port) : arguments.folder;
    if (std::filesystem::exists(folder))
        throw core::InputError(
            {folder.string(), "exists already", "a new folder",
             "Give another with --out, or remove it; a simulation elsewhere cannot be resumed"});
    order.output = std::filesystem::absolute(folder);
    if (!order.network.empty()) order.network = std::filesystem::absolute(order.network);
    check_names({order.condition});
    const std::filesystem::path orders = order.output.string() + ".order";
    const WorkerResult result = work_on({{.label = fmt::format("SUMO at {}:{}", order.host, order.port),
                                          .option = "--attach",
                                          .file = orders / "attach.json",
                                          .text = experiment::to_json(order),
                                          .log = orders / "attach.log",
                                          .work = order.output}},
                                        1, "simulations");
    if (result.exit_code != core::ExitCode::ok) return result.exit_code;
    std::filesystem::remove_all(orders);
    return publish(results::Store::open(order.output), {arguments.printing, arguments.tables});
}

}  // namespace

Action configure_attach(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    arguments->order.condition.name = "attached";
    experiment::AttachOrder& order = arguments->order;
    app.add_option("place", arguments->place, "Where SUMO waits for orders (its --remote-port)")
        ->required()
        ->option_text("HOST:PORT (required)");
    add_condition_options(app, order.condition, "What is done (names: clearway list)");
    app.add_option("--automated", order.automated,
                   "Vehicle types that are automated, beside those that say so (clearway.class)")
        ->option_text("TYPE ... [none]");
    app.add_option("--emergency", order.emergency,
                   "Vehicle types that are emergency vehicles, beside those of vClass emergency")
        ->option_text("TYPE ... [none]");
    app.add_option("--network", order.network, "Its network file, where SUMO's own path does not lead to it")
        ->option_text("FILE [as SUMO says]");
    add_seed_option(app, order.study_seed);
    app.add_option("--out", arguments->folder, "Run folder")->option_text("DIR [runs/attached-PORT]");
    add_json_option(app, arguments->printing, "the tables");
    add_tables_option(app, arguments->tables);
    return [arguments](const Invocation&) { return attach(*arguments); };
}

}  // namespace clearway::cli
