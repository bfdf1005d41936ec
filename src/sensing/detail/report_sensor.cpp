#include "sensing/detail/report_sensor.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "sensing/detail/perfect_sensor.hpp"

namespace clearway::sensing::detail {
namespace {

/// No vehicle is longer than this, m. Widens the search for vehicles that may hide others.
constexpr double longest_vehicle_m = 30.0;

/// Which of two neighbours detects the other: emergency vehicles before automated ones before human-driven
/// ones.
bool detects_first(traffic::VehicleClass one, traffic::VehicleClass other) {
    return static_cast<int>(one) >= static_cast<int>(other);
}

}  // namespace

ReportSensor::ReportSensor(const failures::FailureConfig& config, const core::KeyedRandom& random,
                           const SensorContext& context)
    : config_(config),
      equipment_(config, random),
      loss_(config, random),
      routes_(config, random),
      noise_(config, random, context.network),
      detection_(config, random),
      observers_(config, context.network),
      rules_(context.rules) {
    if (config.map_matching == failures::MapMatching::nearest) matcher_.emplace(context.network);
}

void ReportSensor::observe(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                           traffic::Observation& observation) {
    const double time_s = snapshot.time.value;
    if (round_is_due(time_s)) measure(snapshot, roster);
    observation.is_report = deliver(roster, time_s);
    drop_gone_and_forgotten(snapshot);
    write(snapshot, roster, observation);
}

bool ReportSensor::round_is_due(double time_s) {
    const auto number =
        static_cast<ReportNumber>(std::floor((time_s + core::clock_tolerance_s) / config_.report_interval_s));
    if (report_ && *report_ >= number) return false;
    report_ = number;
    return true;
}

/// Finds the vehicles whose reports arrive, that are seen by others, and that cannot be reached.
void ReportSensor::find_reporting(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    reports_.resize(snapshot.size());
    unreachable_.clear();
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        const core::VehicleKey key = snapshot.key[row];
        const traffic::VehicleClass vehicle_class = snapshot.vehicle_class[row];
        const bool never_lost = vehicle_class == traffic::VehicleClass::emergency &&
                                config_.emergency_dark == failures::EmergencyDark::no;
        const bool reports =
            equipment_.equipped(key, vehicle_class) && (never_lost || !loss_.lost(key, *report_));
        reports_[row] = reports ? 1 : 0;
        if (!reports && config_.dark_commands == failures::DarkCommands::lost) unreachable_.push_back(key);
    }
    if (!observers_.none() || observers_.considers_occlusion()) observers_.take(snapshot, roster);
    observers_.look(snapshot, reports_, seen_sigma_m_);
}

void ReportSensor::measure(const truth::Snapshot& snapshot, const traffic::Roster& roster) {
    Round round;
    if (!spare_rounds_.empty()) {
        round = std::move(spare_rounds_.back());
        spare_rounds_.pop_back();
    }
    round.measured_s = snapshot.time.value;
    round.reports.clear();
    round.detected_links.clear();
    find_reporting(snapshot, roster);
    for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
        if (seen_sigma_m_[row] < 0.0F) continue;
        const core::VehicleKey key = snapshot.key[row];
        Report& report = round.reports.emplace_back(Report{key, snapshot.vehicle_class[row], round.measured_s,
                                                           static_cast<float>(config_.position_sigma_m),
                                                           Source::itself, snapshot.motion(row)});
        if (reports_[row] != 0) {
            noise_.apply(key, *report_, report.state);
        } else {
            report.source = Source::others;
            report.position_sigma_m = seen_sigma_m_[row];
            noise_.blur(key, *report_, seen_sigma_m_[row], report.state);
        }
        if (!routes_.known(key, report.vehicle_class)) report.state.route_edge = 0;
    }
    if (!detection_.none()) detect_links(snapshot, round);
    on_their_way_.push_back(std::move(round));
}

void ReportSensor::detect_links(const truth::Snapshot& snapshot, Round& round) {
    builder_.build({snapshot.x_m, snapshot.y_m, snapshot.vehicle_class}, rules_, true_graph_);
    if (observers_.considers_occlusion())
        builder_.build_all_pairs({snapshot.x_m, snapshot.y_m, snapshot.vehicle_class},
                                 std::min(1000.0, rules_.radius_m + longest_vehicle_m), near_);
    for (core::VehicleIndex left = 0; left < snapshot.size(); ++left) {
        const auto neighbours = true_graph_.neighbours_of(left);
        const auto distances_m = true_graph_.distances_of(left);
        for (std::size_t at = 0; at < neighbours.size(); ++at) {
            const core::VehicleIndex right = neighbours[at];
            if (right < left || (seen_sigma_m_[left] >= 0.0F && seen_sigma_m_[right] >= 0.0F)) continue;
            const core::VehicleKey left_key = snapshot.key[left];
            const core::VehicleKey right_key = snapshot.key[right];
            if (!detection_.in_range(distances_m[at]) || !detection_.detected(left_key, right_key, *report_))
                continue;
            if (observers_.considers_occlusion() && observers_.hidden(left, right, near_.neighbours_of(left)))
                continue;
            const bool from_left = detects_first(snapshot.vehicle_class[left], snapshot.vehicle_class[right]);
            round.detected_links.push_back(
                {.from = from_left ? left_key : right_key,
                 .to = from_left ? right_key : left_key,
                 .range_m = detection_.range_m(left_key, right_key, *report_, distances_m[at]),
                 .range_sigma_m = detection_.range_sigma_m()});
        }
    }
}

bool ReportSensor::deliver(const traffic::Roster& roster, double time_s) {
    bool arrived = false;
    while (!on_their_way_.empty() &&
           on_their_way_.front().measured_s + config_.latency_s <= time_s + core::clock_tolerance_s) {
        Round round = std::move(on_their_way_.front());
        on_their_way_.pop_front();
        for (Report& report : round.reports) {
            report.source == Source::itself ? register_vehicle(roster, report.key)
                                            : register_seen(roster, report.key);
            if (matcher_) match(report);
        }
        merge(round.reports);
        newest_measured_s_ = round.measured_s;
        std::swap(detected_links_, round.detected_links);
        spare_rounds_.push_back(std::move(round));
        arrived = true;
    }
    return arrived;
}

void ReportSensor::match(Report& report) {
    constexpr double degree_rad = std::numbers::pi / 180.0;
    const core::RouteIndex known = roster_.find(report.key)->route;
    const roads::Route route = known.exists() ? roads::Route(roster_.route(known)) : roads::Route();
    traffic::MotionState& state = report.state;
    const auto place = matcher_
                           ->match({.point = {state.x_m, state.y_m},
                                    .heading_rad = state.heading_rad,
                                    .position_sigma_m = report.position_sigma_m,
                                    .heading_sigma_rad = config_.heading_sigma_deg * degree_rad},
                                   route)
                           .value_or(roads::MatchedPlace{});
    state.lane = place.lane;
    state.lane_position_m = place.position_m;
    state.route_edge = place.route_edge;
}

/// Both lists are ordered by key; a new report replaces the old one.
void ReportSensor::merge(const std::vector<Report>& reports) {
    merged_.clear();
    auto old = last_reports_.begin();
    for (const Report& report : reports) {
        while (old != last_reports_.end() && old->key < report.key) {
            merged_.push_back(*old++);
        }
        if (old != last_reports_.end() && old->key == report.key) ++old;
        merged_.push_back(report);
    }
    merged_.insert(merged_.end(), old, last_reports_.end());
    std::swap(merged_, last_reports_);
}

void ReportSensor::register_vehicle(const traffic::Roster& roster, core::VehicleKey key) {
    const traffic::VehicleInfo* info = roster.find(key);
    assert(info != nullptr);  // A roster keeps vehicles that have left.
    const auto [known, is_new] = known_routes_.try_emplace(key);
    if (!is_new && known->second.true_route == info->route) return;
    const bool tells = info->route.exists() && routes_.known(key, info->vehicle_class);
    const core::RouteIndex route =
        tells ? roster_.add_route(roster.route(info->route)) : core::RouteIndex::none();
    known->second = {info->route, route};
    if (is_new) {
        traffic::VehicleInfo own = *info;
        own.route = route;
        roster_.add(std::move(own));
    } else {
        roster_.set_route(key, route);
    }
}

void ReportSensor::register_seen(const traffic::Roster& roster, core::VehicleKey key) {
    if (roster_.find(key) != nullptr) return;
    const traffic::VehicleInfo* info = roster.find(key);
    assert(info != nullptr);  // A roster keeps vehicles that have left.
    traffic::VehicleInfo seen;
    seen.key = info->key;
    seen.id = info->id;
    seen.vehicle_class = info->vehicle_class;
    seen.kind = info->kind;
    seen.length_m = info->length_m;
    seen.width_m = info->width_m;
    roster_.add(std::move(seen));
}

void ReportSensor::drop_gone_and_forgotten(const truth::Snapshot& snapshot) {
    const double oldest_s = snapshot.time.value - config_.forget_after_s;
    auto present = snapshot.key.begin();
    std::erase_if(last_reports_, [&](const Report& report) {
        if (report.measured_s < oldest_s) return true;
        if (config_.exits == failures::Exits::unknown) return false;
        while (present != snapshot.key.end() && *present < report.key) {
            ++present;
        }
        return present == snapshot.key.end() || *present != report.key;
    });
}

void ReportSensor::write(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                         traffic::Observation& observation) {
    observation.time = snapshot.time;
    observation.report_time = core::Seconds(std::max(newest_measured_s_, 0.0));
    observation.exits_known = config_.exits == failures::Exits::known;
    observation.vehicles.clear();
    for (const Report& report : last_reports_) {
        observation.vehicles.push_back(
            {.key = report.key,
             .vehicle_class = report.vehicle_class,
             .freshness = is_fresh(report) ? traffic::Freshness::fresh : traffic::Freshness::stale,
             .age_s = static_cast<float>(snapshot.time.value - report.measured_s),
             .position_sigma_m = report.position_sigma_m,
             .state = report.state});
    }
    write_own_states(snapshot, observation.own_states);
    for (const traffic::ObservedVehicle& own : observation.own_states) {
        register_vehicle(roster, own.key);
    }
    // The identity of a vehicle that never reported is unknown, so its detections are dropped.
    observation.detected_links.clear();
    for (const traffic::DetectedLink& link : detected_links_) {
        if (last_report(link.from) != nullptr && last_report(link.to) != nullptr) {
            observation.detected_links.push_back(link);
        }
    }
    if (config_.signals_known == failures::SignalsKnown::yes) {
        observation.signals = snapshot.signals;
    } else {
        observation.signals.state.assign(snapshot.signals.state.size(), std::string());
    }
    observation.roster = &roster_;
}

const ReportSensor::Report* ReportSensor::last_report(core::VehicleKey key) const {
    const auto found = std::ranges::lower_bound(last_reports_, key, {}, &Report::key);
    return found != last_reports_.end() && found->key == key ? &*found : nullptr;
}

bool ReportSensor::was_detected(core::VehicleKey left, core::VehicleKey right) const {
    // Rounds list detections by (lower key, higher key), in the order of the snapshot's rows.
    return std::ranges::binary_search(
        detected_links_, std::pair(left, right), {}, [](const traffic::DetectedLink& link) {
            return std::pair(std::min(link.from, link.to), std::max(link.from, link.to));
        });
}

void ReportSensor::log_failures(const truth::Snapshot& snapshot, const graph::ProximityGraph& true_graph,
                                FailureLog& log) const {
    log.time = snapshot.time;
    log.dark.clear();
    log.never_seen.clear();
    log.lost_links.clear();
    for (const core::VehicleKey key : snapshot.key) {
        const Report* const report = last_report(key);
        if (report == nullptr) {
            log.never_seen.push_back(key);
        } else if (!is_fresh(*report)) {
            log.dark.push_back(key);
        }
    }
    for (core::VehicleIndex left = 0; left < snapshot.size(); ++left) {
        for (const core::VehicleIndex right : true_graph.neighbours_of(left)) {
            if (right > left) log_link(snapshot.key[left], snapshot.key[right], log);
        }
    }
}

void ReportSensor::log_link(core::VehicleKey left, core::VehicleKey right, FailureLog& log) const {
    const Report* const one = last_report(left);
    const Report* const other = last_report(right);
    if (one == nullptr || other == nullptr) {
        log.lost_links.push_back({left, right, FailureLog::Cause::never_seen});
    } else if ((!is_fresh(*one) || !is_fresh(*other)) && !was_detected(left, right)) {
        log.lost_links.push_back({left, right, FailureLog::Cause::dark});
    }
}

}  // namespace clearway::sensing::detail
