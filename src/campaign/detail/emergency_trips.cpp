#include "campaign/detail/emergency_trips.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace clearway::campaign::detail {

std::vector<EmergencyTrip> emergency_trips_in(const std::string& csv) {
    std::vector<EmergencyTrip> trips;
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        std::istringstream edges(line.substr(line.rfind(',') + 1));
        trips.push_back({line.substr(0, line.find(',')),
                         {std::istream_iterator<std::string>(edges), std::istream_iterator<std::string>()}});
    }
    return trips;
}

Crossings crossings_of(const roads::Network& network) {
    Crossings crossings;
    std::uint32_t index = 0;
    for (const roads::Signal& signal : network.signals()) {
        const core::SignalIndex own{index++};
        for (const auto& link : signal.links) {
            for (const roads::SignalLink& way : link) {
                const auto edge = [&](core::LaneIndex lane) {
                    return network.edge(network.lane(lane).edge).id;
                };
                crossings[{edge(way.from), edge(way.to)}].insert(own);
            }
        }
    }
    return crossings;
}

std::vector<core::SignalIndex> passed_by(const std::vector<std::string>& edges, const Crossings& crossings) {
    std::vector<core::SignalIndex> passed;
    for (std::size_t at = 1; at < edges.size(); ++at) {
        const auto found = crossings.find({edges[at - 1], edges[at]});
        if (found == crossings.end()) continue;
        for (const core::SignalIndex signal : found->second)
            if (std::ranges::find(passed, signal) == passed.end()) passed.push_back(signal);
    }
    return passed;
}

}  // namespace clearway::campaign::detail
