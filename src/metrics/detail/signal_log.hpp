#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "metrics/road_layout.hpp"
#include "metrics/signal_event.hpp"
#include "traffic/signal_status.hpp"
#include "truth/snapshot.hpp"

namespace clearway::metrics::detail {

/// Writes the event log of signals while they are asked for: from a request on, with the latest change of
/// each link before it, until nobody asks and the signal's program is seen again and in step. The last line
/// of each such time is SignalCode::coordination with 0 or 1, while no call is on. Outside of these times a
/// city's signals would fill the log with greens that nobody changed.
///
/// A change is noted at the step at which it is seen. Costs a comparison of states for each signal and step.
class SignalLog {
  public:
    /// The layout outlives the log.
    explicit SignalLog(const RoadLayout& layout);

    /// One step, with the signals that are asked for, ordered by index.
    void step(const truth::Snapshot& snapshot, std::span<const traffic::SignalStatus> asked);
    /// By time, then signal.
    std::vector<SignalEvent> events() const;

  private:
    enum class Colour : std::uint8_t { unknown, green, yellow, red };
    struct Head {
        Colour colour = Colour::unknown;
        double since_s = 0.0;
        bool known_since = false;  ///< The change was seen.
        bool clearing = false;     ///< Red, and nothing that conflicts has opened since.
    };
    /// A request, by who asks and for which approach.
    using CallKey = std::pair<core::VehicleKey, std::uint32_t>;
    struct Call {
        std::vector<std::uint16_t> links;
        bool is_on = false;
        bool entered = false;
        bool dwells = false;
    };
    struct Watched {
        std::string shown;
        std::vector<Head> heads;
        bool open = false;
        traffic::SignalStage stage = traffic::SignalStage::program;
        traffic::Coordination coordination = traffic::Coordination::none;
        bool capped = false;
        bool leaves = false;              ///< On the way back.
        bool settled = false;             ///< At the step before: nobody asks, and the program runs, in step.
        bool owes_word = false;           ///< That the program runs again has not been written.
        double closed_s = -1e9;           ///< When the log of this signal was last interrupted.
        std::vector<std::uint16_t> held;  ///< Last held.
        std::map<CallKey, Call> calls;
    };
    struct Row {
        double time_s = 0.0;
        std::uint32_t signal = 0;
        SignalCode code{};
        std::uint32_t parameter = 0;
        std::vector<std::uint16_t> links;
        core::VehicleKey vehicle;
    };

    void look(std::uint32_t signal, const std::string& state, double now_s);
    void end_clearances(std::uint32_t signal, const std::vector<std::uint16_t>& changed, double now_s);
    void note_heads(std::uint32_t signal, const std::vector<std::uint16_t>& links);
    void open(std::uint32_t signal);
    void follow(const traffic::SignalStatus& status, double now_s);
    void follow_calls(const traffic::SignalStatus& status, double now_s);
    void settle(std::uint32_t signal, bool is_settled, bool is_seen, double now_s);
    void close(std::uint32_t signal, double now_s);
    void note_passages(const truth::Snapshot& snapshot);
    std::uint32_t approach_of(std::uint32_t signal, const std::vector<std::uint16_t>& links) const;

    const RoadLayout& layout_;
    std::vector<Watched> signals_;
    std::vector<core::LaneIndex> lane_;  ///< By route: where its vehicle was at the step before.
    std::vector<Row> rows_;
};

}  // namespace clearway::metrics::detail
