#include <map>
#include <set>

#include <gmock/gmock.h>

#include "experiment/conditions.hpp"
#include "loop/study_folder.hpp"
#include "loop/unit_run.hpp"
#include "scenario/prepare.hpp"
#include "support/temporary_folder.hpp"
#include "trace/recording.hpp"
#include "trace/replay.hpp"
#include "truth/snapshot.hpp"

namespace clearway::loop {
namespace {

constexpr const char* grid = "grid_signals_v2";
constexpr double from_s = 40.0;
constexpr double to_s = 340.0;

/// How many vehicles stand on the blocked edge, at most while it is blocked, and long after; and where
/// emergency vehicles drive.
class Watcher : public trace::StepListener {
  public:
    Watcher(core::EdgeIndex edge, const roads::Network& network) : edge_(edge), network_(network) {}
    void on_step(const truth::Snapshot& snapshot, const traffic::Roster&) override {
        int standing = 0;
        for (std::size_t row = 0; row < snapshot.size(); ++row) {
            const core::EdgeIndex edge = network_.lane(snapshot.lane[row]).edge;
            const bool is_here = edge == edge_;
            if (snapshot.vehicle_class[row] == traffic::VehicleClass::emergency)
                driven.emplace(snapshot.key[row], network_.edge(edge).id);
            standing += is_here && snapshot.speed_mps[row] < 0.1F ? 1 : 0;
            if (is_here && snapshot.time.value > from_s + 60.0 && snapshot.time.value < to_s)
                farthest_m = std::max(farthest_m, snapshot.lane_position_m[row]);
        }
        if (snapshot.time.value < to_s) most = std::max(most, standing);
        if (snapshot.time.value > to_s + 120.0) late = std::max(late, standing);
    }
    int most = 0;
    int late = 0;
    float farthest_m = 0.0F;
    std::set<std::pair<core::VehicleKey, std::string>> driven;

  private:
    core::EdgeIndex edge_;
    const roads::Network& network_;
};

/// The edge that most cars pass among those in the middle of the way of the first EV.
std::string blocked_edge(const test::StudyFolder& folder, const scenario::ScenarioConfig& config) {
    const experiment::RunJob unit = folder.unit(0);
    const scenario::BuiltNetwork built = scenario::open_network(config, unit.network_folder);
    const scenario::Prepared prepared = scenario::prepare(config, built, core::StudySeed{unit.study_seed},
                                                          core::Replication{0}, folder.path() / "look");
    const std::string routes = core::read_file(folder.path() / "look" / "traffic.rou.xml");
    const std::vector<std::string>& edges = prepared.emergency.front().edges;
    std::map<std::size_t, std::string> by_use;
    for (std::size_t at = 2; at + 1 < edges.size(); ++at) {
        std::size_t used = 0;
        for (std::size_t found = routes.find(" " + edges[at] + " "); found != std::string::npos;
             found = routes.find(" " + edges[at] + " ", found + 1))
            ++used;
        by_use[used] = edges[at];
    }
    return by_use.rbegin()->second;
}

struct Outcome {
    results::RunRecord record;
    int most = 0;
    int late = 0;
    float farthest_m = 0.0F;
    std::set<std::pair<core::VehicleKey, std::string>> driven = {};
};

Outcome outcome_of(const test::StudyFolder& folder, const std::string& condition, const std::string& edge,
                   experiment::StepRecording recording = experiment::StepRecording::off) {
    experiment::RunJob unit = folder.unit(0);
    unit.recording = recording;
    const std::filesystem::path files = folder.path() / ("files-" + condition);
    UnitRun run(unit, files, files);
    Watcher watcher(*run.network().find_edge(edge), run.network());
    results::RunTiming timing;
    Outcome outcome{run.finish_here(experiment::built_in_condition(condition, "test"), timing, &watcher)};
    outcome.most = watcher.most;
    outcome.late = watcher.late;
    outcome.farthest_m = watcher.farthest_m;
    outcome.driven = std::move(watcher.driven);
    return outcome;
}

bool met_while_it_lasted(const metrics::VehicleRow& vehicle) {
    return vehicle.vehicle_class == traffic::VehicleClass::emergency &&
           vehicle.incident_met_s.value_or(0.0) >= from_s && *vehicle.incident_met_s <= to_s;
}

TEST(IncidentRun, blocks_the_road_until_it_is_over_alike_in_two_conditions) {
    const std::vector<experiment::ConditionSpec> conditions = {
        experiment::built_in_condition("baseline", "test"),
        experiment::built_in_condition("corridor", "test")};
    scenario::Options options;
    options.set("density", "3");
    const test::StudyFolder free(grid, options, conditions);
    const std::string edge = blocked_edge(free, scenario::load(grid, options));
    options.set("incident", fmt::format("edge={},from_s={},to_s={},known_after_s=60,reroute_share=0.5", edge,
                                        from_s, to_s));
    const test::StudyFolder blocked(grid, options, conditions);

    const Outcome without = outcome_of(free, "baseline", edge);
    const Outcome baseline = outcome_of(blocked, "baseline", edge, experiment::StepRecording::on);
    const Outcome corridor = outcome_of(blocked, "corridor", edge, experiment::StepRecording::on);

    EXPECT_EQ(without.record.metrics.emergency_met_incident, 0U);
    EXPECT_FALSE(without.record.metrics.incident_delay_s);
    for (const Outcome& outcome : {baseline, corridor}) {
        const metrics::RunMetrics& metrics = outcome.record.metrics;
        EXPECT_GE(outcome.most, 3);  // a queue behind the obstacle
        EXPECT_EQ(outcome.late, 0);
        EXPECT_GT(without.farthest_m, outcome.farthest_m + 50.0F);  // nobody gets past the middle
        EXPECT_GE(metrics.emergency_turned_round, 1U);
        EXPECT_FALSE(outcome.record.traffic.edge_times.empty());
        for (const metrics::EdgeTimeRow& row : outcome.record.traffic.edge_times)
            EXPECT_TRUE(outcome.driven.contains({core::vehicle_key(row.vehicle), row.edge}))
                << row.vehicle << " has a time of " << row.edge << ", which it did not drive";
        EXPECT_GE(metrics.emergency_met_incident, metrics.emergency_turned_round);
        EXPECT_EQ(
            static_cast<std::uint64_t>(std::ranges::count_if(outcome.record.vehicles, &met_while_it_lasted)),
            metrics.emergency_met_incident);
        EXPECT_EQ(metrics.emergency_cut_off, 0U);
        EXPECT_EQ(metrics.emergency_arrived, metrics.emergency_count);
        EXPECT_GE(metrics.others_rerouted, 1U);
        // The vehicles of the demand, without obstacles.
        EXPECT_EQ(metrics.vehicle_count, without.record.metrics.vehicle_count);
        EXPECT_EQ(metrics.arrived, metrics.vehicle_count);
        EXPECT_LT(metrics.incident_delay_s.value(), 30.0);
        EXPECT_EQ(metrics.locks, 0U);  // a queue at a block has its reason
    }
    // It began before the conditions parted.
    EXPECT_EQ(baseline.record.metrics.incident_delay_s, corridor.record.metrics.incident_delay_s);

    // A replay decides as the run did, and knows what it knew.
    const experiment::RunKey key = corridor.record.key;
    trace::RecordingReader recording(trace::recording_file(blocked.path(), key));
    EXPECT_FALSE(recording.info().incidents.empty());
    const experiment::RunJob unit = blocked.unit(0);
    const scenario::BuiltNetwork built =
        scenario::open_network(scenario::load(grid, options), unit.network_folder);
    const trace::ReplayResult replayed = trace::replay(recording, recording.info().condition, built.network);
    EXPECT_GT(replayed.leases.compared, 0U);
    EXPECT_EQ(replayed.observations.first_difference, "");
    EXPECT_EQ(replayed.leases.first_difference, "");
}

/// Who of the others takes another way round an incident. All are on their way to it when everybody hears of
/// it, 60 s after an EV has departed, so that conditions have moved them differently.
class Rerouted : public ::testing::Test {
  protected:
    /// Notes who drives round, and when each is seen last.
    class Round : public trace::StepListener {
      public:
        explicit Round(core::EdgeIndex edge) : round_(edge) {}
        void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) override {
            for (std::size_t row = 0; row < snapshot.size(); ++row) {
                const traffic::VehicleInfo& info = *roster.find(snapshot.key[row]);
                if (info.vehicle_class == traffic::VehicleClass::emergency) continue;
                last_s[info.id] = snapshot.time.value;
                if (std::ranges::count(roster.route(info.route), round_) > 0) round.insert(info.id);
            }
        }
        std::map<std::string, double> last_s;
        std::set<std::string> round;

      private:
        core::EdgeIndex round_;
    };
    static constexpr const char* scenario = R"(
        name = "round"
        version = "test"
        [network]
        nodes = "round.nod.xml"
        edges = "round.edg.xml"
        [time]
        warm_up_s = 10.0
        window_s = 80.0
        horizon_s = 600.0
        [demand]
        human = 30
        automated = 30
        [[flow]]
        from = "gate"
        to = "on"
        [[emergency_trip]]
        from = "gate"
        to = "on"
        depart_s = 40.0
        [[incident]]
        edge = "main"
        lanes = "0"
        known_after_s = 100.0
        reroute_share = )";
    struct Drivers {
        std::map<std::string, double> last_s;
        std::set<std::string> round;
        std::uint64_t counted = 0;
    };

    Rerouted() {
        files_.write(
            "round.nod.xml",
            R"(<nodes><node id="s" x="-2000" y="0"/><node id="a" x="0" y="0"/><node id="d" x="200" y="300"/>)"
            R"(<node id="b" x="400" y="0"/><node id="c" x="1200" y="0"/></nodes>)");
        files_.write(
            "round.edg.xml",
            R"(<edges><edge id="gate" from="s" to="a" numLanes="2"/><edge id="main" from="a" to="b" )"
            R"(numLanes="2"/><edge id="up" from="a" to="d"/><edge id="down" from="d" to="b"/>)"
            R"(<edge id="on" from="b" to="c" numLanes="2"/></edges>)");
    }
    Drivers with(const char* share, const std::vector<std::string>& policies, std::uint32_t replication = 0) {
        const std::filesystem::path file = files_.write("scenario.toml", scenario + std::string(share));
        experiment::ConditionSpec condition;
        condition.name = "test";
        condition.policies = policies;
        const test::StudyFolder folder(file.string(), {}, {condition});
        UnitRun run(folder.unit(replication), folder.path() / "demand", folder.path() / "sumo");
        Round listener(*run.network().find_edge("up"));
        results::RunTiming timing;
        const results::RunRecord record = run.finish_here(condition, timing, &listener);
        return {listener.last_s, listener.round, record.metrics.others_rerouted};
    }

  private:
    support::TemporaryFolder files_;
};

TEST_F(Rerouted, others_are_the_same_in_every_condition_of_a_seed) {
    const Drivers baseline = with("0.5", {});
    EXPECT_EQ(baseline.counted, baseline.round.size());
    // Standard deviation 4.
    EXPECT_NEAR(static_cast<double>(baseline.round.size()), 30.0, 16.0);
    for (const std::vector<std::string>& policies :
         {std::vector<std::string>{"corridor"}, {"navigate", "corridor"}}) {
        const Drivers other = with("0.5", policies);
        EXPECT_NE(other.last_s, baseline.last_s) << "the condition changes nothing";
        EXPECT_EQ(other.round, baseline.round);
    }
    const Drivers seed = with("0.5", {}, 1);
    EXPECT_NE(seed.round, baseline.round) << "another seed chooses others";
}

TEST_F(Rerouted, others_are_none_with_share_0_and_all_with_share_1) {
    const Drivers none = with("0.0", {});
    EXPECT_EQ(none.last_s.size(), 60U);
    EXPECT_TRUE(none.round.empty());
    EXPECT_EQ(none.counted, 0U);
    const Drivers all = with("1.0", {});
    EXPECT_EQ(all.round.size(), 60U);
    EXPECT_EQ(all.counted, 60U);
}

}  // namespace
}  // namespace clearway::loop
