#include "cli/condition_options.hpp"

namespace clearway::cli {

void add_condition_options(CLI::App& app, experiment::ConditionSpec& condition, const std::string& group) {
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
    add_switch(app, "--safety-checks", condition.safety_checks,
               "SUMO's own checks of commanded speeds and lane changes")
        ->option_text("on|off [on]")
        ->group(group);
}

}  // namespace clearway::cli
