#include "cli/condition_options.hpp"

#include <map>

#include <CLI/CLI.hpp>

namespace clearway::cli {

void add_condition_options(CLI::App& app, results::ConditionSpec& condition, const std::string& group) {
    app.add_option("--policy", condition.parts,
                   "Policy parts, in this order; none: the car-following model alone")
        ->option_text("PART ... [none]")
        ->group(group);
    app.add_option("--failure", condition.failure, "How sensors fail")
        ->option_text("NAME [perfect]")
        ->group(group);
    app.add_option("--predictor", condition.predictor, "How the graph is repaired")
        ->option_text("NAME [none]")
        ->group(group);
    static const std::map<std::string, traffic::SafetyChecks> checks = {{"on", traffic::SafetyChecks::on},
                                                                        {"off", traffic::SafetyChecks::off}};
    app.add_option_function<std::string>(
           "--safety-checks",
           [&condition](const std::string& name) { condition.safety_checks = checks.at(name); },
           "SUMO's own checks of commanded speeds and lane changes")
        ->check(CLI::IsMember(checks))
        ->option_text("on|off [on]")
        ->group(group);
}

}  // namespace clearway::cli
