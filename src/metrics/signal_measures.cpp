#include "metrics/signal_measures.hpp"

#include <map>
#include <utility>

#include "metrics/detail/mean.hpp"

namespace clearway::metrics {
namespace {

using detail::Mean;

struct Sums {
    SignalMeasures counts;
    Mean entry_delay_s, time_to_service_s, dwell_s, recovery_s;

    void add(const Sums& other) {
        counts.calls += other.counts.calls;
        counts.granted += other.counts.granted;
        counts.useless_holds += other.counts.useless_holds;
        counts.capped += other.counts.capped;
        entry_delay_s.add(other.entry_delay_s);
        time_to_service_s.add(other.time_to_service_s);
        dwell_s.add(other.dwell_s);
        recovery_s.add(other.recovery_s);
    }
    SignalMeasures measures() const {
        SignalMeasures all = counts;
        all.entry_delay_s = entry_delay_s.value();
        all.time_to_service_s = time_to_service_s.value();
        all.dwell_s = dwell_s.value();
        all.recovery_s = recovery_s.value();
        return all;
    }
};

/// A call while it is on.
struct Call {
    double since_s = 0.0;
    bool has_entered = false;
    bool was_granted = false;
    bool has_passed = false;
    std::optional<double> dwells_since_s = {};
};

/// One signal in the course of the log.
class Reader {
  public:
    void read(const SignalEvent& event) {
        const Key key{event.vehicle, event.parameter};
        switch (static_cast<SignalCode>(event.event)) {
            case SignalCode::call_on:
                ++sums_.counts.calls;
                calls_[key] = {event.time_s};
                break;
            case SignalCode::entry_started:
                enter(calls_[key], event.time_s);
                break;
            case SignalCode::begin_dwell:
                dwell(calls_[key], event.time_s);
                break;
            case SignalCode::detector_on:
                for (auto& [owner, call] : calls_)
                    if (owner.first == event.vehicle) call.has_passed = true;
                break;
            case SignalCode::call_off:
                end_hold(calls_[key], event.time_s);
                calls_.erase(key);
                break;
            case SignalCode::begin_exit:
                for (auto& [owner, call] : calls_)
                    end_hold(call, event.time_s);
                exit_s_ = event.time_s;
                break;
            case SignalCode::max_presence_exceeded:
                ++sums_.counts.capped;
                break;
            case SignalCode::coordination:
                if (exit_s_ && event.parameter < 2)
                    sums_.recovery_s.add(event.time_s - *std::exchange(exit_s_, std::nullopt));
                break;
            default:
                break;
        }
    }
    const Sums& sums() const { return sums_; }

  private:
    using Key = std::pair<std::string, std::uint32_t>;

    void enter(Call& call, double now_s) {
        if (!call.has_entered) sums_.entry_delay_s.add(now_s - call.since_s);
        call.has_entered = true;
        exit_s_.reset();
    }
    void dwell(Call& call, double now_s) {
        if (!call.was_granted) {
            ++sums_.counts.granted;
            sums_.time_to_service_s.add(now_s - call.since_s);
        }
        call.was_granted = true;
        call.dwells_since_s = now_s;
    }
    void end_hold(Call& call, double now_s) {
        if (!call.dwells_since_s) return;
        if (!call.has_passed) ++sums_.counts.useless_holds;
        sums_.dwell_s.add(now_s - *call.dwells_since_s);
        call.dwells_since_s.reset();
    }

    std::map<Key, Call> calls_;
    std::optional<double> exit_s_;  ///< When a hold ended whose signal is not back yet.
    Sums sums_;
};

}  // namespace

std::vector<SignalMeasures> signal_measures(std::span<const SignalEvent> events) {
    std::map<std::string, Reader> readers;
    for (const SignalEvent& event : events)
        readers[event.signal].read(event);
    std::vector<SignalMeasures> measures;
    Sums all;
    for (const auto& [signal, reader] : readers) {
        all.add(reader.sums());
        measures.push_back(reader.sums().measures());
        measures.back().signal = signal;
    }
    if (!measures.empty()) measures.push_back(all.measures());
    return measures;
}

}  // namespace clearway::metrics
