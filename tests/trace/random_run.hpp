#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "trace/recording.hpp"
#include "truth/events.hpp"
#include "truth/snapshot.hpp"

namespace clearway::test {

/// A run that no simulator made: vehicles come, go and jump, sensors and beliefs say anything, and numbers
/// include those that compare badly. Every kind of lease, event and link occurs.
class RandomRun {
  public:
    explicit RandomRun(unsigned seed, bool own_roster = true) : draw_(seed), has_own_roster_(own_roster) {}

    /// The next step; valid until the next call.
    trace::RecordedStep next() {
        ++number_;
        change_vehicles();
        fill_snapshot();
        fill_events();
        trace::RecordedStep step{&snapshot_, &roster_, &events_, nullptr, nullptr, {}};
        const bool decides = number_ % 2 == 0;
        if (decides || number_ % 3 == 0) {
            fill_observation();
            step.observation = &observation_;
        }
        if (decides) {
            fill_belief();
            fill_leases();
            step.belief = &belief_;
            step.leases = leases_;
        }
        return step;
    }

    static trace::RecordingInfo info() {
        trace::RecordingInfo info;
        info.key = {"city", "mine", 7};
        info.condition.name = "mine";
        info.condition.failure = "B10";
        info.condition.predictor = "dead_reckoning";
        info.condition.policies = {"dissertation"};
        info.provenance.clearway_version = "0.1.0";
        info.provenance.study_seed = 18446744073709551615U;
        info.settings = {0.25, 0.5, 50.0, std::string(32, 'a')};
        return info;
    }

  private:
    std::uint32_t below(std::uint32_t bound) {
        return std::uniform_int_distribution<std::uint32_t>(0, bound - 1)(draw_);
    }
    float real() {
        switch (below(12)) {
            case 0:
                return -0.0F;
            case 1:
                return std::numeric_limits<float>::infinity();
            case 2:
                return std::numeric_limits<float>::quiet_NaN();
            case 3:
                return std::numeric_limits<float>::denorm_min();
            case 4:
                return -std::numeric_limits<float>::max();
            default:
                return std::uniform_real_distribution<float>(-500.0F, 500.0F)(draw_);
        }
    }
    template <class List>
    const auto& one_of(const List& list) {
        return list[below(static_cast<std::uint32_t>(list.size()))];
    }
    traffic::VehicleInfo new_vehicle(traffic::Roster& roster) {
        traffic::VehicleInfo info;
        info.id = "vehicle, \"" + std::to_string(roster.vehicles().size()) + "\"";
        info.key = core::vehicle_key(info.id);
        info.vehicle_class = static_cast<traffic::VehicleClass>(below(3));
        info.kind = static_cast<traffic::VehicleKind>(below(8));
        info.length_m = real();
        info.speed_factor = real();
        if (below(4) != 0)
            info.route = roster.add_route({core::EdgeIndex{below(5)}, core::EdgeIndex{below(5)}});
        return info;
    }
    void change_vehicles() {
        std::erase_if(on_road_, [&](core::VehicleKey) { return below(10) == 0; });
        for (std::uint32_t count = below(4); count > 0; --count) {
            const traffic::VehicleInfo info = new_vehicle(roster_);
            roster_.add(info);
            on_road_.push_back(info.key);
        }
        std::ranges::sort(on_road_);
        if (!roster_.vehicles().empty() && below(3) == 0)
            roster_.set_route(one_of(roster_.vehicles()).key, roster_.add_route({core::EdgeIndex{below(9)}}));
    }
    void fill_snapshot() {
        snapshot_.time = core::Seconds(snapshot_.time.value + 0.1);
        snapshot_.key = on_road_;
        snapshot_.resize(on_road_.size());
        for (std::size_t row = 0; row < on_road_.size(); ++row) {
            snapshot_.vehicle_class[row] = roster_.find(on_road_[row])->vehicle_class;
            for (std::vector<float>* const column :
                 {&snapshot_.x_m, &snapshot_.y_m, &snapshot_.heading_rad, &snapshot_.speed_mps,
                  &snapshot_.acceleration_mps2, &snapshot_.lane_position_m})
                (*column)[row] = real();
            snapshot_.lane[row] = below(5) == 0 ? core::LaneIndex::none() : core::LaneIndex{below(1000)};
            snapshot_.route_edge[row] = below(100);
        }
        snapshot_.signals.state.resize(3);
        snapshot_.signals.state[below(3)] = std::string(below(5), "Gry"[below(3)]);
    }
    void fill_events() {
        events_.clear();
        events_.time = snapshot_.time;
        for (auto* const keys : {&events_.departed, &events_.arrived, &events_.teleported, &events_.removed})
            for (std::uint32_t count = below(3); count > 0; --count)
                keys->push_back(core::VehicleKey{below(2) == 0 ? 0U : draw_()});
        if (on_road_.empty()) return;
        events_.collisions.push_back({one_of(on_road_), core::VehicleKey{draw_()},
                                      static_cast<truth::CollisionPlace>(below(2)), core::LaneIndex{below(7)},
                                      below(2) == 0});
        events_.emergency_brakings.push_back({one_of(on_road_), real()});
    }
    traffic::MotionState motion() {
        return {real(), real(), real(), real(), core::LaneIndex{below(9)}, real(), below(9)};
    }
    void fill_reports(std::vector<traffic::ObservedVehicle>& reports) {
        reports.clear();
        for (std::uint32_t row = 0; row < snapshot_.size(); ++row) {
            if (below(3) == 0) continue;
            const bool exact = below(2) == 0;
            reports.push_back({snapshot_.key[row], static_cast<traffic::VehicleClass>(below(3)),
                               static_cast<traffic::Freshness>(below(2)), exact ? 0.0F : real(), real(),
                               exact ? snapshot_.motion(row) : motion()});
        }
    }
    void fill_observation() {
        observation_.time = snapshot_.time;
        observation_.is_report = below(2) == 0;
        observation_.exits_known = below(2) == 0;
        observation_.report_time = core::Seconds(real());
        fill_reports(observation_.vehicles);
        fill_reports(observation_.own_states);
        observation_.detected_links.clear();
        for (std::uint32_t count = below(4); count > 0; --count)
            observation_.detected_links.push_back(
                {core::VehicleKey{draw_()}, core::VehicleKey{draw_()}, real(), real()});
        observation_.signals = snapshot_.signals;
        if (below(3) == 0) observation_.signals.state = {"G"};
        if (has_own_roster_ && below(2) == 0) own_roster_.add(new_vehicle(own_roster_));
        for (const auto* const reports : {&observation_.vehicles, &observation_.own_states})
            for (const traffic::ObservedVehicle& report : *reports) {
                traffic::VehicleInfo info = *roster_.find(report.key);
                info.route = core::RouteIndex::none();
                if (has_own_roster_) own_roster_.add(info);
            }
        observation_.roster = has_own_roster_ ? &own_roster_ : &roster_;
    }
    void fill_believed(std::vector<traffic::BelievedVehicle>& vehicles) {
        vehicles.clear();
        for (const core::VehicleKey key : on_road_) {
            if (below(4) != 0)
                vehicles.push_back(
                    {key, static_cast<traffic::VehicleClass>(below(3)), motion(), real(), real()});
        }
    }
    void fill_belief() {
        belief_.time = snapshot_.time;
        fill_believed(belief_.vehicles);
        fill_believed(belief_.own_states);
        belief_.signals = observation_.signals;
        belief_.roster = observation_.roster;
        belief_.links.clear();
        belief_.first_link.assign(1, 0);
        const auto rows = static_cast<std::uint32_t>(belief_.vehicles.size());
        const bool both_ways = below(2) == 0;
        const float distance_m = real();
        for (std::uint32_t left = 0; left < rows; ++left) {
            for (std::uint32_t right = 0; right < rows; ++right) {
                if (both_ways ? (left != right && (left + right) % 3 == 0) : below(3) == 0)
                    belief_.links.push_back(
                        {right, both_ways ? distance_m : real(), both_ways ? 0.75F : real()});
            }
            belief_.first_link.push_back(static_cast<std::uint32_t>(belief_.links.size()));
        }
    }
    void fill_leases() {
        using namespace traffic;
        leases_.clear();
        const core::VehicleKey somebody = on_road_.empty() ? core::VehicleKey{} : one_of(on_road_);
        for (const Action& action :
             {Action(DriveAt{core::MetresPerSecond(real())}), Action(ChangeLane{below(4)}),
              Action(HoldLane{}), Action(PullAside{Side::left}), Action(StopAtLine{}), Action(StandBack{}),
              Action(StandBack{{core::EdgeIndex{8}, core::EdgeIndex{70000}}}),
              Action(TakeRoute{{core::EdgeIndex{3}, core::EdgeIndex{1}}}), Action(HoldGreen{{1, 5, 9}, {5}}),
              Action(AdjustGreen{{}}), Action(PassRed{})}) {
            const std::array<Target, 3> targets = {
                somebody, core::SignalIndex{below(3)},
                Stretch{core::LaneIndex{below(9)}, real(), real(), real(),
                        below(2) == 0 ? Addressed::automated : Addressed::drivers}};
            const Target target = targets[below(3)];
            leases_.push_back({target, action, core::Seconds(real()), static_cast<int>(below(9)) - 4,
                               below(2) == 0 ? "one" : "two", "because", somebody});
        }
    }

    std::mt19937 draw_;
    bool has_own_roster_;
    int number_ = 0;
    std::vector<core::VehicleKey> on_road_;
    truth::Snapshot snapshot_;
    traffic::Roster roster_, own_roster_;
    truth::Events events_;
    traffic::Observation observation_;
    traffic::BelievedGraph belief_;
    std::vector<traffic::Lease> leases_;
};

}  // namespace clearway::test
