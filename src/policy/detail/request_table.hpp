#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "policy/detail/approach.hpp"
#include "policy/detail/view.hpp"
#include "policy/request_memory.hpp"
#include "policy/signal_messages.hpp"

namespace clearway::policy::detail {

/// An emergency vehicle that comes to a signal, as that signal knows or believes it.
struct Arrival {
    traffic::BelievedVehicle emergency;  ///< At the place from which it is counted.
    Approach approach;                   ///< With the distance from that place.
    int number = 0;                      ///< Of this signal among those ahead of that place, from 1.
    double moved_m = 0.0;                ///< Driven since, along the route.
    std::optional<double> announced_s;   ///< Until its arrival, as it announced it itself.
};

/// The requests that are open at all signals, fed by messages alone. Each signal has its own entry of a
/// vehicle, so that signals which heard different messages believe different things of it. A request ends
/// when it is cancelled, when the vehicle is seen or believed behind the stop line, and as
/// RequestMemorySettings say; a message that was sent later opens it again. The queue and the signals between
/// the vehicle and the stop line are those of the believed graph, as the signal knows them.
class RequestTable {
  public:
    /// How far ahead stop lines are looked for, and which vehicles stand.
    struct Reach {
        double horizon_m = 0.0;
        double halted_mps = 0.0;
    };
    RequestTable(RequestMemorySettings settings, Reach reach) : settings_(settings), reach_(reach) {}

    /// Takes the messages that have come, brings every request to the time of the belief and ends those that
    /// are over. Times never go back.
    void update(const View& view, std::span<const traffic::PriorityRequest> messages);
    /// Open requests, by vehicle and then nearest signal first.
    std::vector<Arrival> arrivals(core::Seconds now) const;
    std::vector<RequestKey> open() const;

  private:
    struct Entry {
        traffic::PriorityRequest message;    ///< The newest that came.
        double heard_s = 0.0;                ///< When it came.
        traffic::BelievedVehicle emergency;  ///< At the place that was last heard or seen.
        double measured_s = 0.0;             ///< When the message or report was made that it rests on.
        bool is_seen = false;                ///< Whether that place is from the believed graph.
        double reckoned_s = 0.0;             ///< Up to when `moved_m` is reckoned.
        double moved_m = 0.0;
        std::vector<Approach> ahead;        ///< Of that place.
        std::optional<double> at_line_s{};  ///< Since when it is believed to be at the open stop line.
        bool is_open = true;
    };

    void take(const View& view, const traffic::PriorityRequest& message);
    void place(const View& view, Entry& entry, const traffic::BelievedVehicle& emergency,
               double measured_s) const;
    /// Looks for the vehicle in the believed graph. Closes the entry if it has passed.
    void look(const View& view, Entry& entry) const;
    void reckon(const View& view, Entry& entry) const;
    bool is_over(const Entry& entry, double now_s) const;
    bool reckons() const {
        return settings_.memory == RequestMemory::dead_reckon || settings_.memory == RequestMemory::graph;
    }

    RequestMemorySettings settings_;
    Reach reach_;
    std::map<RequestKey, Entry> entries_;
};

}  // namespace clearway::policy::detail
