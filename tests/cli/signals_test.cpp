// The signals of a scenario, and their preemption parameters.
#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "crossings.hpp"

namespace clearway::cli {
namespace {

class SignalsTest : public CrossingsTest {
  protected:
    std::string header() const {
        const std::string text = read("p.csv");
        return text.substr(0, text.find('\n') + 1);
    }
};

TEST_F(SignalsTest, are_listed_with_their_phases_and_what_their_programs_show) {
    const Ended ended = clearway({"scenario", "signals", "./crossings"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, testing::ContainsRegex("1  A +static +90 +4 +- +- +0\n"));
    EXPECT_THAT(ended.out, testing::ContainsRegex("phase 0 +41 s +north_a_A, south_a_A\n"));
    EXPECT_THAT(ended.out, HasSubstr("2 signals."));
    const auto json = nlohmann::json::parse(clearway({"scenario", "signals", "./crossings", "--json"}).out);
    const auto& first = json.at("signals").at(0);
    EXPECT_EQ(first.at("signal"), "A");
    EXPECT_EQ(first.at("yellow_s").at("longest"), 4.0);
    EXPECT_EQ(first.at("phases").size(), 4U);
    EXPECT_TRUE(first.at("set").at("dwell_s").is_null());
}

TEST_F(SignalsTest, are_named_by_their_streets_with_the_id_below) {
    std::string net = read("crossings/net.net.xml");
    const std::string edge = "<edge id=\"north_a_A\"";
    net.replace(net.find(edge), edge.size(), edge + " name=\"Side Street\"");
    write("crossings/net.net.xml", net);
    const std::string text = clearway({"scenario", "signals", "./crossings"}).out;
    EXPECT_THAT(text, testing::ContainsRegex("1  Side Street +static"));
    EXPECT_THAT(text, testing::ContainsRegex("\n +Side Street; id A\n"));
}

TEST_F(SignalsTest, are_drawn_with_their_numbers) {
    ASSERT_EQ(clearway({"scenario", "signals", "./crossings", "--svg", "map.svg"}).code, 0);
    EXPECT_THAT(read("map.svg"), AllOf(HasSubstr("Two crossings"), HasSubstr(">#2</text>")));
    EXPECT_EQ(clearway({"scenario", "signals", "./crossings", "--svg", "map.svg"}).code, 0) << "its own map";
    write("map.svg", "<svg>mine</svg>");
    const Ended other = clearway({"scenario", "signals", "./crossings", "--svg", "map.svg"});
    EXPECT_EQ(other.code, 3);
    EXPECT_THAT(other.err,
                HasSubstr("map.svg: is there already (allowed: a new file, or a picture of clearway "
                          "scenario signals)"));
    EXPECT_EQ(read("map.svg"), "<svg>mine</svg>");
}

TEST_F(SignalsTest, have_numbers_that_do_not_lie_upon_each_other) {
    ASSERT_EQ(clearway({"scenario", "signals", "city", "--svg", "map.svg"}).code, 0);
    const std::string map = read("map.svg");
    std::vector<std::array<double, 2>> discs;
    const std::regex disc("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\" r=\"8\"");
    for (auto found = std::sregex_iterator(map.begin(), map.end(), disc); found != std::sregex_iterator();
         ++found)
        discs.push_back({std::stod((*found)[1]), std::stod((*found)[2])});
    ASSERT_EQ(discs.size(), 13U);
    for (std::size_t one = 0; one < discs.size(); ++one)
        for (std::size_t other = 0; other < one; ++other)
            EXPECT_GT(std::hypot(discs[one][0] - discs[other][0], discs[one][1] - discs[other][1]), 16.0)
                << other + 1 << " and " << one + 1;
}

TEST_F(SignalsTest, have_their_parameters_in_a_file_to_edit_that_the_scenario_then_names) {
    ASSERT_EQ(clearway({"scenario", "signals", "./crossings", "--out", "p.csv"}).code, 0);
    write("crossings/p.csv", header() + "A,1,,,,,,9,,,,\n");
    write_scenario("B_east", "preemption = \"p.csv\"\n");
    const Ended set = clearway({"scenario", "signals", "./crossings", "--out", "again.csv"});
    EXPECT_THAT(set.out, HasSubstr("set  dwell_s=9"));
    EXPECT_EQ(read("again.csv"), header() + "A,1,,,,,,9,,,,\nB,1,,,,,,,,,,\n");
    const Ended run = clearway({"run", "./crossings", "--policy", "corridor", "--seeds", "1", "--no-solo",
                                "--name", "mine", "--out", "out"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(read("out/scenarios/crossings/p.csv"), read("crossings/p.csv"));
    write("crossings/p.csv", header() + "A,1,,,,,,8,,,,\n");
    const Ended other = clearway({"run", "./crossings", "--policy", "corridor", "--seeds", "1", "--no-solo",
                                  "--name", "mine", "--out", "out"});
    EXPECT_EQ(other.code, 3) << "other parameters, another study";
    EXPECT_THAT(other.err, HasSubstr("holds another study"));
}

TEST_F(SignalsTest, never_have_a_file_written_over) {
    write("p.csv", "mine");
    const Ended ended =
        clearway({"scenario", "signals", "./crossings", "--out", "p.csv", "--svg", "map.svg"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, HasSubstr("exists already"));
    EXPECT_EQ(read("p.csv"), "mine");
    EXPECT_FALSE(std::filesystem::exists(folder() / "map.svg")) << "nothing half done";
}

TEST_F(SignalsTest, that_a_scenario_does_not_have_are_said_to_be_missing) {
    const Ended ended = clearway({"scenario", "signals", "rural", "--out", "r.csv"});
    EXPECT_EQ(ended.code, 0);
    EXPECT_THAT(ended.err,
                HasSubstr("rural has no signals; r.csv holds the names of the columns and no row"));
    EXPECT_THAT(ended.err, Not(HasSubstr("name it in scenario.toml")));
}

TEST_F(SignalsTest, with_parameters_for_one_that_does_not_exist_are_refused_before_anything_is_written) {
    ASSERT_EQ(clearway({"scenario", "signals", "./crossings", "--out", "p.csv"}).code, 0);
    write("crossings/p.csv", header() + "C,1,,,,,,9,,,,\nA,,,100,,,,,,,,\n");
    write_scenario("B_east", "preemption = \"p.csv\"\n");
    const Ended ended =
        clearway({"run", "./crossings", "--policy", "corridor", "--seeds", "1", "--out", "out"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("p.csv:2: signal"), HasSubstr("no signal 'C'"),
                                 HasSubstr("p.csv:3: minimum_green_s"), HasSubstr("up to 90 s")));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out" / "scenarios" / "crossings"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out" / "manifest.json"));
}

TEST_F(SignalsTest, under_a_controller_that_sumo_does_not_know_are_refused_in_the_file_of_the_user) {
    const std::string network = read("crossings/net.net.xml");
    const std::size_t at = network.find("type=\"static\"");
    const auto line =
        1 + std::count(network.begin(), network.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    write("crossings/net.net.xml", std::string(network).replace(at, 13, "type=\"actuatd\""));
    const std::string place =
        fmt::format("./crossings/net.net.xml:{}: type=\"actuatd\" of signal \"A\"", line);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"scenario", "signals", "./crossings"},
          {"run", "./crossings", "--seeds", "1", "--out", "out"},
          {"scenario", "check", "./crossings"}}) {
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, 3);
        EXPECT_THAT(ended.err, AllOf(HasSubstr(place), HasSubstr("Did you mean 'actuated'?"),
                                     Not(HasSubstr("network.net.xml"))))
            << words.front();
    }
}

TEST_F(SignalsTest, whose_programs_have_no_type_are_run_as_fixed_time_ones) {
    std::string network = read("crossings/net.net.xml");
    network.erase(network.find("type=\"static\""), 13);
    write("crossings/net.net.xml", network);
    const Ended run =
        clearway({"run", "./crossings", "--policy", "none", "--seeds", "1", "--no-solo", "--out", "out"});
    EXPECT_EQ(run.code, 0) << run.err;
}

}  // namespace
}  // namespace clearway::cli
