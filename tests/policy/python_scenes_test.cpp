// The scenes in which `python3 -m clearway.conformance` judges policies in Python. A decision is half a
// second.

#include <functional>

#include "policy/conformance.hpp"
#include "policy/python_policy.hpp"
#include "python/part_scenes.hpp"

namespace clearway::testing {
namespace {

using traffic::VehicleClass;

/// What is believed at a decision, numbered from 0.
using Drawn = std::function<CrossingScene(int decision)>;

class PythonScenes : public ::testing::Test {
  protected:
    void show(const char* name, int decisions, const Drawn& drawn,
              const roads::Network& network = two_crossings(),
              const std::function<void(traffic::BelievedGraph&, int)>& change = {}) {
        policy::PythonPolicy recorder({network}, PartScenes::recorder(), scenes.settings(name));
        for (int decision = 0; decision < decisions; ++decision) {
            CrossingScene scene = drawn(decision);
            traffic::BelievedGraph& belief = scene.belief();
            belief.time = core::Seconds(100.0 + 0.5 * decision);
            if (change) change(belief, decision);
            std::vector<traffic::Lease> leases;
            recorder.act(belief, leases);
        }
    }
    /// An emergency vehicle comes from 150 m at 12 m/s.
    static CrossingScene approach(int decision) {
        ActuationBench bench;
        add_helpful_scene(bench, {.to_line_m = 150.0 - 6.0 * decision});
        return bench.scene;
    }
    static Drawn alone(std::vector<SceneVehicle> vehicles) {
        return [vehicles = std::move(vehicles)](int) {
            CrossingScene scene;
            for (const SceneVehicle& vehicle : vehicles)
                scene.add(vehicle);
            return scene;
        };
    }
    static Drawn emergency_alone(double position_m) {
        return alone({{"e", VehicleClass::emergency, eastbound, 0, position_m, 0.0}});
    }

    PartScenes scenes;
};

CrossingScene needless(int) {
    ActuationBench bench;
    add_needless_scene(bench);
    return bench.scene;
}

CrossingScene two_that_cross(int decision) {
    ActuationBench bench;
    add_helpful_scene(bench, {.to_line_m = 150.0 - 6.0 * decision});
    bench.add({"e2", VehicleClass::emergency, {"north_a_A", "A_south_a"}, 1, 160.0 + 6.0 * decision, 12.0});
    bench.add({"a3", VehicleClass::automated, {"north_a_A", "A_south_a"}, 1, 245.0, 8.0});
    return bench.scene;
}

CrossingScene crowded(int) {
    CrossingScene scene;
    const std::vector<std::vector<std::string>> ways = {
        eastbound, {"A_B", "B_east"}, {"north_a_A", "A_south_a"}, {"south_a_A", "A_north_a"}};
    int number = 0;
    for (const auto& way : ways)
        for (std::uint32_t lane = 0; lane < 2; ++lane)
            for (double position_m = 20.0; position_m < 280.0; position_m += 9.0, ++number)
                scene.add({"v" + std::to_string(number),
                           number % 3 == 0 ? VehicleClass::human : VehicleClass::automated, way, lane,
                           position_m, 5.0});
    scene.add({"e", VehicleClass::emergency, eastbound, 1, 150.0, 6.0});
    return scene;
}

CrossingScene with_another_way(int) {
    CrossingScene scene{100.0, short_square()};
    scene.add({"e", VehicleClass::emergency, {"left0A0", "A0B0", "B0B1", "B1right1"}, 0, 20.0, 10.0});
    return scene;
}

void forget_emergency(traffic::BelievedGraph& belief) {
    std::erase_if(belief.vehicles, [](const traffic::BelievedVehicle& vehicle) {
        return vehicle.vehicle_class == VehicleClass::emergency;
    });
    belief.first_link.assign(belief.vehicles.size() + 1, 0);
    belief.links.clear();
}

TEST_F(PythonScenes, are_those_of_the_package) {
    show("an EV drives towards a red signal, behind automated vehicles and a queue", 25, approach);
    show("the same, and the reports of the EV are lost", 25, approach, two_crossings(),
         [](traffic::BelievedGraph& belief, int) { forget_emergency(belief); });
    show("two EVs cross", 15, two_that_cross);
    show("the EV vanishes", 12, [](int decision) {
        CrossingScene scene = approach(10);
        if (decision >= 4) scene.remove(emergency_key());
        return scene;
    });
    show("the EV is past the last signal and alone", 8, needless);
    show("an empty road", 3, alone({}));
    show("a human driver alone", 3, alone({{"only", VehicleClass::human, eastbound, 0, 400.0, 10.0}}));
    show("an automated vehicle alone", 3,
         alone({{"only", VehicleClass::automated, eastbound, 0, 400.0, 10.0}}));
    show("an EV alone where its road begins", 3, emergency_alone(0.5));
    show("an EV alone far from the signal", 3, emergency_alone(300.0));
    show("an EV first at the signal", 3, emergency_alone(488.0));
    show("the EV knows itself, and of nothing else is there a report", 5, emergency_alone(380.0),
         two_crossings(), [](traffic::BelievedGraph& belief, int) {
             forget_emergency(belief);
             std::ranges::fill(belief.signals.state, "");
         });
    show(
        "an EV inside a junction, and vehicles whose lanes are not known", 4, [](int) { return approach(5); },
        two_crossings(),
        [](traffic::BelievedGraph& belief, int) {
            const core::LaneIndex inside = two_crossings().find_lane(":A_13_0").value();
            for (traffic::BelievedVehicle& own : belief.own_states)
                own.state.lane = inside;
            for (traffic::BelievedVehicle& vehicle : belief.vehicles)
                vehicle.state.lane =
                    vehicle.vehicle_class == VehicleClass::emergency ? inside : core::LaneIndex::none();
        });
    show("many vehicles", 3, crowded);
    show("a road on the way is closed, and there is another way", 6, with_another_way, short_square(),
         [](traffic::BelievedGraph& belief, int decision) {
             if (decision >= 2) belief.incidents = {{short_square().find_edge("B0B1").value(), true, 0.0F}};
         });
    scenes.expect_shipped("policy_scenes.jsonl");
}

}  // namespace
}  // namespace clearway::testing
