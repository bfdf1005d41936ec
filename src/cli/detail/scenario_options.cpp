#include "cli/detail/scenario_options.hpp"

#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace clearway::cli {
namespace {

const char* const group = "Scenario (the defaults are those of the scenario)";

void add_demand_options(CLI::App& app, scenario::Options& options) {
    app.add_flag_callback(
           "--dense", [&options] { options.variant = scenario::Variant::dense; },
           "The scenario's dense variant [standard]")
        ->group(group);
    app.add_option("--density", options.density,
                   "Factor on the numbers of human-driven and automated vehicles")
        ->option_text("FACTOR, 0 to 100 [1]")
        ->group(group);
    app.add_option("--av-share", options.automated_share, "Share of these that is automated")
        ->option_text("SHARE, 0 to 1 [as counted]")
        ->group(group);
    app.add_option("--kinds", options.traffic_kinds, "Weights of the kinds car, van, truck, bus")
        ->option_text("car=W,... [car=1]")
        ->group(group);
    app.add_option("--emergency-kinds", options.emergency_kinds,
                   "Weights of the kinds ambulance, fire_engine, police_car")
        ->option_text("ambulance=W,... [ambulance=1]")
        ->group(group);
}

void add_physics_options(CLI::App& app, scenario::Options& options) {
    app.add_option("--road-limit", options.road_limit_kmh,
                   "Limit faster roads to this, km/h; 0 leaves them as they are")
        ->option_text("KMH, 0 to 400 [0]")
        ->group(group);
    app.add_option("--warm-up", options.warm_up_s, "Emergency vehicles enter after this simulation time, s")
        ->option_text("SECONDS [by scenario]")
        ->group(group);
    app.add_option("--horizon", options.horizon_s, "End a run at this simulation time, s")
        ->option_text("SECONDS [by scenario]")
        ->group(group);
    app.add_option("--step-length", options.step_length_s,
                   "Simulation step, s; above 0.25 results are marked")
        ->option_text("SECONDS, 0.1 to 1 [0.25]")
        ->group(group);
    app.add_option("--time-to-teleport", options.time_to_teleport_s,
                   "SUMO teleports a vehicle that has stood this long, s; -1: never")
        ->option_text("SECONDS, -1 to 86400 [300]")
        ->group(group);
    app.add_option("--siren", options.siren_compliance, "Share of human drivers that yield to a siren")
        ->option_text("SHARE, 0 to 1 [by scenario: 0]")
        ->group(group);
    app.add_option("--road-speed", options.road_speed_factor,
                   "Factor on all speed limits, as in rain or snow")
        ->option_text("FACTOR, 0.05 to 1 [by scenario: 1]")
        ->group(group);
    app.add_option("--friction", options.friction, "Share of a dry road's grip when accelerating and braking")
        ->option_text("SHARE, 0.1 to 1 [by scenario: 1]")
        ->group(group);
    app.add_option("--pedestrians", options.pedestrians, "Pedestrians per hour at each crossing with signals")
        ->option_text("NUMBER, 0 to 2000 [by scenario: 0]")
        ->group(group);
    static const std::map<std::string, scenario::IdmPreset> presets = {
        {"sumo", scenario::IdmPreset::sumo}, {"treiber", scenario::IdmPreset::treiber}};
    app.add_option_function<std::string>(
           "--idm", [&options](const std::string& name) { options.idm = presets.at(name); },
           "Parameters of the car-following model (IDM)")
        ->check(CLI::IsMember(presets))
        ->option_text("sumo|treiber [sumo]")
        ->group(group);
    static const std::map<std::string, scenario::FollowingModel> models = {
        {"idm", scenario::FollowingModel::idm}, {"krauss", scenario::FollowingModel::krauss}};
    app.add_option_function<std::string>(
           "--car-following", [&options](const std::string& name) { options.following = models.at(name); },
           "Car-following model: the Intelligent Driver Model or SUMO's own with its defaults")
        ->check(CLI::IsMember(models))
        ->option_text("idm|krauss [by scenario: idm]")
        ->group(group);
    app.add_option("--driver-spread", options.driver_spread,
                   "Relative deviation of headway, acceleration, braking and speed between human drivers")
        ->option_text("SHARE, 0 to 1 [by scenario: 0]")
        ->group(group);
}

}  // namespace

void add_scenario_options(CLI::App& app, scenario::Options& options) {
    add_demand_options(app, options);
    add_physics_options(app, options);
}

}  // namespace clearway::cli
