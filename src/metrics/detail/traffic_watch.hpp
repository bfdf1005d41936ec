#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "metrics/road_layout.hpp"
#include "metrics/traffic_tables.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics::detail {

/// Collects TrafficTables step by step. Time per step is linear in the vehicles on the road; memory grows
/// with simulated time, not with the number of steps.
class TrafficWatch {
  public:
    /// The layout outlives the watch.
    explicit TrafficWatch(const RoadLayout& layout);

    /// One step; the roster knows the way of each vehicle, `before` the row that it had at the step before
    /// (core/match_rows.hpp). The first step only sets the clock.
    void step(const truth::Snapshot& snapshot, const traffic::Roster& roster,
              const std::vector<std::uint32_t>& before);
    TrafficTables tables() const;

  private:
    /// What a vehicle class lost on an approach.
    struct Loss {
        std::uint64_t vehicles = 0;
        std::uint64_t of_demand = 0;  ///< Vehicles that entered while demand departed.
        double waiting_time_s = 0.0;
        double time_loss_s = 0.0;
    };
    struct Passage {
        double time_s = 0.0;
        std::int32_t approach = 0;
    };
    struct Place {
        double time_s = 0.0;
        double distance_m = 0.0;
    };
    struct SignalChange {
        double time_s = 0.0;
        std::uint32_t signal = 0;  ///< In WatchedRoute::signals.
        char shown = 'r';          ///< g, y or r.
    };
    struct Journey {
        core::RouteIndex way;
        std::uint32_t route_edge = 0;
        bool seen = false;
        bool passed = false;            ///< It left `route_edge` and is crossing the junction.
        std::vector<double> entered_s;  ///< By position in the route; negative where it was not seen.
        double last_s = 0.0;            ///< When it was last seen.
        std::vector<Place> places;
        std::vector<SignalChange> changes;
        std::vector<char> shown;  ///< Last state of each signal on the route.
    };

    void count_vehicles(const truth::Snapshot& snapshot, const std::vector<std::uint32_t>& before,
                        double elapsed_s);
    void sample_halted(double time_s);
    void follow(const truth::Snapshot& snapshot, const traffic::Roster& roster);
    /// Takes another way where the vehicle did. What was driven is the beginning of both.
    void follow_way(const traffic::Roster& roster, WatchedRoute& route, Journey& journey) const;
    void follow(const truth::Snapshot& snapshot, std::size_t row, const WatchedRoute& route,
                Journey& journey);
    /// Notes, once, that a vehicle leaves an approach, whether or not it is seen on the lanes across the
    /// junction.
    void pass(double now_s, std::uint32_t edge, bool inside, const WatchedRoute& route, Journey& journey);
    std::vector<RecoveryRow> recovery() const;
    std::vector<JourneyRow> journeys() const;
    std::vector<EdgeTimeRow> edge_times() const;
    double others_halted(const Passage& passage, std::size_t sample) const;

    const RoadLayout& layout_;
    std::vector<WatchedRoute> routes_;         ///< As they are driven.
    std::vector<std::array<Loss, 2>> losses_;  ///< By approach; human, automated.
    std::vector<std::uint32_t> halted_;        ///< By approach, now.
    std::vector<std::vector<std::uint32_t>> samples_;
    double first_sample_s_ = 0.0;
    std::vector<Passage> passages_;
    std::vector<Journey> journeys_;  ///< By route.
    double first_s_ = -1.0;
    double last_s_ = -1.0;
    std::vector<std::int32_t> previous_approach_;  ///< By row of the step before.
    std::vector<std::int32_t> approach_;
};

}  // namespace clearway::metrics::detail
