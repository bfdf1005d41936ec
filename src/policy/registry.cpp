#include <tuple>
#include <utility>

#include "policy/check_in_out.hpp"
#include "policy/clear_lane.hpp"
#include "policy/corridor.hpp"
#include "policy/dissertation.hpp"
#include "policy/geocast.hpp"
#include "policy/give_way.hpp"
#include "policy/green_wave.hpp"
#include "policy/hold_cross.hpp"
#include "policy/line_of_sight.hpp"
#include "policy/listing_5_5.hpp"
#include "policy/navigate.hpp"
#include "policy/policy.hpp"
#include "policy/preempt_signals.hpp"
#include "policy/pull_aside.hpp"
#include "policy/pull_over.hpp"
#include "policy/python_policy.hpp"
#include "policy/recover_signals.hpp"
#include "policy/red_privilege.hpp"
#include "policy/rescue_lane.hpp"
#include "policy/vacate_lane.hpp"

namespace clearway::policy {
namespace {

using traffic::Trait;

/// A policy whose constructor takes the context and, if it has settings, a `Config`.
template <class Kind, class... Config>
PolicyEntry entry(const std::string& name, const char* summary, std::vector<Trait> traits = {}) {
    const auto make = [name](const PolicyContext& context,
                             const core::Settings& settings) -> std::unique_ptr<Policy> {
        std::tuple<Config...> config;
        return std::apply(
            [&](auto&... numbers) {
                core::set_all(core::settings_of(settings, name), name + ".", numbers...);
                return std::make_unique<Kind>(context, numbers...);
            },
            config);
    };
    return {{name, summary, std::move(traits), core::settings_table<Config...>(), make}, {name}};
}

/// A policy that combines others and has no settings of its own.
template <class Kind>
PolicyEntry combination(const char* name, const char* summary, std::vector<std::string> components) {
    const auto make = [](const PolicyContext& context,
                         const core::Settings& settings) -> std::unique_ptr<Policy> {
        return std::make_unique<Kind>(context, settings);
    };
    return {{name, summary, {}, core::settings_table<>(), make}, std::move(components)};
}

}  // namespace

const traffic::Registry<PolicyEntry>& policies() {
    static const traffic::Registry<PolicyEntry> registry(
        "policy",
        {
            entry<Listing55, Listing55Config>("listing_5_5",
                                              "The dissertation's listing 5.5 as published, defects included",
                                              {Trait::reads_links, Trait::repeats_dissertation}),
            entry<Dissertation, DissertationConfig>(
                "dissertation", "The dissertation's policy as described in 4.3, made workable",
                {Trait::reads_links, Trait::renews_requests, Trait::compares_only}),
            entry<PreemptSignals, PreemptSignalsConfig, RequestMemorySettings>(
                "preempt_signals", "Green for the emergency vehicle's approach on its arrival",
                {Trait::asks_signals}),
            entry<RecoverSignals, RecoverSignalsConfig>(
                "recover_signals", "Gives green time back to the approaches that waited"),
            entry<ClearLane, ClearLaneConfig>("clear_lane",
                                              "Automated vehicles ahead leave the emergency vehicle's lane",
                                              {Trait::renews_requests}),
            combination<Corridor>("corridor",
                                  "preempt_signals, recover_signals, clear_lane and give_way together",
                                  {"preempt_signals", "recover_signals", "clear_lane", "give_way"}),
            entry<GreenWave, GreenWaveConfig>(
                "green_wave",
                "For comparison: green at every signal on the route, planned once by arrival times",
                {Trait::asks_signals, Trait::compares_only}),
            entry<CheckInOut, CheckInOutConfig>(
                "check_in_out",
                "For comparison: a detector before the stop line calls green, one behind it releases",
                {Trait::asks_signals, Trait::asks_without_radio, Trait::compares_only}),
            entry<LineOfSight, LineOfSightConfig>(
                "line_of_sight",
                "For comparison: an optical emitter calls green while the signal is in its beam",
                {Trait::asks_signals, Trait::asks_without_radio, Trait::compares_only}),
            entry<RedPrivilege, RedPrivilegeConfig>(
                "red_privilege", "For comparison: the emergency vehicle passes red slowly and yielding",
                {Trait::compares_only}),
            entry<Navigate, NavigateConfig>(
                "navigate", "The emergency vehicle takes the way that is believed to be fastest now"),
            entry<VacateLane, VacateLaneConfig>(
                "vacate_lane", "Vehicles clear a path, planned around those that do not cooperate",
                {Trait::renews_requests}),
            entry<PullAside, PullAsideConfig>(
                "pull_aside", "Vehicles in a queue pull aside until the emergency vehicle has passed",
                {Trait::renews_requests}),
            entry<HoldCross, HoldCrossConfig>("hold_cross",
                                              "Cross traffic stops at its stop line although it has green",
                                              {Trait::renews_requests}),
            entry<GiveWay, GiveWayConfig>(
                "give_way", "At junctions without signals, vehicles with right of way stop and yield",
                {Trait::renews_requests}),
            entry<RescueLane, RescueLaneConfig>(
                "rescue_lane", "Slow traffic moves to the edges of its lanes and opens a lane between them",
                {Trait::renews_requests, Trait::sublane_model}),
            entry<PullOver, PullOverConfig>(
                "pull_over",
                "Slower vehicles ahead stop on the shoulder until the emergency vehicle has passed",
                {Trait::renews_requests, Trait::shoulder}),
            entry<Geocast, GeocastConfig>(
                "geocast", "Every vehicle that receives the message clears a lane for the emergency vehicle",
                {Trait::renews_requests}),
        });
    return registry;
}

std::unique_ptr<Policy> make_policy(const std::string& name, const PolicyContext& context,
                                    const core::Settings& settings) {
    if (python::part_name_from(name))
        return std::make_unique<PythonPolicy>(context, name,
                                              core::settings_of(settings, python::short_name(name)));
    return policies().at(name).make(context, settings);
}

}  // namespace clearway::policy
