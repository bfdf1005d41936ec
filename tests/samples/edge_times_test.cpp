#include "samples/edge_times.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "support/ascii_scene.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::samples {
namespace {

constexpr const char* short_road = R"(
    10 m per cell, limit 20 m/s, speed 4 m/s
    a.......e...h...............................................
)";

TEST(EdgeUse, is_time_and_distance_of_others_than_emergency_vehicles) {
    support::Scene scene(short_road);
    EdgeUseRecorder recorder(scene.network());
    for (int step = 0; step <= 20; ++step) {
        scene.snapshot().time = core::Seconds(100.0 + 0.5 * step);
        recorder.on_step(scene.snapshot(), scene.roster());
    }
    const EdgeUses uses = recorder.uses();
    ASSERT_EQ(uses.size(), 1U);
    const EdgeUse& use = uses.begin()->second;
    EXPECT_EQ(use.vehicles, 2U) << "each once, and no emergency vehicle";
    EXPECT_DOUBLE_EQ(use.time_s, 20.0) << "two vehicles for 10 s, whatever the time of the first step";
    EXPECT_DOUBLE_EQ(use.distance_m, 80.0);
}

TEST(EdgeUse, is_read_as_it_was_written) {
    const support::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "uses.csv";
    write_edge_uses({{"a,b", {3, 12.25, 80.5}}, {"c", {1, 0.5, 0.0}}}, file);
    const EdgeUses uses = read_edge_uses(file);
    ASSERT_EQ(uses.size(), 2U);
    EXPECT_EQ(uses.at("a,b").vehicles, 3U);
    EXPECT_EQ(uses.at("a,b").time_s, 12.25);
    EXPECT_EQ(uses.at("a,b").distance_m, 80.5);
    EXPECT_THROW(read_edge_uses(folder.write("other.csv", "edge,vehicles\nc,1\n")), core::InputError);
}

}  // namespace
}  // namespace clearway::samples
