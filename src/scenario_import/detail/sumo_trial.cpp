#include "scenario_import/detail/sumo_trial.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/own_words.hpp"
#include "scenario_import/detail/tool.hpp"

namespace clearway::scenario_import::detail {

namespace {

/// SUMO's defaults.
constexpr double usual_time_to_teleport_s = 300.0;
constexpr double never_s = -1.0;

std::string joined(const std::vector<std::filesystem::path>& files) {
    std::vector<std::string> names;
    for (const std::filesystem::path& file : files)
        names.push_back(file.string());
    return fmt::format("{}", fmt::join(names, ","));
}

/// Time after the last departure for which a trial runs.
constexpr double grace_s = 600.0;

/// Mean time loss of the vehicles that arrive, in words. Notes when SUMO fails.
std::string mean_time_loss(Import& import, const scenario::Prepared& demand, double step_s) {
    const std::filesystem::path statistics = import.work / "statistics.xml";
    std::filesystem::remove(statistics);
    std::vector<std::string> arguments = sumo_arguments(demand);
    for (const std::string& word :
         {std::string("--step-length"), fmt::format("{:g}", step_s), std::string("--end"),
          fmt::format("{}", demand.time.window_s + grace_s), std::string("--time-to-teleport"),
          fmt::format("{:g}", demand.time.time_to_teleport_s.value_or(usual_time_to_teleport_s)),
          std::string("--ignore-junction-blocker"),
          fmt::format("{:g}", demand.time.ignore_junction_blocker_s.value_or(never_s)),
          std::string("--statistic-output"), statistics.string(), std::string("--duration-log.statistics"),
          std::string("--no-warnings")})
        arguments.push_back(word);
    const Tool tool{"sumo", std::move(arguments), import.work / "steps.log",
                    fmt::format("running it at steps of {:g} s", step_s), "sumo"};
    if (!succeeds(tool, import.on_progress)) {
        import.findings.trial_failure = complaint(tool.log);
        return "not known, because SUMO fails";
    }
    std::optional<double> loss_s;
    for_each_element(statistics, [&](Element&& element) {
        if (element.name == "vehicleTripStatistics" && number(element.text("count")).value_or(0.0) > 0.0)
            loss_s = number(element.text("timeLoss"));
    });
    return loss_s ? fmt::format("{:.1f} s", *loss_s)
                  : fmt::format("not known, because nobody arrives within {:g} s of the last departure",
                                grace_s);
}

/// No other mistake is cured by shorter trips.
bool wants_shorter_trips(const core::InputError& error) {
    return std::ranges::any_of(error.problems(), [](const core::Problem& problem) {
        return problem.where.ends_with("minimum_length_m");
    });
}

}  // namespace

std::vector<std::string> sumo_arguments(const scenario::Prepared& prepared) {
    std::vector<std::string> arguments = {"--net-file",
                                          prepared.network_file.string(),
                                          "--route-files",
                                          joined(prepared.route_files),
                                          "--additional-files",
                                          joined(prepared.additional_files),
                                          "--xml-validation",
                                          "never",
                                          "--xml-validation.net",
                                          "never",
                                          "--xml-validation.routes",
                                          "never",
                                          "--no-step-log",
                                          "--duration-log.disable",
                                          "--route-steps",
                                          "0",
                                          "--collision.action",
                                          "warn"};
    for (const std::string& option : prepared.options)
        arguments.push_back("--" + option);
    return arguments;
}

Tried make_demand(Import& import, scenario::ScenarioConfig& config) {
    double& least_m = config.measured ? config.measured->emergency_minimum_length_m
                                      : config.trips.emergency_minimum_length_m;
    scenario::BuiltNetwork network = scenario::build_network(config, import.work / "network");
    std::optional<scenario::Prepared> prepared;
    constexpr int most_tries = 6;
    for (int row = 0; !prepared; ++row) {
        try {
            prepared = scenario::prepare(config, network, core::StudySeed{1}, core::Replication{0},
                                         import.work / "demand");
        } catch (const core::InputError& error) {
            if (row == most_tries || !wants_shorter_trips(error)) throw;
            least_m = std::floor(least_m / 2.0);
            config.trips.minimum_length_m = std::min(config.trips.minimum_length_m, least_m);
        }
    }
    return {std::move(network), *std::move(prepared)};
}

void require_load(const Import& import, const scenario::Prepared& demand) {
    std::vector<std::string> arguments = sumo_arguments(demand);
    arguments.insert(arguments.end(), {"--end", "1"});
    const Tool tool{"sumo", std::move(arguments), import.work / "sumo.log", "loading it in SUMO", "sumo"};
    if (succeeds(tool, import.on_progress)) return;
    const std::string says = in_own_words(complaint(tool.log), import);
    throw core::InputError(
        core::Problem{place_of_complaint(says, import).value_or(joined(import.request.files)),
                      fmt::format("SUMO does not load the imported scenario:\n{}", says),
                      "files that SUMO 1.15 loads", "correct what it names"});
}

void compare_steps(Import& import, const scenario::Prepared& demand, double own_step_s) {
    const double here_s = demand.time.step_length_s;
    if (own_step_s == here_s) return;
    const std::string own = mean_time_loss(import, demand, own_step_s);
    const std::string here = mean_time_loss(import, demand, here_s);
    import.findings.changes.push_back(fmt::format(
        "steps of {:g} s instead of {:g} s; mean time loss of a vehicle that arrives, one run each: {} at "
        "{:g} s, {} at {:g} s{}",
        here_s, own_step_s, own, own_step_s, here, here_s,
        own_step_s <= 1.0
            ? fmt::format("; --step-length {:g} of every verb gives figures to compare with your own",
                          own_step_s)
            : ""));
}

}  // namespace clearway::scenario_import::detail
