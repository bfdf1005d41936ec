#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/files.hpp"
#include "core/process.hpp"
#include "prepared_demand.hpp"

namespace clearway::scenario {
namespace {

using ::testing::HasSubstr;

/// A vehicle as the route file states it.
struct Row {
    std::string type;
    double depart_s = 0.0;
    double speed_factor = 0.0;
    std::vector<std::string> edges;
    std::size_t order = 0;
};

std::string attribute(const std::string& element, const std::string& name) {
    const std::string mark = " " + name + "=\"";
    const std::size_t start = element.find(mark);
    if (start == std::string::npos) return "";
    const std::size_t end = element.find('"', start + mark.size());
    return element.substr(start + mark.size(), end - start - mark.size());
}

std::vector<std::string> words(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<std::string>(stream), {}};
}

/// Reads `<vehicle>` and the `<route>` inside, line by line.
std::map<std::string, Row> rows_of(const std::filesystem::path& file) {
    std::map<std::string, Row> rows;
    std::istringstream lines(core::read_file(file));
    std::string id;
    for (std::string line; std::getline(lines, line);) {
        if (line.find("<vehicle ") != std::string::npos) {
            id = attribute(line, "id");
            rows[id] = {attribute(line, "type"),
                        std::stod(attribute(line, "depart")),
                        std::stod(attribute(line, "speedFactor")),
                        {},
                        rows.size()};
        }
        if (line.find("<route ") != std::string::npos) rows[id].edges = words(attribute(line, "edges"));
    }
    return rows;
}

TEST_F(PreparedDemand, counts_are_those_asked_for) {
    const Prepared merge = prepared("merge");
    EXPECT_EQ(merge.human, 23);
    EXPECT_EQ(merge.automated, 14);
    EXPECT_EQ(merge.emergency.size(), 3U);
    EXPECT_EQ(rows_of(merge.route_files.at(0)).size(), 37U);
    Options dense;
    dense.set("variant", "dense");
    const Prepared many = prepared("merge", dense);
    EXPECT_EQ(many.human, 230);
    EXPECT_EQ(many.automated, 140);
    EXPECT_EQ(many.emergency.size(), 6U);
}

TEST_F(PreparedDemand, depends_on_seed_and_replication_alone) {
    const Prepared first = prepared("city");
    const Prepared again = prepared("city");
    const Prepared other = prepared("city", {}, 1);
    EXPECT_EQ(core::read_file(first.route_files[0]), core::read_file(again.route_files[0]));
    EXPECT_EQ(first.demand_hash, again.demand_hash);
    EXPECT_EQ(first.simulator_seed, again.simulator_seed);
    EXPECT_NE(first.demand_hash, other.demand_hash);
    EXPECT_NE(first.simulator_seed, other.simulator_seed);
}

TEST_F(PreparedDemand, pedestrians_walk_across_crossings_and_leave_the_vehicles_as_they_were) {
    const Prepared alone = prepared("city");
    EXPECT_EQ(alone.route_files.size(), 1U) << "nobody walks by default";
    Options options;
    options.set("pedestrians_per_hour", "200");
    const Prepared walked = prepared("city", options);
    ASSERT_EQ(walked.route_files.size(), 2U);
    EXPECT_EQ(core::read_file(walked.route_files[0]), core::read_file(alone.route_files[0]));
    EXPECT_NE(walked.demand_hash, alone.demand_hash);
    const std::string first = core::read_file(walked.route_files[1]);
    EXPECT_EQ(first, core::read_file(prepared("city", options).route_files[1]));
    EXPECT_NE(first, core::read_file(prepared("city", options, 1).route_files[1]));
    const auto count = [](const std::string& text) {
        std::size_t persons = 0;
        for (std::size_t at = text.find("<person "); at != std::string::npos;
             at = text.find("<person ", at + 1))
            ++persons;
        return persons;
    };
    options.set("pedestrians_per_hour", "400");
    const std::string more = core::read_file(prepared("city", options).route_files[1]);
    EXPECT_NEAR(static_cast<double>(count(more)), 2.0 * static_cast<double>(count(first)), 1.0);
    const std::size_t person = first.find("<person id=\"pedestrian.7\"");
    EXPECT_NE(more.find(first.substr(person, first.find('\n', person) - person)), std::string::npos)
        << "more of them leave the others as they were";
}

TEST_F(PreparedDemand, pedestrians_need_a_crossing) {
    Options options;
    options.set("pedestrians_per_hour", "10");
    const auto problems = problems_of([&] { prepared("merge", options); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems[0].where, "--pedestrians");
    EXPECT_THAT(problems[0].what, HasSubstr("no crossing"));
}

TEST_F(PreparedDemand, more_traffic_leaves_the_other_vehicles_as_they_were) {
    const auto few = rows_of(prepared("merge").route_files[0]);
    Options options;
    options.set("density", "3");
    const auto many = rows_of(prepared("merge", options).route_files[0]);
    EXPECT_EQ(many.size(), 111U);
    for (const auto& [id, row] : few) {
        ASSERT_TRUE(many.contains(id));
        EXPECT_EQ(many.at(id).depart_s, row.depart_s);
        EXPECT_EQ(many.at(id).speed_factor, row.speed_factor);
        EXPECT_EQ(many.at(id).edges, row.edges);
    }
}

TEST_F(PreparedDemand, vehicles_stand_in_order_of_departure_within_the_window) {
    const Prepared demand = prepared("intersection");
    std::map<std::size_t, double> by_order;
    for (const auto& [id, row] : rows_of(demand.route_files[0]))
        by_order[row.order] = row.depart_s;
    double last_s = 0.0;
    for (const auto& [order, depart_s] : by_order) {
        EXPECT_GE(depart_s, last_s);
        last_s = depart_s;
    }
    EXPECT_LE(last_s, demand.time.window_s);
}

TEST_F(PreparedDemand, emergency_vehicles_depart_after_the_warm_up) {
    for (std::uint32_t replication = 0; replication < 10; ++replication) {
        const Prepared demand = prepared("merge", {}, replication);
        for (const auto& departure : demand.emergency) {
            EXPECT_GE(departure.depart.value, demand.time.warm_up_s);
            EXPECT_LE(departure.depart.value, demand.time.window_s);
            EXPECT_EQ(departure.type, "emergency_ambulance");
            EXPECT_EQ(departure.kind, traffic::VehicleKind::ambulance);
        }
    }
}

TEST_F(PreparedDemand, human_drivers_differ_and_automated_ones_do_not) {
    Options dense;
    dense.set("variant", "dense");
    double sum = 0.0;
    double squares = 0.0;
    int humans = 0;
    for (const auto& [id, row] : rows_of(prepared("merge", dense).route_files[0])) {
        if (row.type == "automated_car") {
            EXPECT_EQ(row.speed_factor, 1.0);
            continue;
        }
        EXPECT_GE(row.speed_factor, 0.75);
        EXPECT_LE(row.speed_factor, 1.25);
        sum += row.speed_factor;
        squares += row.speed_factor * row.speed_factor;
        ++humans;
    }
    const double mean = sum / humans;
    EXPECT_NEAR(mean, 1.0, 0.03);
    EXPECT_NEAR(std::sqrt(squares / humans - mean * mean), 0.1, 0.02);
}

/// Headway, acceleration, deceleration and emergency deceleration of each type.
std::map<std::string, std::array<double, 4>> dynamics_of(const std::filesystem::path& file) {
    std::map<std::string, std::array<double, 4>> types;
    std::istringstream lines(core::read_file(file));
    for (std::string line; std::getline(lines, line);) {
        if (line.find("<vType ") == std::string::npos) continue;
        const auto number = [&](const char* name) { return std::stod(attribute(line, name)); };
        types[attribute(line, "id")] = {number("tau"), number("accel"), number("decel"),
                                        number("emergencyDecel")};
    }
    return types;
}

TEST_F(PreparedDemand, spread_gives_each_human_driver_a_type_of_its_own) {
    Options options;
    options.set("variant", "dense");
    const auto of = [&](double spread) {
        options.set("driver_spread", fmt::format("{}", spread));
        const Prepared made = prepared("merge", options);
        return std::pair(rows_of(made.route_files.front()), dynamics_of(made.additional_files.front()));
    };
    const auto [usual, usual_types] = of(0.0);
    const auto [rows, types] = of(0.2);
    const auto [wide_rows, wide_types] = of(0.4);
    ASSERT_EQ(rows.size(), usual.size());
    double sum = 0.0;
    double square = 0.0;
    int humans = 0;
    for (const auto& [id, row] : rows) {
        EXPECT_EQ(row.depart_s, usual.at(id).depart_s);
        EXPECT_EQ(row.edges, usual.at(id).edges);
        if (!id.starts_with("human")) {
            EXPECT_EQ(row.type, usual.at(id).type);
            continue;
        }
        const std::array<double, 4>& driver = types.at(row.type);
        const std::array<double, 4>& wider = wide_types.at(wide_rows.at(id).type);
        const std::array<double, 4>& plain = usual_types.at(usual.at(id).type);
        for (std::size_t number = 0; number < 3; ++number) {
            const double factor = driver[number] / plain[number];
            EXPECT_GE(factor, 0.5);
            EXPECT_LE(factor, 2.0);
            // The same draw: who is far above the mean stays above it.
            if (factor > 1.1) {
                EXPECT_GT(wider[number], plain[number]) << id;
            }
        }
        EXPECT_GE(driver[3], driver[2]);
        const double headway = driver[0] / plain[0];
        sum += headway;
        square += headway * headway;
        ++humans;
        EXPECT_GE(row.speed_factor, 0.75);
        EXPECT_LE(row.speed_factor, 1.25);
    }
    ASSERT_GT(humans, 150);
    const double mean = sum / humans;
    EXPECT_NEAR(mean, 1.0, 4.0 * 0.2 / std::sqrt(humans));
    EXPECT_NEAR(std::sqrt(square / humans - mean * mean), 0.2, 0.045);
}

TEST_F(PreparedDemand, three_in_ten_come_from_the_ramp) {
    Options dense;
    dense.set("variant", "dense");
    int ramp = 0;
    int all = 0;
    for (std::uint32_t replication = 0; replication < 5; ++replication) {
        for (const auto& [id, row] : rows_of(prepared("merge", dense, replication).route_files[0])) {
            ++all;
            ramp += row.edges.front() == "ramp" ? 1 : 0;
        }
    }
    EXPECT_NEAR(static_cast<double>(ramp) / all, 0.3, 0.035);  // three standard errors at 1,850 vehicles
}

TEST_F(PreparedDemand, city_trips_are_long_enough) {
    const Prepared demand = prepared("city");
    for (const auto& [id, row] : rows_of(demand.route_files[0]))
        EXPECT_GE(length_m("city", row.edges), 500.0);
    ASSERT_EQ(demand.emergency.size(), 7U);
    for (const auto& departure : demand.emergency)
        EXPECT_GE(length_m("city", departure.edges), 1000.0);
}

TEST_F(PreparedDemand, kinds_follow_their_weights) {
    init(folder() / "mixed", "merge");
    const std::filesystem::path file = folder() / "mixed" / "scenario.toml";
    std::ofstream(file, std::ios::app) << "\n[kinds.traffic]\ncar = 0.0\ntruck = 1.0\nvan = 1.0\n"
                                          "[kinds.emergency]\nambulance = 0.0\npolice_car = 2.0\n";
    const Prepared demand = prepared(file.string());
    std::set<std::string> types;
    for (const auto& [id, row] : rows_of(demand.route_files[0]))
        types.insert(row.type);
    EXPECT_EQ(types, (std::set<std::string>{"human_truck", "human_van", "automated_truck", "automated_van"}));
    for (const auto& departure : demand.emergency)
        EXPECT_EQ(departure.type, "emergency_police_car");
}

TEST_F(PreparedDemand, measured_departures_and_routes_stay_and_a_share_is_automated) {
    const Prepared demand = prepared("bologna");
    const auto rows = rows_of(demand.route_files[0]);
    const auto& first = rows.at("Audinot_7_0");
    EXPECT_EQ(first.edges, (std::vector<std::string>{"a131", "a117", "a209"}));
    EXPECT_EQ(first.depart_s, 0.0);
    EXPECT_TRUE(rows.at("Pepoli_3_0").type.ends_with("_unrestricted"));
    EXPECT_EQ(rows.at("bus_11_0").type, "human_bus");
    EXPECT_NEAR(demand.automated / static_cast<double>(demand.human + demand.automated), 0.35, 0.03);
    ASSERT_EQ(demand.emergency.size(), 10U);
    for (const auto& departure : demand.emergency)
        EXPECT_GE(length_m("bologna", departure.edges), 1000.0);
    EXPECT_THAT(core::read_file(demand.route_files[0]), HasSubstr("busStop=\"busStop#b15\""));
}

TEST_F(PreparedDemand, thinning_measured_demand_keeps_who_is_automated) {
    Options half;
    half.set("density", "0.5");
    const auto all = rows_of(prepared("bologna").route_files[0]);
    const auto thinned = rows_of(prepared("bologna", half).route_files[0]);
    EXPECT_NEAR(static_cast<double>(thinned.size()) / static_cast<double>(all.size()), 0.5, 0.03);
    for (const auto& [id, row] : thinned)
        EXPECT_EQ(all.at(id).type, row.type);
}

/// The independent judge of what is written: SUMO itself.
class LoadsInSumo : public PreparedDemand, public ::testing::WithParamInterface<const char*> {
  protected:
    void expect_loads(const Prepared& demand) const;
};

void LoadsInSumo::expect_loads(const Prepared& demand) const {
    std::string additional;
    for (const auto& file : demand.additional_files)
        additional += (additional.empty() ? "" : ",") + file.string();
    core::Command sumo;
    sumo.program = "sumo";
    sumo.arguments = {"-n",
                      demand.network_file.string(),
                      "-r",
                      demand.route_files[0].string(),
                      "-a",
                      additional,
                      "--xml-validation",
                      "never",
                      "--no-step-log",
                      "true",
                      "--step-length",
                      "0.25",
                      "--end",
                      "30",
                      "--route-steps",
                      "0"};
    sumo.output = folder() / "sumo.log";
    EXPECT_TRUE(core::run(sumo).ok()) << core::read_file(sumo.output);
    const std::string log = core::read_file(sumo.output);
    EXPECT_EQ(log.find("Error"), std::string::npos) << log;
    EXPECT_EQ(log.find("not known"), std::string::npos) << log;
    EXPECT_EQ(log.find("no valid route"), std::string::npos) << log;
    EXPECT_EQ(log.find("sorted"), std::string::npos) << log;
}

TEST_P(LoadsInSumo, without_warning_about_routes_or_types) {
    expect_loads(prepared(GetParam()));
}

TEST_P(LoadsInSumo, with_other_drivers) {
    Options options;
    options.set("car_following", "krauss");
    options.set("driver_spread", "0.3");
    const Prepared demand = prepared(GetParam(), options);
    EXPECT_THAT(core::read_file(demand.route_files[0]), HasSubstr("_driver_"));
    expect_loads(demand);
}

INSTANTIATE_TEST_SUITE_P(shipped, LoadsInSumo, ::testing::Values("merge", "intersection", "city", "bologna"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace clearway::scenario
