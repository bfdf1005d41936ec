#include "study/detail/situation.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/temporary_folder.hpp"
#include "experiment/equipped_signals.hpp"
#include "experiment/settings.hpp"
#include "roads/network.hpp"
#include "roads/shoulder.hpp"
#include "scenario/call.hpp"
#include "scenario/incident.hpp"
#include "scenario/mean_times.hpp"
#include "scenario/network.hpp"
#include "scenario/prepare.hpp"
#include "scenario/vehicle_types.hpp"

namespace clearway::study::detail {
namespace {

using experiment::ConditionSpec;
using experiment::TrafficModel;

constexpr const char* sublane_cure =
    "Run it with --traffic-model sublane, in a study file traffic_model = \"sublane\"";

/// An emergency vehicle of a scenario.
struct Widest {
    traffic::VehicleKind kind = traffic::VehicleKind::ambulance;
    double width_m = 0.0;
};

Widest widest_emergency(const scenario::ScenarioConfig& scenario) {
    Widest widest;
    const auto offer = [&](std::string_view name) {
        const auto kind = core::value_from<traffic::VehicleKind>(name);
        if (!kind) return;
        const double width_m = scenario::properties(*kind).width_m;
        if (width_m > widest.width_m) widest = {*kind, width_m};
    };
    core::for_each_field<scenario::EmergencyKinds>([&](const auto& field) {
        if (scenario.demand.emergency > 0 && scenario.emergency_kinds.*field.member > 0.0) offer(field.name);
    });
    for (const scenario::EmergencyTrip& trip : scenario.emergency_trips)
        offer(trip.kind);
    return widest;
}

/// The widest gap between two neighbouring lanes when a car on each keeps to its outer edge, m; 0 without
/// such lanes.
double widest_gap_m(const roads::Network& network) {
    const double cars_m = 2.0 * scenario::properties(traffic::VehicleKind::car).width_m;
    double widest_m = 0.0;
    for (std::size_t row = 1; row < network.lanes().size(); ++row) {
        const roads::Lane& right = network.lanes()[row - 1];
        const roads::Lane& left = network.lanes()[row];
        if (right.edge != left.edge || network.edge(left.edge).internal) continue;
        if (right.allows_cars && left.allows_cars)
            widest_m = std::max(widest_m, right.width_m + left.width_m - cars_m);
    }
    return widest_m;
}

bool has_shoulders(const roads::Network& network) {
    for (std::uint32_t edge = 0; edge < network.edges().size(); ++edge) {
        if (roads::has_shoulder(network, core::EdgeIndex{edge})) return true;
    }
    return false;
}

/// The room that the condition's emergency vehicles keep when they drive between lanes; nothing if they do
/// not.
std::optional<double> margin_between_lanes(const ConditionSpec& condition,
                                           const scenario::ScenarioConfig& scenario) {
    if (condition.traffic_model != TrafficModel::sublane) return std::nullopt;
    const traffic::PrivilegeConfig privilege = experiment::privilege_config(condition, scenario.privilege);
    if (privilege.between_lanes == 0) return std::nullopt;
    return privilege.margin_m;
}

void check_gap(const ConditionSpec& condition, const scenario::ScenarioConfig& scenario,
               const roads::Network& network, double margin_m, std::vector<core::Problem>& problems) {
    const Widest widest = widest_emergency(scenario);
    const double gap_m = widest_gap_m(network);
    if (widest.width_m + margin_m <= gap_m) return;
    problems.push_back(
        {fmt::format("condition {}, scenario {}", condition.name, scenario.name),
         fmt::format("{:g} m of {} and {:g} m of margin do not fit between two lanes", widest.width_m,
                     traffic::name(widest.kind), margin_m),
         fmt::format("at most {:.2f} m, the widest gap between two cars at the edges of their lanes", gap_m),
         "Choose a narrower kind (--emergency-kinds, or the kind of an [[emergency_trip]]), wider lanes, a "
         "smaller privilege.margin_m, or privilege.between_lanes=0"});
}

void check_equipped(const ConditionSpec& condition, const scenario::ScenarioConfig& scenario,
                    const roads::Network& network, std::vector<core::Problem>& problems) {
    try {
        experiment::equipped_signals(condition, network);
    } catch (const core::InputError& error) {
        for (core::Problem problem : error.problems()) {
            problem.where = fmt::format("scenario {}, {}", scenario.name, problem.where);
            problems.push_back(std::move(problem));
        }
    }
}

}  // namespace

void check_traffic_model(const ConditionSpec& condition, const scenario::ScenarioConfig& scenario,
                         std::vector<core::Problem>& problems) {
    if (condition.traffic_model != TrafficModel::standard) return;
    const traffic::PrivilegeConfig privilege = experiment::privilege_config(condition, scenario.privilege);
    if (privilege.between_lanes != 0)
        problems.push_back({fmt::format("condition {}, scenario {}", condition.name, scenario.name),
                            "lets emergency vehicles drive between lanes, which traffic model \"standard\" "
                            "cannot show",
                            "traffic model \"sublane\", or privilege.between_lanes=0", sublane_cure});
}

void check_calls(const std::vector<ConditionSpec>& conditions,
                 const std::vector<scenario::ScenarioConfig>& scenarios,
                 std::vector<core::Problem>& problems) {
    const auto has_calls = [](const scenario::ScenarioConfig& scenario) { return !scenario.calls.empty(); };
    if (std::ranges::any_of(scenarios, has_calls)) return;
    for (const ConditionSpec& condition : conditions) {
        const bool tries = experiment::loop_config(condition).units_tried > 0;
        if (!tries && condition.dispatch == ConditionSpec{}.dispatch) continue;
        problems.push_back(
            {fmt::format("condition {}: {}", condition.name, tries ? "loop.units_tried" : "dispatch"),
             "has no effect: nobody is called in any scenario", "a scenario with [[call]]",
             "leave it out, or add calls"});
    }
}

void check_mean_times(const std::vector<ConditionSpec>& conditions, const scenario::ScenarioConfig& scenario,
                      std::uint64_t study_seed, std::vector<core::Problem>& problems) {
    const auto wants = [](const auto& setting) {
        return setting.first.ends_with(".prior") && setting.second == "mean_times";
    };
    for (const ConditionSpec& condition : conditions) {
        const auto setting = std::ranges::find_if(condition.settings, wants);
        if (setting == condition.settings.end()) continue;
        const std::string& file = scenario.network.mean_times;
        const std::string where =
            fmt::format("condition {}, scenario {}: {}", condition.name, scenario.name, setting->first);
        if (file.empty()) {
            problems.push_back({where, "is mean_times, and the scenario names none",
                                "a scenario with network.mean_times, or another prior",
                                "`clearway scenario mean-times SCENARIO --out FILE` makes them"});
        } else if (scenario::read_mean_times(scenario::resolve(scenario, file), problems).study_seed ==
                   study_seed) {
            problems.push_back(
                {where,
                 fmt::format("{} was made with study seed {}, which is that of this study", file, study_seed),
                 "times of other days", "Give the study another seed"});
        }
    }
}

namespace {

/// Incidents and calls that do not fit the network, and pedestrians without a crossing.
void check_events(const scenario::ScenarioConfig& scenario, const roads::Network& network,
                  std::vector<core::Problem>& problems) try {
    scenario::require_crossings(scenario, network);
    scenario::place_calls(scenario, network, scenario::place_incidents(scenario, network));
} catch (const core::InputError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
}

}  // namespace

void check_roads(const std::vector<ConditionSpec>& conditions, const scenario::ScenarioConfig& scenario,
                 std::vector<core::Problem>& problems) {
    std::optional<roads::Network> network;
    const auto built = [&]() -> const roads::Network& {
        if (!network) {
            const core::TemporaryFolder folder;
            network = scenario::build_network(scenario, folder.path()).network;
        }
        return *network;
    };
    if (!scenario.incidents.empty() || !scenario.calls.empty() || scenario.pedestrians.walk())
        check_events(scenario, built(), problems);
    for (const ConditionSpec& condition : conditions) {
        const std::vector<std::string> pulling_over =
            experiment::policies_with(condition, traffic::Trait::shoulder);
        if (!pulling_over.empty() && !has_shoulders(built()))
            problems.push_back(
                {fmt::format("condition {}, scenario {}", condition.name, scenario.name),
                 fmt::format("{} needs a shoulder, and no road of the network has one",
                             core::listed(pulling_over)),
                 "an outermost lane of 2 m or more that is closed to cars, EVs and pedestrians",
                 "Add shoulders, or choose another policy, such as pull_aside"});
        if (condition.settings.contains(experiment::equipped_setting))
            check_equipped(condition, scenario, built(), problems);
        if (const auto margin_m = margin_between_lanes(condition, scenario))
            check_gap(condition, scenario, built(), *margin_m, problems);
    }
}

}  // namespace clearway::study::detail
