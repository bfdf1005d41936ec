#include "report/facts.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace clearway::report {

const std::array<MeasureInfo, measure_count>& measures() {
    using M = Measure;
    static constexpr std::array<MeasureInfo, measure_count> table = {{
        {M::emergency_waiting_time, "emergency_waiting_time_s", "EV waiting time", "s",
         "Time that an emergency vehicle (EV) stands (below 0.1 m/s), mean over the EVs that entered.",
         Better::lower, Relevance::least, 1.0},
        {M::emergency_depart_delay, "emergency_depart_delay_s", "EV depart delay", "s",
         "Time that an EV waits for a gap to enter the network.", Better::lower, Relevance::least, 1.0},
        {M::waiting_time, "waiting_time_s", "Waiting time, all", "s",
         "Time that a vehicle stands, mean over all that entered.", Better::lower, Relevance::any, 1.0},
        {M::emergency_restricted_time, "emergency_restricted_travel_time_s", "EV travel time, all", "s",
         "From entering the network to arriving, restricted mean over all EVs: one that did not arrive "
         "(teleported, removed, not inserted, still on the road) counts with the horizon. The primary "
         "measure, used by verdicts.",
         Better::lower, Relevance::least, 1.0},
        {M::emergency_travel_time, "emergency_travel_time_s", "EV travel time, arrived only", "s",
         "The same, mean over the EVs that arrived: it hides those that were lost.", Better::lower,
         Relevance::least, 1.0},
        {M::emergency_time_loss, "emergency_time_loss_s", "EV time loss, arrived only", "s",
         "Travel time beyond that at the desired speed, mean over the EVs that arrived.", Better::lower,
         Relevance::least, 1.0},
        {M::gap_closed, "gap_closed", "Gap closed", "%",
         "Share of the way from the baseline's EV travel time (all) to that of an EV alone on the road with "
         "open signals.",
         Better::higher, Relevance::any, 100.0},
        {M::other_time_loss, "others_time_loss_s", "Time loss, others", "s",
         "Time loss of all vehicles that are not EVs: what the gain costs them.", Better::lower,
         Relevance::any, 1.0},
        {M::depart_delay, "depart_delay_s", "Depart delay, all", "s",
         "Depart delay, mean over all vehicles that entered.", Better::lower, Relevance::any, 1.0},
        {M::collisions, "collisions", "Collisions", "per run", "Collisions per run, junctions included.",
         Better::lower, Relevance::any, 1.0},
        {M::teleports, "teleports", "Teleports", "per run",
         "Vehicles per run that SUMO took off the road and put down elsewhere.", Better::lower,
         Relevance::any, 1.0},
        {M::unfinished, "not_arrived", "Unfinished", "per run",
         "Vehicles per run that did not arrive: running at its end, not inserted or removed.", Better::lower,
         Relevance::any, 1.0},
    }};
    return table;
}

const MeasureInfo& info(Measure measure) {
    return measures()[static_cast<std::size_t>(measure)];
}

std::string labelled(Measure measure, const std::string& what) {
    const MeasureInfo& one = info(measure);
    return what.empty() ? fmt::format("{}, {}", one.title, one.unit)
                        : fmt::format("{}: {}, {}", one.title, what, one.unit);
}

std::size_t ScenarioFacts::place_of(const std::string& condition) const {
    const auto found = std::ranges::find(conditions, condition, &ConditionFacts::name);
    return static_cast<std::size_t>(found - conditions.begin());
}

const ConditionFacts* ScenarioFacts::baseline_of(const ConditionFacts& condition) const {
    const std::size_t place = condition.is_compared() ? place_of(condition.baseline) : conditions.size();
    return place == conditions.size() ? nullptr : &conditions[place];
}

const ConditionFacts* ScenarioFacts::of_map() const {
    const std::size_t place = map ? place_of(map->condition) : conditions.size();
    return place == conditions.size() ? nullptr : &conditions[place];
}

std::string ScenarioFacts::place_name(const std::string& edge) const {
    const auto street = streets.find(edge);
    return street == streets.end() || street->second.empty() ? edge : street->second + " (" + edge + ")";
}

}  // namespace clearway::report
