#include "analysis/signal_audit.hpp"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::analysis {
namespace {

using metrics::SignalCode;
using metrics::SignalEvent;

/// A link in the course of the log.
struct Light {
    std::optional<double> green_s;   ///< Since when it is green, if the log says so.
    std::optional<double> yellow_s;  ///< Likewise.
    std::optional<double> red_s;     ///< Since when it is red without a conflicting link having opened.
};

std::vector<std::uint16_t> links_of(const SignalEvent& event, std::size_t count) {
    std::vector<std::uint16_t> links;
    const char* at = event.links.data();
    const char* const end = at + event.links.size();
    while (at != end) {
        std::uint16_t link = 0;
        const auto [next, error] = std::from_chars(at, end, link);
        if (error != std::errc() || link >= count)
            throw core::InputError(
                {fmt::format("event at {} s of signal {}", event.time_s, event.signal),
                 fmt::format("links \"{}\" are not those of the network", event.links),
                 count == 0 ? "none" : fmt::format("0 to {}", count - 1),
                 "The log belongs to another network: repeat the command that made the study"});
        links.push_back(link);
        at = next;
        while (at != end && *at == ' ')
            ++at;
    }
    return links;
}

bool opens(const SignalEvent& event) {
    const auto code = static_cast<SignalCode>(event.event);
    return code == SignalCode::begin_green || code == SignalCode::begin_walk;
}

class Auditor {
  public:
    Auditor(const std::map<std::string, SignalLimits>& limits, double step_s)
        : limits_(limits), step_s_(step_s) {}

    void read(const SignalEvent& event) {
        const auto code = static_cast<SignalCode>(event.event);
        if (event.event > static_cast<std::uint32_t>(SignalCode::begin_dont_walk)) return;
        const auto found = limits_.find(event.signal);
        if (found == limits_.end())
            throw core::InputError({fmt::format("event at {} s", event.time_s),
                                    fmt::format("there is no signal \"{}\" in the network", event.signal), "",
                                    "The log belongs to another network: repeat the command that made the "
                                    "study"});
        const SignalLimits& owed = found->second;
        std::vector<Light>& lights = lights_[event.signal];
        lights.resize(owed.foes.size());
        for (const std::uint16_t link : links_of(event, owed.foes.size())) {
            Light& light = lights[link];
            const Where where{event, link};
            if (code == SignalCode::begin_green || code == SignalCode::begin_walk) {
                open(where, owed, lights);
            } else if (code == SignalCode::begin_yellow) {
                end_green(where, owed, light);
                light = {std::nullopt, event.time_s, std::nullopt};
            } else if (code == SignalCode::begin_red_clearance || code == SignalCode::begin_dont_walk) {
                end_green(where, owed, light);
                if (light.yellow_s)
                    check(where, Shortfall::yellow, *light.yellow_s, owed.yellow_s[link]);
                else if (light.green_s && code == SignalCode::begin_red_clearance)
                    check(where, Shortfall::yellow, event.time_s, owed.yellow_s[link]);
                light = {std::nullopt, std::nullopt, event.time_s};
            }
        }
    }
    /// While no call is on, a line about the program being back interrupts the log of the signal.
    void follow(const SignalEvent& event) {
        const auto code = static_cast<SignalCode>(event.event);
        int& calls = calls_[event.signal];
        if (code == SignalCode::call_on) ++calls;
        if (code == SignalCode::call_off) --calls;
        if (code == SignalCode::coordination && event.parameter < 2 && calls == 0)
            lights_.erase(event.signal);
    }
    SignalAudit take() { return std::move(audit_); }

  private:
    struct Where {
        const SignalEvent& event;
        std::uint16_t link;
    };

    void end_green(const Where& where, const SignalLimits& owed, const Light& light) {
        if (light.green_s) check(where, Shortfall::green, *light.green_s, owed.green_s[where.link]);
    }
    /// A link gets green: those that conflict with it must have been red for long enough.
    void open(const Where& where, const SignalLimits& owed, std::vector<Light>& lights) {
        for (std::size_t other = 0; other < lights.size(); ++other) {
            if (!owed.foes[where.link][other] || !lights[other].red_s) continue;
            check({where.event, static_cast<std::uint16_t>(other)}, Shortfall::red_clearance,
                  *lights[other].red_s, owed.red_s[other]);
            lights[other].red_s.reset();
        }
        lights[where.link] = {where.event.time_s, std::nullopt, std::nullopt};
    }
    void check(const Where& where, Shortfall what, double since_s, const std::optional<double>& least_s) {
        if (!least_s) return;
        ++(what == Shortfall::yellow          ? audit_.yellows
           : what == Shortfall::red_clearance ? audit_.reds
                                              : audit_.greens);
        constexpr double rounding_s = 1e-3;
        const double in_steps_s = std::floor(*least_s / step_s_ + rounding_s) * step_s_;
        const double lasted_s = where.event.time_s - since_s;
        if (lasted_s >= in_steps_s - rounding_s) return;
        audit_.findings.push_back(
            {where.event.signal, where.link, what, where.event.time_s, lasted_s, *least_s});
    }

    const std::map<std::string, SignalLimits>& limits_;
    double step_s_;
    std::map<std::string, std::vector<Light>> lights_;
    std::map<std::string, int> calls_;
    SignalAudit audit_;
};

}  // namespace

SignalAudit audit_signals(std::span<const SignalEvent> events,
                          const std::map<std::string, SignalLimits>& limits, double step_s) {
    Auditor auditor(limits, step_s);
    // At one time, whatever ends comes before whatever opens.
    for (auto first = events.begin(); first != events.end();) {
        auto last = first;
        while (last != events.end() && last->time_s == first->time_s && last->signal == first->signal)
            ++last;
        for (const bool opening : {false, true})
            for (auto event = first; event != last; ++event)
                if (opens(*event) == opening) auditor.read(*event);
        for (; first != last; ++first)
            auditor.follow(*first);
    }
    return auditor.take();
}

}  // namespace clearway::analysis
