#pragma once

#include <array>

#include "prediction/net_input.hpp"
#include "prediction/weights.hpp"

namespace clearway::prediction {

// What the improved net, `graphsage`, is given: names, units and scales of all its inputs. Code that computes
// them, files of weights, the model card and tests share these tables. A change of any number, or of the
// order, is a new version of the schema. "The route rule" is the one without start at green: a vehicle that
// stands stays where it stood. No coordinates of the map, no truth, nothing of the future.

/// Of a vehicle. Only vehicles that were not heard (receivers) have those from `age` on; the others have 0.
inline constexpr std::array node_inputs = {
    NetInput{"known", "flag", 1.0F, unbounded, "It was heard just now"},
    NetInput{"automated", "flag", 1.0F, unbounded, "It is an automated vehicle"},
    NetInput{"emergency", "flag", 1.0F, unbounded, "It is an emergency vehicle"},
    NetInput{"speed", "m/s", 15.0F, 4.0F, "Last reported speed"},
    NetInput{"smoothed_speed", "m/s", 15.0F, 4.0F, "Smoothed reported speed"},
    NetInput{"speed_change", "m/s", 5.0F, 3.0F, "Last reported speed less the smoothed one"},
    NetInput{"age", "s", 10.0F, 6.0F, "Age of its newest report"},
    NetInput{"log_age", "1", 3.0F, unbounded, "ln(1 + age / 1 s)"},
    NetInput{"speed_limit", "m/s", 15.0F, 4.0F, "Speed limit of its last reported lane"},
    NetInput{"travelled", "m", 100.0F, 4.0F, "Reported speed times age, within the reach"},
    NetInput{"displacement", "m", 100.0F, 4.0F, "Displacement along its route by the route rule"},
    NetInput{"reach", "m", 200.0F, 4.0F, "It cannot have come further"},
    NetInput{"free_flow", "m", 100.0F, 4.0F, "Displacement at the speed limits of its way"},
    NetInput{"line", "flag", 1.0F, unbounded, "A stop line with a signal is on its way"},
    NetInput{"line_distance", "m", 100.0F, 4.0F, "Distance of that line"},
    NetInput{"line_green", "flag", 1.0F, unbounded, "Its signal is green"},
    NetInput{"line_signal_age", "s", 20.0F, 3.0F, "Since when its signal is as it is"},
    NetInput{"next_line", "flag", 1.0F, unbounded, "A second stop line with a signal is on its way"},
    NetInput{"next_line_distance", "m", 100.0F, 4.0F, "Distance of the second line"},
    NetInput{"next_line_green", "flag", 1.0F, unbounded, "The second line's signal is green"},
    NetInput{"next_line_signal_age", "s", 20.0F, 3.0F, "Since when the second line's signal is as it is"},
    NetInput{"report_to_signal_change", "s", 10.0F, 3.0F, "Time from its report to the last signal change"},
    NetInput{"travelled_past_line", "m", 100.0F, 3.0F, "Travelled distance less that of the line"},
    NetInput{"leader", "flag", 1.0F, unbounded,
             "A vehicle was ahead of it in its lane when it was last heard"},
    NetInput{"leader_known", "flag", 1.0F, unbounded, "That vehicle was heard just now"},
    NetInput{"leader_distance", "m", 50.0F, 6.0F, "Distance of the leader from where it was last seen"},
    NetInput{"leader_gap", "m", 50.0F, 4.0F,
             "Gap to the leader's rear after the displacement that is corrected"},
    NetInput{"leader_speed", "m/s", 15.0F, unbounded, "Speed of the leader"},
    NetInput{"follower", "flag", 1.0F, unbounded, "It was ahead of a vehicle when that one was last heard"},
    NetInput{"follower_known", "flag", 1.0F, unbounded, "The follower was heard just now"},
    NetInput{"follower_distance", "m", 50.0F, 6.0F, "Distance of the follower from where it was last seen"},
    NetInput{"follower_gap", "m", 50.0F, 4.0F,
             "The follower's distance less its length and the displacement"},
    NetInput{"follower_speed", "m/s", 15.0F, unbounded, "Speed of the follower"},
    NetInput{"route_left", "m", 100.0F, 4.0F, "Way to the end of its route after the displacement"},
    NetInput{"past_end", "flag", 1.0F, unbounded, "Dead reckoning is past the end of its route"},
    NetInput{"has_left", "flag", 1.0F, unbounded, "The route rule believes that it has left"},
    NetInput{"exits_known", "flag", 1.0F, unbounded, "It is known when a vehicle leaves the network"},
    NetInput{"place_sigma", "m", 5.0F, 4.0F, "Standard deviation of the place where it was last seen"},
    NetInput{"detections", "1", 4.0F, 3.0F, "Number of neighbours that still detect it"},
    NetInput{"held_by_signal", "flag", 1.0F, unbounded, "The route rule holds it at a stop line"},
    NetInput{"held_by_leader", "flag", 1.0F, unbounded, "The route rule holds it behind its leader"},
    NetInput{"lane_has_traffic", "flag", 1.0F, unbounded, "A known vehicle is in its last reported lane"},
    NetInput{"lane_speed", "m/s", 15.0F, unbounded, "Mean speed of the known vehicles there"},
    NetInput{"inside_junction", "flag", 1.0F, unbounded, "Its last reported lane is inside a junction"},
    NetInput{"fresh", "flag", 1.0F, unbounded, "Its report is of the newest round"},
    NetInput{"twin", "flag", 1.0F, unbounded, "It drives on as a car-following twin"},
    NetInput{"twin_displacement", "m", 100.0F, 4.0F, "Displacement of its twin along its route"},
    NetInput{"twin_speed", "m/s", 15.0F, 4.0F, "Speed of its twin"},
    NetInput{"twin_limit", "m/s", 15.0F, 4.0F, "Speed limit where its twin is"},
    NetInput{"twin_waits", "flag", 1.0F, unbounded, "Its twin waits for room in a lane that leads on"},
    NetInput{"twin_at_end", "flag", 1.0F, unbounded, "Its twin has come to the end of its route"},
    NetInput{"twin_line", "flag", 1.0F, unbounded, "A stop line with a signal is ahead of its twin"},
    NetInput{"twin_line_distance", "m", 100.0F, 4.0F, "Distance of that line from its twin"},
    NetInput{"twin_line_green", "flag", 1.0F, unbounded, "Its signal is green"},
    NetInput{"twin_leader", "flag", 1.0F, unbounded, "A vehicle is ahead of its twin"},
    NetInput{"twin_leader_age", "s", 10.0F, 6.0F, "Age of that vehicle's newest report"},
    NetInput{"twin_leader_gap", "m", 50.0F, 4.0F, "Gap of its twin to that vehicle's rear"},
    NetInput{"twin_leader_speed", "m/s", 15.0F, 4.0F, "Speed of that vehicle"},
    NetInput{"twin_follower", "flag", 1.0F, unbounded, "A vehicle is behind its twin in the same lane"},
    NetInput{"twin_follower_age", "s", 10.0F, 6.0F, "Age of that vehicle's newest report"},
    NetInput{"twin_follower_gap", "m", 50.0F, 4.0F, "Gap of that vehicle to the twin's rear"},
    NetInput{"twin_follower_speed", "m/s", 15.0F, 4.0F, "Speed of that vehicle"},
};

/// Of an edge that carries a message from a source to a receiver. Directions are those of the receiver's way.
inline constexpr std::array edge_inputs = {
    NetInput{"ahead", "m", 50.0F, 3.0F, "The source's place ahead of the receiver's"},
    NetInput{"left", "m", 50.0F, 3.0F, "The source's place to the left of the receiver's"},
    NetInput{"left_near", "m", 5.0F, 2.0F, "The same, in lanes"},
    NetInput{"distance", "m", 50.0F, 4.0F, "Distance of both"},
    NetInput{"cosine", "1", 1.0F, unbounded, "Cosine of the angle between both headings"},
    NetInput{"sine", "1", 1.0F, unbounded, "Its sine"},
    NetInput{"speed", "m/s", 15.0F, 4.0F, "Last reported speed of the source"},
    NetInput{"relative_speed", "m/s", 15.0F, 4.0F, "Its part along the receiver's way, less the receiver's"},
    NetInput{"known", "flag", 1.0F, unbounded, "The source was heard just now"},
    NetInput{"age", "s", 10.0F, 6.0F, "Age of the source's newest report"},
    NetInput{"is_leader", "flag", 1.0F, unbounded, "The source was ahead in the receiver's lane"},
    NetInput{"is_follower", "flag", 1.0F, unbounded, "The source was behind in its lane"},
    NetInput{"detects", "flag", 1.0F, unbounded, "The source detects the receiver"},
    NetInput{"range_measured", "flag", 1.0F, unbounded, "It measures the distance"},
    NetInput{"range_error", "m", 50.0F, 3.0F, "Distance of both less the measured one"},
    NetInput{"same_lane", "flag", 1.0F, unbounded, "Both were last seen in one lane"},
    NetInput{"lane_lead", "m", 50.0F, 3.0F, "How far the source was ahead in that lane"},
    NetInput{"emergency", "flag", 1.0F, unbounded, "The source is an emergency vehicle"},
    NetInput{"twin_leads", "flag", 1.0F, unbounded, "The source is ahead of the receiver's twin"},
    NetInput{"twin_follows", "flag", 1.0F, unbounded, "It is behind the receiver's twin"},
    NetInput{"on_way", "flag", 1.0F, unbounded, "It is on the lanes of the receiver's way"},
    NetInput{"way_lead", "m", 50.0F, 3.0F, "How far it is ahead of the receiver on these lanes"},
};

/// Of a pair whose link is to be judged. The first end is the one that was not heard; of two such, the one
/// with the older report.
inline constexpr std::array pair_inputs = {
    NetInput{"last_seen", "m", 50.0F, 4.0F, "Distance of the last reported places"},
    NetInput{"dead_reckoned", "m", 50.0F, 4.0F, "Distance of the dead-reckoned places"},
    NetInput{"by_rule", "m", 50.0F, 4.0F, "Distance of the places by the route rule"},
    NetInput{"both_missing", "flag", 1.0F, unbounded, "Neither was heard just now"},
    NetInput{"age_younger", "s", 10.0F, 6.0F, "Age of the younger report"},
    NetInput{"age_older", "s", 10.0F, 6.0F, "Age of the older report"},
    NetInput{"heading_cosine", "1", 1.0F, unbounded, "Cosine of the angle between the reported headings"},
    NetInput{"same_edge", "flag", 1.0F, unbounded, "Both were last seen on one edge"},
    NetInput{"same_lane", "flag", 1.0F, unbounded, "Both were last seen in one lane"},
    NetInput{"follows", "flag", 1.0F, unbounded, "One is the other's leader or follower"},
    NetInput{"any_detection", "flag", 1.0F, unbounded, "Some pair of the scene is detected"},
    NetInput{"detected_share", "1", 1.0F, unbounded, "Detected pairs among detected and candidate ones"},
    NetInput{"by_twin", "m", 50.0F, 8.0F, "Distance of the believed places: of twins where there are twins"},
    NetInput{"inside", "m", 50.0F, 4.0F, "Link radius less that distance"},
    NetInput{"twin_logit", "1", 4.0F, 3.0F, "Logit of the link by the predictor car_following"},
    NetInput{"twin_same_lane", "flag", 1.0F, unbounded, "Both are believed to be in one lane"},
    NetInput{"radius", "m", 50.0F, 20.0F, "Link radius"},
    NetInput{"nearest", "m", 50.0F, 4.0F, "Least distance of the first end's way to the second's place"},
    NetInput{"share_within", "1", 1.0F, unbounded, "Share of that way within the link radius of the place"},
    NetInput{"ahead", "m", 50.0F, 4.0F, "The second's place ahead of the first's"},
    NetInput{"left", "m", 50.0F, 4.0F, "The second's place to the left of the first's"},
};

inline constexpr std::size_t node_width = node_inputs.size();
inline constexpr std::size_t edge_width = edge_inputs.size();
inline constexpr std::size_t pair_width = pair_inputs.size();
/// Inputs of a node that every vehicle has; the others belong to receivers.
inline constexpr std::size_t common_width = input_index(node_inputs, "age");

consteval std::size_t node_input(std::string_view name) {
    return input_index(node_inputs, name);
}
consteval std::size_t edge_input(std::string_view name) {
    return input_index(edge_inputs, name);
}
consteval std::size_t pair_input(std::string_view name) {
    return input_index(pair_inputs, name);
}

/// Name and version of all of this; its width is `node_width`.
FeatureSchema repair_schema();
/// The names, for files of weights.
std::vector<InputNames> repair_input_names();

}  // namespace clearway::prediction
