#include "loop/trials.hpp"

#include <algorithm>
#include <utility>

namespace clearway::loop {

void Trials::note(const truth::Events& events) {
    for (const core::VehicleKey vehicle : events.arrived)
        arrived_s_.emplace(vehicle, events.time.value);
}

void Trials::add(std::vector<core::VehicleKey> vehicles, std::vector<double> others_s, std::uint64_t tried) {
    trials_.push_back({std::move(vehicles), std::move(others_s), tried});
}

std::vector<double> Trials::arrivals_s(const Trial& trial, core::Seconds horizon) const {
    std::vector<double> arrivals;
    for (const core::VehicleKey vehicle : trial.vehicles) {
        const auto arrived = arrived_s_.find(vehicle);
        arrivals.push_back(arrived == arrived_s_.end() ? horizon.value : arrived->second);
    }
    std::ranges::sort(arrivals);
    return arrivals;
}

metrics::TriedChoices Trials::result(core::Seconds horizon) const {
    constexpr double level_s = 1.0;  // the longest step
    metrics::TriedChoices choices;
    for (const Trial& trial : trials_) {
        const std::vector<double> chosen_s = arrivals_s(trial, horizon);
        std::vector<double> all_s = chosen_s;
        all_s.insert(all_s.end(), trial.others_s.begin(), trial.others_s.end());
        std::ranges::sort(all_s);
        choices.tried += trial.tried;
        for (std::size_t place = 0; place < chosen_s.size(); ++place) {
            const double regret_s = chosen_s[place] - all_s[place];
            ++choices.decisions;
            choices.regret_s += regret_s;
            choices.best += regret_s <= level_s ? 1 : 0;
        }
    }
    return choices;
}

}  // namespace clearway::loop
