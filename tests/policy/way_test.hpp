#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "policy/policy.hpp"
#include "support/crossing_scene.hpp"

namespace clearway::testing {

/// An emergency vehicle on its way over B0 of short_square; over A1 it is as far.
class WayTest : public ::testing::Test {
  protected:
    static core::EdgeIndex edge(const char* id) { return short_square().find_edge(id).value(); }
    static std::vector<core::EdgeIndex> edges(std::initializer_list<const char*> ids) {
        std::vector<core::EdgeIndex> found;
        for (const char* id : ids)
            found.push_back(edge(id));
        return found;
    }
    /// A queue on A0B0 that nobody leaves.
    void add_queue(int vehicles = 12) {
        for (int i = 0; i < vehicles; ++i)
            scene.add({"q" + std::to_string(i),
                       traffic::VehicleClass::human,
                       {"A0B0", "B0B1"},
                       0,
                       94.0 - 7.5 * i,
                       0.0});
    }
    /// The leases of a decision, 0.5 s after the last one.
    std::vector<traffic::Lease> act(policy::Policy& policy) {
        std::vector<traffic::Lease> leases;
        traffic::BelievedGraph& belief = scene.belief();
        now_s += 0.5;
        belief.time = core::Seconds(now_s);
        policy.act(belief, leases);
        return leases;
    }

    CrossingScene scene{100.0, short_square()};
    core::VehicleKey ev = scene.add(
        {"e", traffic::VehicleClass::emergency, {"left0A0", "A0B0", "B0B1", "B1right1"}, 0, 20.0, 10.0});
    double now_s = 100.0;
};

}  // namespace clearway::testing
