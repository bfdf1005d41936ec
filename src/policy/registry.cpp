#include <tuple>
#include <utility>

#include "core/error.hpp"
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

/// What of a believed graph a policy acts on.
enum class Reads { places, links };

/// A policy whose constructor takes the context and, if it has settings, a `Config`.
template <class Kind, class... Config>
PolicyEntry entry(const std::string& name, const char* summary, Reads reads = Reads::places) {
    return {name,
            summary,
            {name},
            reads == Reads::links,
            core::settings_table<Config...>(),
            [name](const PolicyContext& context, const core::Settings& settings) -> std::unique_ptr<Policy> {
                std::tuple<Config...> config;
                return std::apply(
                    [&](auto&... numbers) {
                        core::set_all(core::settings_of(settings, name), name + ".", numbers...);
                        return std::make_unique<Kind>(context, numbers...);
                    },
                    config);
            }};
}

PolicyEntry needing(PolicyEntry entry, Need need) {
    entry.needs = {need};
    return entry;
}

/// A policy that combines others and has no settings of its own.
template <class Kind>
PolicyEntry combination(const char* name, const char* summary, std::vector<std::string> components) {
    return {name,
            summary,
            std::move(components),
            false,
            core::settings_table<>(),
            [](const PolicyContext& context, const core::Settings& settings) -> std::unique_ptr<Policy> {
                return std::make_unique<Kind>(context, settings);
            }};
}

}  // namespace

const std::vector<PolicyEntry>& policies() {
    static const std::vector<PolicyEntry> entries = {
        entry<Listing55, Listing55Config>(
            "listing_5_5", "The dissertation's listing 5.5 as published, defects included", Reads::links),
        entry<Dissertation, DissertationConfig>(
            "dissertation", "The dissertation's policy as described in 4.3, made workable", Reads::links),
        entry<PreemptSignals, PreemptSignalsConfig, RequestMemorySettings>(
            "preempt_signals", "Green for the emergency vehicle's approach on its arrival"),
        entry<RecoverSignals, RecoverSignalsConfig>("recover_signals",
                                                    "Gives time back to the approaches that waited"),
        entry<ClearLane, ClearLaneConfig>("clear_lane",
                                          "Automated vehicles ahead leave the emergency vehicle's lane"),
        combination<Corridor>("corridor",
                              "preempt_signals, recover_signals, clear_lane and give_way together",
                              {"preempt_signals", "recover_signals", "clear_lane", "give_way"}),
        entry<GreenWave, GreenWaveConfig>(
            "green_wave", "Opponent: green at every signal on the route, planned once by arrival times"),
        entry<CheckInOut, CheckInOutConfig>(
            "check_in_out", "Opponent: a detector before the stop line calls green, one behind it releases"),
        entry<LineOfSight, LineOfSightConfig>(
            "line_of_sight", "Opponent: an optical emitter calls green while the signal is in its beam"),
        entry<RedPrivilege, RedPrivilegeConfig>(
            "red_privilege", "Opponent: the emergency vehicle passes red slowly and yielding"),
        entry<VacateLane, VacateLaneConfig>(
            "vacate_lane", "Vehicles leave the emergency vehicle's way, planned round those who will not"),
        entry<PullAside, PullAsideConfig>(
            "pull_aside", "Vehicles of a queue pull aside until the emergency vehicle has passed"),
        entry<HoldCross, HoldCrossConfig>("hold_cross",
                                          "Cross traffic stops at its line although it has green"),
        entry<GiveWay, GiveWayConfig>(
            "give_way", "At junctions without signals, vehicles with right of way stop and yield"),
        needing(entry<RescueLane, RescueLaneConfig>(
                    "rescue_lane", "Slow traffic keeps to the edges of its lanes, a lane between them opens"),
                Need::sublane_model),
        needing(entry<PullOver, PullOverConfig>(
                    "pull_over",
                    "Slower vehicles ahead stop on the shoulder until the emergency vehicle has passed"),
                Need::shoulder),
        entry<Geocast, GeocastConfig>(
            "geocast", "Whoever hears it clears a lane for the emergency vehicle: a message to a place"),
    };
    return entries;
}

std::unique_ptr<Policy> make_policy(const std::string& name, const PolicyContext& context,
                                    const core::Settings& settings) {
    if (python::part_name_from(name))
        return std::make_unique<PythonPolicy>(context, name,
                                              core::settings_of(settings, python::short_name(name)));
    std::vector<std::string> names;
    for (const PolicyEntry& known : policies()) {
        if (known.name == name) return known.make(context, settings);
        names.push_back(known.name);
    }
    const std::string near = core::nearest(name, names);
    throw core::InputError(core::Problem{"policy", "'" + name + "' is not known",
                                         fmt::format("{}", fmt::join(names, ", ")),
                                         near.empty() ? "" : "Did you mean '" + near + "'?"});
}

}  // namespace clearway::policy
