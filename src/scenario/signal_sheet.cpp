#include "scenario/signal_sheet.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "roads/own_clearance.hpp"
#include "traffic/signal.hpp"

namespace clearway::scenario {
namespace {

void include(std::optional<SecondsRange>& times, double time_s) {
    if (time_s <= 0.0) return;
    if (!times) times = SecondsRange{time_s, time_s};
    times->shortest_s = std::min(times->shortest_s, time_s);
    times->longest_s = std::max(times->longest_s, time_s);
}

bool is_crossing(const roads::Signal& signal, std::size_t link) {
    return link < signal.crossings.size() && signal.crossings[link];
}

/// In the order of the links.
std::vector<SignalApproach> approaches_of(const roads::Network& network, const roads::Signal& signal) {
    std::vector<SignalApproach> approaches;
    std::map<std::string, std::size_t> rows;
    for (std::size_t link = 0; link < signal.links.size(); ++link) {
        if (is_crossing(signal, link)) continue;
        for (const roads::SignalLink& way : signal.links[link]) {
            const roads::Edge& edge = network.edge(network.lane(way.from).edge);
            const auto [row, is_new] = rows.emplace(edge.id, approaches.size());
            if (is_new) approaches.push_back({edge.id, edge.name, {}});
            std::vector<std::uint16_t>& links = approaches[row->second].links;
            if (links.empty() || links.back() != link) links.push_back(static_cast<std::uint16_t>(link));
        }
    }
    return approaches;
}

SignalPhase phase_of(const roads::Signal& signal, std::uint32_t number,
                     const std::vector<SignalApproach>& approaches) {
    const roads::Phase& phase = signal.program[number];
    SignalPhase sheet{number, phase.name, phase.state, phase.duration_s, phase.least_s, false, false, {}};
    sheet.green = std::ranges::any_of(phase.state, traffic::is_green) &&
                  std::ranges::none_of(phase.state, traffic::is_yellow);
    for (std::size_t link = 0; link < phase.state.size(); ++link)
        sheet.on_foot = sheet.on_foot || (is_crossing(signal, link) && traffic::is_green(phase.state[link]));
    for (const SignalApproach& approach : approaches) {
        const bool has_green = std::ranges::any_of(
            approach.links, [&](std::uint16_t link) { return traffic::is_green_for(phase.state, link); });
        if (has_green) sheet.edges.push_back(approach.edge);
    }
    return sheet;
}

roads::Point place_of(const roads::Network& network, const roads::Signal& signal) {
    double x_m = 0.0;
    double y_m = 0.0;
    double count = 0.0;
    for (const auto& ways : signal.links) {
        for (const roads::SignalLink& way : ways) {
            const roads::Point end = network.lane(way.from).shape.back();
            x_m += end.x_m;
            y_m += end.y_m;
            ++count;
        }
    }
    count = std::max(count, 1.0);
    return {static_cast<float>(x_m / count), static_cast<float>(y_m / count)};
}

SignalSheet sheet_of(const roads::Network& network, const roads::Signal& signal) {
    SignalSheet sheet{.signal = signal.id,
                      .controller = signal.controller,
                      .program = signal.program_id,
                      .place = place_of(network, signal),
                      .coordinated = signal.fixed_time,
                      .offset_s = signal.offset_s,
                      .yellow = {},
                      .red_clearance = {},
                      .least_green = {},
                      .approaches = approaches_of(network, signal),
                      .phases = {},
                      .set = {}};
    const std::vector<roads::OwnClearance> own = roads::own_clearances(signal);
    for (std::size_t link = 0; link < own.size(); ++link) {
        if (is_crossing(signal, link)) {
            ++sheet.crossings;
            continue;
        }
        include(sheet.yellow, own[link].yellow_s);
        include(sheet.red_clearance, own[link].red_s);
    }
    for (std::uint32_t number = 0; number < signal.program.size(); ++number) {
        sheet.phases.push_back(phase_of(signal, number, sheet.approaches));
        sheet.cycle_s += sheet.phases.back().duration_s;
        if (sheet.phases.back().green) include(sheet.least_green, sheet.phases.back().least_s);
    }
    return sheet;
}

}  // namespace

std::string streets_of(const SignalSheet& sheet) {
    std::vector<std::string> names;
    for (const SignalApproach& approach : sheet.approaches)
        if (!approach.street.empty() && std::ranges::find(names, approach.street) == names.end())
            names.push_back(approach.street);
    return fmt::format("{}", fmt::join(names, " / "));
}

std::vector<SignalSheet> signal_sheets(const roads::Network& network,
                                       const std::vector<traffic::Preemption>& preemption) {
    std::vector<SignalSheet> sheets;
    for (const roads::Signal& signal : network.signals()) {
        sheets.push_back(sheet_of(network, signal));
        if (sheets.size() <= preemption.size()) sheets.back().set = preemption[sheets.size() - 1];
    }
    return sheets;
}

}  // namespace clearway::scenario
