#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "policy/detail/request_table.hpp"
#include "policy/detail/signal_forecast.hpp"
#include "policy/detail/view.hpp"
#include "roads/network.hpp"

namespace clearway::policy::detail {

/// Which vehicles a model sees.
enum class ModelSight : std::uint8_t {
    all,   ///< Those that are believed.
    none,  ///< None: a control, in which an emergency vehicle meets an empty road.
};

/// The edge on the way of an emergency vehicle that ends at the first stop line of an approach (joined
/// junctions have several); nothing where its way no longer passes there.
std::optional<core::EdgeIndex> edge_before(const View& view, const Arrival& arrival);
/// Until the emergency vehicle is at the stop line on a free road, s.
double free_s_to(const View& view, const Arrival& arrival);

/// How long an emergency vehicle and the others take to pass a signal if a hold begins at some time, by point
/// queues (Vickrey 1969): on each lane vehicles arrive at free speed and pass in order, one every saturation
/// headway, while their link is green. It knows who is believed to be on the edges that end at the signal and
/// ahead of the emergency vehicle, and expects as many more behind them.
class QueueModel {
  public:
    class Workspace;
    struct Premises {
        core::EdgeIndex edge;          ///< See `edge_before`.
        double not_before_s = 0.0;     ///< Earliest arrival, by what holds the vehicle up earlier on its way.
        double emergency_worth = 1.0;  ///< Vehicle-seconds that a second of any other one counts.
        ModelSight sight = ModelSight::all;
        double pace = 1.0;  ///< Of those on the way, as a share of the speed on a free road.
    };
    /// Refers to the view's network and fills the workspace, which serves one model at a time; the arrival's
    /// links must not be empty.
    QueueModel(const View& view, const Arrival& arrival, const SignalForecaster& forecaster,
               const Premises& premises, Workspace& workspace);

    /// From now on, s, and vehicle-seconds.
    struct Outcome {
        double passing_s = 0.0;  ///< Until the emergency vehicle is over the stop line, at most `horizon_s`.
        double waited_s = 0.0;   ///< Of the others, until they are or the horizon ends.
    };
    /// If a hold begins after so long; nothing: if none does. No outcome where the emergency vehicle passes
    /// later than `latest_s`.
    std::optional<Outcome> outcome(std::optional<double> start_s, double latest_s) const;
    /// Whenever it passes.
    Outcome outcome(std::optional<double> start_s) const { return *outcome(start_s, never_s); }

    /// How far it looks ahead, s: the longest hold and a cycle or two.
    static constexpr double horizon_s = 180.0;
    /// Later than any passing: a slow start after the horizon is included.
    static constexpr double never_s = 2.0 * horizon_s;

  private:
    /// A piece of the forecast in which a link is green, and since when it is.
    struct Green {
        double to_s = 0.0;
        double since_s = 0.0;
        char letter = 'g';
    };
    struct Greens {
        std::vector<Green> pieces;
        std::uint64_t forecast = 0;  ///< That it belongs to.
    };
    struct Vehicle {
        double earliest_s = 0.0;  ///< At the stop line.
        double distance_m = 0.0;
        std::uint16_t link = 0;
        double weight = 1.0;  ///< Of its waiting.
        bool is_own = false;
    };
    struct Queue {
        core::LaneIndex lane;
        std::vector<Vehicle> vehicles;  ///< Nearest first.
    };

    bool is_near(core::EdgeIndex edge) const;
    void add_queue(core::LaneIndex lane);
    Queue* queue_of(core::LaneIndex lane);
    void add_near(const View& view, const Arrival& arrival);
    void add_ahead(const View& view, const Arrival& arrival);
    void add_own(const Arrival& arrival, double left_m);
    void add_expected(Queue& queue) const;
    double weight_of(const traffic::BelievedVehicle& vehicle) const;
    void place(const traffic::BelievedVehicle& vehicle, double earliest_s,
               std::optional<core::EdgeIndex> next);
    const std::vector<Green>& greens_of(std::uint16_t link) const;
    /// When the own vehicle of a queue passes by the present forecast, if it has it; adds what the others
    /// wait.
    double drain(const Queue& queue, double& waited_s) const;

    const roads::Network& network_;
    const roads::Signal& signal_;
    SignalForecaster forecaster_;
    double emergency_worth_ = 0.0;
    double pace_ = 1.0;
    double arrival_s_ = 0.0;
    double delay_s_ = 0.0;      ///< Of the emergency vehicle on its way to here.
    core::EdgeIndex own_edge_;  ///< On which the emergency vehicle comes.
    Workspace& workspace_;
    std::span<Queue> queues_;
    std::size_t own_queue_ = 0;
};

/// What models allocate, kept from one to the next.
class QueueModel::Workspace {
    friend class QueueModel;
    std::vector<double> green_share_;  ///< By link.
    std::vector<Queue> queues_;        ///< The first ones are the model's.
    std::vector<core::EdgeIndex> edges_;
    SignalForecast forecast_;
    std::uint64_t forecasts_ = 0;
    std::vector<Greens> greens_;  ///< By link.
};

}  // namespace clearway::policy::detail
