// The graph against its definition, and under changes that must not matter.
#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "reference.hpp"

namespace clearway::graph {
namespace {

using traffic::VehicleClass;

/// The same cases on every run; set RC_PARAMS to search elsewhere.
[[maybe_unused]] const int frozen_cases = setenv("RC_PARAMS", "seed=2023 max_success=400", 0);

/// Positions on a raster of 1/8 m within `spread_m`: differences and squares are exact, and distances of
/// exactly the radius happen.
rc::Gen<float> coordinate(int spread_m) {
    return rc::gen::map(rc::gen::inRange(-8 * spread_m, 8 * spread_m + 1),
                        [](int eighths) { return static_cast<float>(eighths) / 8.0F; });
}

VehicleClass any_class() {
    return *rc::gen::element(VehicleClass::human, VehicleClass::automated, VehicleClass::emergency);
}

/// Clusters of different width and place, all in one cell now and then, and outliers 100 km away.
Crowd any_crowd() {
    Crowd crowd;
    const int clusters = *rc::gen::inRange(0, 5);
    for (int cluster = 0; cluster < clusters; ++cluster) {
        const int spread_m = *rc::gen::element(1, 20, 60, 400);
        const float middle_x_m = *coordinate(500);
        const float middle_y_m = *coordinate(500);
        const int members = *rc::gen::inRange(1, 40);
        for (int member = 0; member < members; ++member) {
            crowd.add(middle_x_m + *coordinate(spread_m), middle_y_m + *coordinate(spread_m), any_class());
        }
    }
    if (*rc::gen::arbitrary<bool>()) crowd.add(1e5F, -1e5F, any_class());
    return crowd;
}

LinkRules any_rules() {
    LinkRules rules;
    rules.radius_m = *rc::gen::element(5.0, 25.0, 50.0, 200.0);
    rules.automated_automated = *rc::gen::element(LinkRules::Pairs::included, LinkRules::Pairs::excluded);
    rules.emergency_emergency = *rc::gen::element(LinkRules::Pairs::included, LinkRules::Pairs::excluded);
    return rules;
}

ProximityGraph built(const Crowd& crowd, const LinkRules& rules,
                     ProximityBuilder::Kernel kernel = ProximityBuilder::Kernel::fastest_here) {
    ProximityBuilder builder(kernel);
    ProximityGraph graph;
    builder.build(crowd.places(), rules, graph);
    return graph;
}

RC_GTEST_PROP(ProximityProperty, EqualsItsDefinition, ()) {
    const Crowd crowd = any_crowd();
    const LinkRules rules = any_rules();
    const ProximityGraph expected =
        reference_graph(crowd, static_cast<float>(rules.radius_m),
                        [&](VehicleClass left, VehicleClass right) { return rules.allows(left, right); });
    RC_CLASSIFY(expected.link_count() > 0);
    RC_ASSERT(built(crowd, rules) == expected);
    RC_ASSERT(built(crowd, rules, ProximityBuilder::Kernel::scalar) == expected);
}

RC_GTEST_PROP(ProximityProperty, AllPairsEqualTheirDefinition, ()) {
    const Crowd crowd = any_crowd();
    const double radius_m = *rc::gen::element(3.0, 50.0, 120.0);
    ProximityBuilder builder;
    ProximityGraph graph;
    builder.build_all_pairs(crowd.places(), radius_m, graph);
    RC_ASSERT(graph == reference_graph(crowd, static_cast<float>(radius_m),
                                       [](VehicleClass, VehicleClass) { return true; }));
}

RC_GTEST_PROP(ProximityProperty, MirrorAndQuarterTurnChangeNothing, ()) {
    const Crowd crowd = any_crowd();
    const LinkRules rules = any_rules();
    Crowd mirrored = crowd;
    for (float& x_m : mirrored.x_m) {
        x_m = -x_m;
    }
    Crowd turned = mirrored;
    turned.x_m.swap(turned.y_m);
    const ProximityGraph graph = built(crowd, rules);
    RC_ASSERT(built(mirrored, rules) == graph);
    RC_ASSERT(built(turned, rules) == graph);
}

RC_GTEST_PROP(ProximityProperty, OtherRowNumbersGiveTheSameLinks, ()) {
    const Crowd crowd = any_crowd();
    const LinkRules rules = any_rules();
    std::vector<core::VehicleIndex> new_row(crowd.size());
    std::iota(new_row.begin(), new_row.end(), 0U);
    for (std::size_t row = new_row.size(); row > 1; --row) {
        std::swap(new_row[row - 1], new_row[*rc::gen::inRange<std::size_t>(0, row)]);
    }
    Crowd relabelled = crowd;
    for (std::size_t row = 0; row < crowd.size(); ++row) {
        relabelled.x_m[new_row[row]] = crowd.x_m[row];
        relabelled.y_m[new_row[row]] = crowd.y_m[row];
        relabelled.vehicle_class[new_row[row]] = crowd.vehicle_class[row];
    }
    const ProximityGraph before = built(crowd, rules);
    const ProximityGraph after = built(relabelled, rules);
    RC_ASSERT(before.link_count() == after.link_count());
    for (core::VehicleIndex row = 0; row < crowd.size(); ++row) {
        std::vector<core::VehicleIndex> expected;
        for (const core::VehicleIndex neighbour : before.neighbours_of(row)) {
            expected.push_back(new_row[neighbour]);
        }
        std::ranges::sort(expected);
        RC_ASSERT(std::ranges::equal(after.neighbours_of(new_row[row]), expected));
    }
}

RC_GTEST_PROP(ProximityProperty, AUsedBuilderForgetsWhatItBuiltBefore, ()) {
    ProximityBuilder used;
    ProximityGraph graph;
    for (int build = 0; build < 3; ++build) {
        const Crowd crowd = any_crowd();
        const LinkRules rules = any_rules();
        used.build(crowd.places(), rules, graph);
        RC_ASSERT(graph == built(crowd, rules));
    }
}

}  // namespace
}  // namespace clearway::graph
