#include "analysis/signal_audit.hpp"

#include <algorithm>
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
    bool on_foot = false;            ///< Its last green was a walk.
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
                light = {std::nullopt, event.time_s, std::nullopt, light.on_foot};
            } else if (code == SignalCode::begin_red_clearance || code == SignalCode::begin_dont_walk) {
                end_green(where, owed, light);
                if (light.yellow_s)
                    check(where, Shortfall::yellow, *light.yellow_s, owed.yellow_s[link]);
                else if (light.green_s && code == SignalCode::begin_red_clearance)
                    check(where, Shortfall::yellow, event.time_s, owed.yellow_s[link]);
                light = {std::nullopt, std::nullopt, event.time_s, code == SignalCode::begin_dont_walk};
            }
        }
    }
    /// Links that get green at one time need no clearance from each other: where two conflict, one yields.
    /// Call before the events of that time are read.
    void open_together(const SignalEvent& event) {
        const auto found = lights_.find(event.signal);
        if (found == lights_.end()) return;
        for (const std::uint16_t link : links_of(event, found->second.size()))
            found->second[link].red_s.reset();
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
    SignalAudit take() {
        for (const auto& [signal, all] : early_)
            for (const Early& early : all)
                audit_.findings.push_back(early.finding);
        std::ranges::stable_sort(audit_.findings, {}, &SignalFinding::ended_s);
        return std::move(audit_);
    }

  private:
    struct Where {
        const SignalEvent& event;
        std::uint16_t link;
    };
    /// A link that got green before those on foot had cleared.
    struct Early {
        std::uint16_t opened;
        SignalFinding finding;
    };

    void end_green(const Where& where, const SignalLimits& owed, const Light& light) {
        if (light.green_s) check(where, Shortfall::green, *light.green_s, owed.green_s[where.link]);
    }
    /// A link gets green: those that conflict with it must have been red for long enough.
    void open(const Where& where, const SignalLimits& owed, std::vector<Light>& lights) {
        for (std::size_t other = 0; other < lights.size(); ++other) {
            Light& light = lights[other];
            if (!owed.foes[where.link][other] || !light.red_s) continue;
            const auto shortfall = judge({where.event, static_cast<std::uint16_t>(other)},
                                         Shortfall::red_clearance, *light.red_s, owed.red_s[other]);
            light.red_s.reset();
            if (!shortfall) continue;
            if (light.on_foot)
                early_[where.event.signal].push_back({where.link, *shortfall});
            else
                audit_.findings.push_back(*shortfall);
        }
        const bool on_foot = static_cast<SignalCode>(where.event.event) == SignalCode::begin_walk;
        if (on_foot) excuse(where, lights);
        lights[where.link] = {where.event.time_s, std::nullopt, std::nullopt, on_foot};
    }
    /// Who walks again while the other still goes shares the green with it: the other one yields.
    void excuse(const Where& where, const std::vector<Light>& lights) {
        std::erase_if(early_[where.event.signal], [&](const Early& early) {
            const std::optional<double>& green_s = lights[early.opened].green_s;
            return early.finding.link == where.link && green_s && *green_s <= early.finding.ended_s;
        });
    }
    void check(const Where& where, Shortfall what, double since_s, const std::optional<double>& least_s) {
        if (const auto shortfall = judge(where, what, since_s, least_s))
            audit_.findings.push_back(*shortfall);
    }
    std::optional<SignalFinding> judge(const Where& where, Shortfall what, double since_s,
                                       const std::optional<double>& least_s) {
        if (!least_s) return std::nullopt;
        ++(what == Shortfall::yellow          ? audit_.yellows
           : what == Shortfall::red_clearance ? audit_.reds
                                              : audit_.greens);
        constexpr double rounding_s = 1e-3;
        const double in_steps_s = std::floor(*least_s / step_s_ + rounding_s) * step_s_;
        const double lasted_s = where.event.time_s - since_s;
        if (lasted_s >= in_steps_s - rounding_s) return std::nullopt;
        return SignalFinding{where.event.signal, where.link, what, where.event.time_s, lasted_s, *least_s};
    }

    const std::map<std::string, SignalLimits>& limits_;
    double step_s_;
    std::map<std::string, std::vector<Light>> lights_;
    std::map<std::string, int> calls_;
    std::map<std::string, std::vector<Early>> early_;  ///< By signal.
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
        for (auto event = first; event != last; ++event)
            if (opens(*event)) auditor.open_together(*event);
        for (const bool opening : {false, true})
            for (auto event = first; event != last; ++event)
                if (opens(*event) == opening) auditor.read(*event);
        for (; first != last; ++first)
            auditor.follow(*first);
    }
    return auditor.take();
}

}  // namespace clearway::analysis
