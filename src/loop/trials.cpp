#include "loop/trials.hpp"

#include <algorithm>

namespace clearway::loop {

void Trials::note(const truth::Events& events) {
    for (const core::VehicleKey vehicle : events.arrived)
        arrived_s_.emplace(vehicle, events.time.value);
}

void Trials::add(core::VehicleKey vehicle, core::Seconds best, std::uint64_t tried) {
    trials_.push_back({vehicle, best.value, tried});
}

metrics::TriedChoices Trials::result(core::Seconds horizon) const {
    constexpr double level_s = 1.0;  // the longest step
    metrics::TriedChoices choices;
    for (const Trial& trial : trials_) {
        const auto arrived = arrived_s_.find(trial.vehicle);
        const double chosen_s = arrived == arrived_s_.end() ? horizon.value : arrived->second;
        const double regret_s = std::max(0.0, chosen_s - trial.best_s);
        ++choices.decisions;
        choices.tried += trial.tried;
        choices.regret_s += regret_s;
        choices.best += regret_s <= level_s ? 1 : 0;
    }
    return choices;
}

}  // namespace clearway::loop
