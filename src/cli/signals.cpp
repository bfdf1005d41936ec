#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "campaign/printout.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "core/counted.hpp"
#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/own_output.hpp"
#include "core/temporary_folder.hpp"
#include "core/terminal.hpp"
#include "report/text.hpp"
#include "scenario/network.hpp"
#include "scenario/picture.hpp"
#include "scenario/preemption.hpp"
#include "scenario/signal_sheet.hpp"

namespace clearway::cli {
namespace {

using core::Json;
using scenario::SecondsRange;
using scenario::SignalSheet;

struct SignalsArguments {
    std::string scenario;
    std::filesystem::path picture;
    std::filesystem::path parameters;
    Printing printing = Printing::text;
    scenario::Options options;
};

/// `4`, `3 to 5`, or `-` where the program shows none.
std::string text_of(const std::optional<SecondsRange>& times) {
    if (!times) return "-";
    if (times->shortest_s == times->longest_s) return fmt::format("{:g}", times->shortest_s);
    return fmt::format("{:g} to {:g}", times->shortest_s, times->longest_s);
}

/// `dwell_s=8, priority=1`, or `-`.
std::string text_of(const traffic::Preemption& set) {
    std::vector<std::string> parts;
    core::for_each_field<traffic::Preemption>([&](const auto& field) {
        const auto& value = set.*field.member;
        if (value) parts.push_back(fmt::format("{}={}", field.name, core::csv_cell(value)));
    });
    return parts.empty() ? "-" : core::listed(parts);
}

std::string approach_text(const SignalSheet& sheet, const scenario::SignalPhase& phase) {
    std::vector<std::string> names;
    const std::vector<std::string>& edges = phase.edges;
    for (const scenario::SignalApproach& approach : sheet.approaches) {
        if (!core::contains(edges, approach.edge)) continue;
        names.push_back(approach.street.empty() ? approach.edge
                                                : fmt::format("{} ({})", approach.edge, approach.street));
    }
    if (phase.on_foot) names.emplace_back("people on foot");
    if (names.empty()) names.emplace_back("no road of this network");
    return report::printable(core::listed(names));
}

Json range_json(const std::optional<SecondsRange>& times) {
    if (!times) return nullptr;
    return Json{{"shortest", times->shortest_s}, {"longest", times->longest_s}};
}

Json set_json(const traffic::Preemption& set) {
    Json json = Json::object();
    core::for_each_field<traffic::Preemption>([&](const auto& field) {
        const auto& value = set.*field.member;
        json[field.name] = value ? Json(*value) : Json(nullptr);
    });
    return json;
}

Json approaches_json(const SignalSheet& sheet) {
    Json approaches = Json::array();
    for (const scenario::SignalApproach& approach : sheet.approaches)
        approaches.push_back(
            {{"edge", approach.edge}, {"street", approach.street}, {"links", approach.links}});
    return approaches;
}

Json phases_json(const SignalSheet& sheet) {
    Json phases = Json::array();
    for (const scenario::SignalPhase& phase : sheet.phases)
        phases.push_back({{"phase", phase.number},
                          {"name", phase.name},
                          {"state", phase.state},
                          {"duration_s", phase.duration_s},
                          {"minimum_s", phase.least_s > 0.0 ? Json(phase.least_s) : Json(nullptr)},
                          {"green", phase.green},
                          {"on_foot", phase.on_foot},
                          {"approaches", phase.edges}});
    return phases;
}

/// The streets in full, the green phases and what is set, in words.
std::vector<std::string> lines_of(const SignalSheet& sheet) {
    std::vector<std::string> lines;
    if (const std::string streets = scenario::streets_of(sheet); !streets.empty())
        lines.push_back(report::printable(fmt::format("{}; id {}", streets, sheet.signal)));
    for (const scenario::SignalPhase& phase : sheet.phases)
        if (phase.green)
            lines.push_back(fmt::format("phase {}  {:>5g} s  {}", phase.number, phase.duration_s,
                                        approach_text(sheet, phase)));
    traffic::Preemption changed = sheet.set;
    if (changed.enabled == 1) changed.enabled.reset();  // As signals are where no file says anything.
    const std::string set = text_of(changed);
    if (set != "-") lines.push_back("set  " + set);
    return lines;
}

campaign::Table table_of(const std::vector<SignalSheet>& sheets) {
    campaign::Table table{"signals",
                          {{"number", "No."},
                           {"signal", ""},
                           {"", "Signal"},
                           {"x_m", ""},
                           {"y_m", ""},
                           {"controller", "Controller"},
                           {"program", ""},
                           {"fixed_time", ""},
                           {"cycle_s", "Cycle"},
                           {"offset_s", ""},
                           {"yellow_s", ""},
                           {"red_clearance_s", ""},
                           {"minimum_green_s", ""},
                           {"", "Yellow"},
                           {"", "Red"},
                           {"", "Green"},
                           {"crossings", "Crossings"},
                           {"approaches", ""},
                           {"phases", ""},
                           {"set", ""}},
                          {}};
    for (const SignalSheet& sheet : sheets)
        table.rows.push_back(
            {{table.rows.size() + 1,
              sheet.signal,
              report::short_signal_name(report::signal_words(sheet.signal, scenario::streets_of(sheet))),
              sheet.place.x_m,
              sheet.place.y_m,
              sheet.controller,
              sheet.program,
              sheet.coordinated,
              sheet.cycle_s,
              sheet.offset_s,
              range_json(sheet.yellow),
              range_json(sheet.red_clearance),
              range_json(sheet.least_green),
              text_of(sheet.yellow),
              text_of(sheet.red_clearance),
              text_of(sheet.least_green),
              sheet.crossings,
              approaches_json(sheet),
              phases_json(sheet),
              set_json(sheet.set)},
             lines_of(sheet)});
    return table;
}

campaign::Printout printout_of(const std::string& name, const std::vector<SignalSheet>& sheets) {
    const std::string text =
        sheets.empty()
            ? "The network has no signals.\n"
            : "\n" +
                  core::wrapped(
                      fmt::format(
                          "{}. Cycle, yellow, red clearance and least green, s, as their programs show "
                          "them; -: none, so that a hold takes them from a formula (actuation.clearance) or "
                          "setting.",
                          core::counted(sheets.size(), "signal")),
                      0) +
                  "\n";
    return {{{"scenario", name}}, {table_of(sheets)}, text};
}

/// What is set in the scenario's file; for signals without a row what the network tells.
std::vector<traffic::Preemption> to_edit(const scenario::BuiltNetwork& built) {
    std::vector<traffic::Preemption> signals = scenario::preemption_in(built.network);
    for (std::size_t row = 0; row < built.preemption.size(); ++row) {
        if (built.preemption[row] != traffic::Preemption{}) signals[row] = built.preemption[row];
    }
    return signals;
}

void refuse_to_overwrite(const std::filesystem::path& file) {
    if (file.empty() || !std::filesystem::exists(file)) return;
    throw core::InputError(core::Problem{fmt::format("--out {}", file.string()), "exists already",
                                         "a file that does not exist",
                                         "choose another name, or remove it first"});
}

core::ExitCode show(const SignalsArguments& arguments) {
    refuse_to_overwrite(arguments.parameters);
    const scenario::ScenarioConfig config = scenario::load(arguments.scenario, arguments.options);
    const core::TemporaryFolder folder;
    const scenario::BuiltNetwork built = scenario::build_network(config, folder.path());
    const std::vector<SignalSheet> sheets = scenario::signal_sheets(built.network, built.preemption);
    if (!arguments.picture.empty())
        core::write_own(arguments.picture,
                        scenario::signals_picture(built.network, config.title, config.network.attribution),
                        {"a picture of clearway scenario signals", scenario::picture_mark});
    if (!arguments.parameters.empty())
        core::write_new(arguments.parameters, scenario::preemption_csv(built.network, to_edit(built)));
    campaign::print(printout_of(config.name, sheets), arguments.printing);
    if (!arguments.picture.empty())
        fmt::print(stderr, "clearway: map of the signals in {}\n", arguments.picture.string());
    if (!arguments.parameters.empty() && sheets.empty())
        fmt::print(stderr, "clearway: {} has no signals; {} holds the names of the columns and no row\n",
                   config.name, arguments.parameters.string());
    else if (!arguments.parameters.empty())
        fmt::print(stderr,
                   "clearway: preemption parameters in {}; name it in scenario.toml: [network] preemption = "
                   "\"FILE\"\n",
                   arguments.parameters.string());
    return core::ExitCode::ok;
}

}  // namespace

Action configure_signals(App& app) {
    const auto arguments = std::make_shared<SignalsArguments>();
    add_scenario_argument(app, arguments->scenario);
    app.add_option("--svg", arguments->picture, "Write a map of the signals with their numbers")
        .option_text("FILE [none]");
    app.add_option("--out", arguments->parameters,
                   "Write the CSV of preemption parameters to edit; never over a file")
        .option_text("FILE [none]");
    add_json_option(app, arguments->printing, "the signals");
    add_scenario_options(app, arguments->options);
    return [arguments](const Invocation&) { return show(*arguments); };
}

}  // namespace clearway::cli
