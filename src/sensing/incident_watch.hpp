#pragma once

#include <vector>

#include "roads/network.hpp"
#include "traffic/incident.hpp"
#include "traffic/observation.hpp"
#include "truth/snapshot.hpp"

namespace clearway::sensing {

/// Which incidents are known: for all at the moment that the scenario sets, or once an automated or emergency
/// vehicle whose report arrives is within sight of one. What is known once stays known until it is over.
class IncidentWatch {
  public:
    static constexpr float sight_m = 50.0F;

    IncidentWatch(const roads::Network& network, const std::vector<traffic::Incident>& incidents);

    /// Once a step: fills `observation.incidents`. The rest of the observation is that of the step.
    void observe(const truth::Snapshot& snapshot, traffic::Observation& observation);

  private:
    struct Watched {
        traffic::Incident incident;
        traffic::KnownIncident known;
        roads::Point place;
        bool is_known = false;
    };
    static bool is_seen(const Watched& watched, const truth::Snapshot& snapshot,
                        const traffic::Observation& observation);

    std::vector<Watched> watched_;
};

}  // namespace clearway::sensing
