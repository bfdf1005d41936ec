#pragma once

#include <map>
#include <string>

#include "roads/network.hpp"

namespace clearway::roads {

/// The speed limits of roads, weighed by their length.
class Limits {
  public:
    /// A road of this limit; one without a positive limit does not count.
    void add(double limit_mps, double length_m);
    /// `roads of 140 km/h`; of several limits the range and the most common: `roads of 30 to 100 km/h, mostly
    /// 50`. Empty without roads.
    std::string words() const;

  private:
    std::map<int, double> length_m_;  ///< By limit in km/h.
};

/// The limit of an edge for the fastest of its lanes that cars may use; 0 if there is none, and inside
/// junctions.
double limit_mps(const Network& network, const Edge& edge);
Limits limits_of(const Network& network);

}  // namespace clearway::roads
