#include "metrics/detail/signal_log.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "metrics/detail/signal_ways.hpp"
#include "traffic/signal.hpp"

namespace clearway::metrics::detail {
namespace {

using traffic::Coordination;
using traffic::SignalStage;

bool is_part_of(const std::vector<std::uint16_t>& links, const std::vector<std::uint16_t>& held) {
    return !links.empty() && std::ranges::includes(held, links);
}

std::uint32_t parameter_of(Coordination coordination) {
    return coordination == Coordination::none ? 0 : coordination == Coordination::in_step ? 1 : 2;
}

}  // namespace

SignalLog::SignalLog(const RoadLayout& layout)
    : layout_(layout), signals_(layout.signals.size()), lane_(layout.routes.size()) {}

void SignalLog::step(const truth::Snapshot& snapshot, std::span<const traffic::SignalStatus> asked) {
    assert(std::ranges::is_sorted(asked, {}, &traffic::SignalStatus::signal));
    const double now_s = snapshot.time.value;
    auto status = asked.begin();
    for (std::uint32_t signal = 0; signal < signals_.size(); ++signal) {
        if (signal < snapshot.signals.state.size()) look(signal, snapshot.signals.state[signal], now_s);
        while (status != asked.end() && status->signal.value < signal)
            ++status;
        if (status != asked.end() && status->signal.value == signal)
            follow(*status, now_s);
        else if (signals_[signal].open)
            close(signal, now_s);
    }
    note_passages(snapshot);
}

void SignalLog::look(std::uint32_t signal, const std::string& state, double now_s) {
    Watched& watched = signals_[signal];
    if (state == watched.shown || signal >= layout_.signal_heads.size()) return;
    const bool is_first = watched.heads.empty();
    watched.shown = state;
    const std::size_t count = std::min(state.size(), layout_.signal_heads[signal].size());
    watched.heads.resize(count);
    std::vector<std::uint16_t> changed;
    for (std::size_t link = 0; link < count; ++link) {
        const char letter = state[link];
        const Colour colour = traffic::is_green(letter)    ? Colour::green
                              : traffic::is_yellow(letter) ? Colour::yellow
                                                           : Colour::red;
        Head& head = watched.heads[link];
        if (head.colour == colour) continue;
        head = {colour, now_s, !is_first, colour == Colour::red && !is_first};
        changed.push_back(static_cast<std::uint16_t>(link));
    }
    if (watched.open) end_clearances(signal, changed, now_s);
    if (watched.open) note_heads(signal, changed);
}

void SignalLog::end_clearances(std::uint32_t signal, const std::vector<std::uint16_t>& changed,
                               double now_s) {
    Watched& watched = signals_[signal];
    for (const std::uint16_t opened : changed) {
        if (watched.heads[opened].colour != Colour::green) continue;
        for (const std::uint16_t foe : layout_.signal_heads[signal][opened].foes) {
            if (foe >= watched.heads.size() || !watched.heads[foe].clearing) continue;
            watched.heads[foe].clearing = false;
            const SignalHead& head = layout_.signal_heads[signal][foe];
            if (!head.on_foot)
                rows_.push_back({now_s, signal, SignalCode::end_red_clearance, head.phase, {foe}, {}});
        }
    }
}

/// A row for each group of links that changed to one colour at one time.
void SignalLog::note_heads(std::uint32_t signal, const std::vector<std::uint16_t>& links) {
    assert(signal < layout_.signal_heads.size() || links.empty());
    const Watched& watched = signals_[signal];
    const std::size_t first = rows_.size();
    for (const std::uint16_t link : links) {
        const Head& head = watched.heads[link];
        const SignalHead& place = layout_.signal_heads[signal][link];
        const bool is_told = head.since_s <= watched.closed_s;  // before the log was interrupted
        if (!head.known_since || place.phase == 0 || is_told) continue;
        const bool is_green = head.colour == Colour::green;
        SignalCode code = is_green                        ? SignalCode::begin_green
                          : head.colour == Colour::yellow ? SignalCode::begin_yellow
                                                          : SignalCode::begin_red_clearance;
        if (place.on_foot) code = is_green ? SignalCode::begin_walk : SignalCode::begin_dont_walk;
        const auto same = std::find_if(
            rows_.begin() + static_cast<std::ptrdiff_t>(first), rows_.end(), [&](const Row& row) {
                return row.code == code && row.parameter == place.phase && row.time_s == head.since_s;
            });
        if (same != rows_.end())
            same->links.push_back(link);
        else
            rows_.push_back({head.since_s, signal, code, place.phase, {link}, {}});
    }
}

void SignalLog::open(std::uint32_t signal) {
    Watched& watched = signals_[signal];
    assert(!watched.open && watched.calls.empty());
    watched.open = true;
    std::vector<std::uint16_t> all(watched.heads.size());
    std::iota(all.begin(), all.end(), 0);
    note_heads(signal, all);
}

std::uint32_t SignalLog::approach_of(std::uint32_t signal, const std::vector<std::uint16_t>& links) const {
    if (signal >= layout_.signal_heads.size()) return 0;
    for (const std::uint16_t link : links) {
        if (link < layout_.signal_heads[signal].size() && layout_.signal_heads[signal][link].approach > 0)
            return layout_.signal_heads[signal][link].approach;
    }
    return 0;
}

void SignalLog::follow(const traffic::SignalStatus& status, double now_s) {
    const std::uint32_t signal = status.signal.value;
    Watched& watched = signals_[signal];
    if (!watched.open) {
        if (status.calls.empty() && status.stage == SignalStage::program) return;
        open(signal);
        watched.coordination = status.coordination;
    }
    follow_calls(status, now_s);
    const auto note = [&](SignalCode code) {
        rows_.push_back({now_s, signal, code, approach_of(signal, watched.held), watched.held, {}});
    };
    if (status.capped && !watched.capped) note(SignalCode::max_presence_exceeded);
    const bool was_away = watched.stage != SignalStage::program;
    const bool is_away = status.stage != SignalStage::program;
    if (was_away && status.held.empty() && !watched.leaves) note(SignalCode::begin_exit);
    watched.leaves = is_away && status.held.empty();
    if (!status.held.empty()) watched.held = status.held;
    watched.owes_word = watched.owes_word || is_away || status.coordination != watched.coordination;
    watched.stage = status.stage;
    watched.capped = status.capped;
    watched.coordination = status.coordination;
    settle(signal, !is_away && status.calls.empty() && status.coordination != Coordination::out_of_step,
           !is_away && !was_away, now_s);
}

/// What a program shows after it was restored is seen one step later; only then does the log say so, and end.
void SignalLog::settle(std::uint32_t signal, bool is_settled, bool is_seen, double now_s) {
    assert(signals_[signal].open);
    Watched& watched = signals_[signal];
    if (is_seen && is_settled && watched.settled) return close(signal, now_s);
    watched.settled = is_settled;
    if (!is_seen || is_settled || !watched.owes_word) return;
    rows_.push_back({now_s, signal, SignalCode::coordination, parameter_of(watched.coordination), {}, {}});
    watched.owes_word = false;
}

void SignalLog::follow_calls(const traffic::SignalStatus& status, double now_s) {
    const std::uint32_t signal = status.signal.value;
    Watched& watched = signals_[signal];
    for (auto& [key, call] : watched.calls)
        call.is_on = false;
    const auto note = [&](SignalCode code, const CallKey& key, const Call& call) {
        rows_.push_back({now_s, signal, code, key.second, call.links, key.first});
    };
    for (const traffic::SignalCall& asked : status.calls) {
        const CallKey key{asked.emergency, approach_of(signal, asked.links)};
        const auto [place, is_new] = watched.calls.try_emplace(key);
        place->second.is_on = true;
        if (place->second.links != asked.links) place->second.links = asked.links;
        if (is_new) note(SignalCode::call_on, key, place->second);
    }
    for (auto& [key, call] : watched.calls) {
        const bool is_held = status.stage != SignalStage::program && is_part_of(call.links, status.held);
        if (is_held && !call.entered) note(SignalCode::entry_started, key, call);
        call.entered = is_held;
        const bool dwells = is_held && (call.dwells || status.stage == SignalStage::dwell);
        if (dwells && !call.dwells) note(SignalCode::begin_dwell, key, call);
        call.dwells = dwells;
    }
    for (auto call = watched.calls.begin(); call != watched.calls.end();) {
        if (!call->second.is_on) note(SignalCode::call_off, call->first, call->second);
        call = call->second.is_on ? std::next(call) : watched.calls.erase(call);
    }
}

void SignalLog::close(std::uint32_t signal, double now_s) {
    traffic::SignalStatus nothing;
    nothing.signal = core::SignalIndex{signal};
    follow_calls(nothing, now_s);
    Watched& watched = signals_[signal];
    const auto last = watched.coordination == Coordination::none ? Coordination::none : Coordination::in_step;
    rows_.push_back({now_s, signal, SignalCode::coordination, parameter_of(last), {}, {}});
    Watched closed;
    closed.shown = std::move(watched.shown);
    closed.heads = std::move(watched.heads);
    closed.closed_s = now_s;
    watched = std::move(closed);
}

void SignalLog::note_passages(const truth::Snapshot& snapshot) {
    for (std::size_t route = 0; route < layout_.routes.size(); ++route) {
        const core::VehicleKey vehicle = layout_.routes[route].vehicle;
        const auto row = snapshot.row_of(vehicle);
        const core::LaneIndex before = lane_[route];
        lane_[route] = row ? snapshot.lane[*row] : core::LaneIndex::none();
        if (!row || before == lane_[route] || !before.exists()) continue;
        const SignalWay* const way = signal_way(layout_, before, lane_[route]);
        if (way == nullptr || way->signal.value >= signals_.size() || !signals_[way->signal.value].open)
            continue;
        rows_.push_back({snapshot.time.value,
                         way->signal.value,
                         SignalCode::detector_on,
                         approach_of(way->signal.value, {way->link}),
                         {way->link},
                         vehicle});
    }
}

std::vector<SignalEvent> SignalLog::events() const {
    std::vector<Row> rows = rows_;
    std::ranges::stable_sort(rows, {}, [](const Row& row) { return std::pair(row.time_s, row.signal); });
    std::vector<SignalEvent> events;
    for (const Row& row : rows) {
        const auto route = std::ranges::find(layout_.routes, row.vehicle, &WatchedRoute::vehicle);
        events.push_back({row.time_s, layout_.signals[row.signal], static_cast<std::uint32_t>(row.code),
                          row.parameter, fmt::format("{}", fmt::join(row.links, " ")),
                          route == layout_.routes.end() ? "" : route->id});
    }
    return events;
}

}  // namespace clearway::metrics::detail
