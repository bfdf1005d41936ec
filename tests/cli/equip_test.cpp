// Which signals to equip first, as a user asks for it.
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "crossings.hpp"

namespace clearway::cli {
namespace {

/// Two crossings in a row, A and B, each with a signal; one emergency vehicle from west to east. It turns off
/// at A where `to` is a street there.
class EquipTest : public CrossingsTest {
  protected:
    Ended equip(std::vector<std::string> more, const std::string& folder = "out") const {
        std::vector<std::string> words = {"equip",   "./crossings", "--budget", "2",
                                          "--seeds", "5",           "--out",    folder};
        words.insert(words.end(), more.begin(), more.end());
        return clearway(words);
    }
    static double mean(const nlohmann::json& object, const std::string& name) {
        return object.at(name).at("mean").get<double>();
    }
};

TEST_F(EquipTest, ranks_signals_and_continues_in_its_folder_without_new_runs) {
    const Ended ended = equip({"--policy", "preempt_signals", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto json = nlohmann::json::parse(ended.out);
    EXPECT_EQ(json.at("signals"), 2);
    EXPECT_EQ(json.at("not_passed"), 0);
    EXPECT_DOUBLE_EQ(mean(json, "none_equipped_s"), mean(json, "baseline_s"))
        << "a policy for signals does nothing where none is equipped";
    EXPECT_LT(mean(json, "all_equipped_s"), mean(json, "none_equipped_s"));
    double so_far_s = 0.0;
    for (const auto& row : json.at("ranked")) {
        so_far_s += mean(row, "gain_s");
        EXPECT_NEAR(mean(row, "so_far_s"), so_far_s, 1e-9);
        EXPECT_GT(row.at("gain_s").at("low").get<double>(), 0.0);
    }
    EXPECT_EQ(json.at("ranked").empty() || json.at("end") != "budget", json.at("ranked").size() < 2);
    EXPECT_THAT(read("out/equip.json"), ended.out);
    EXPECT_THAT(read("out/equip.csv"), HasSubstr("equipped,number,signal"));
    EXPECT_THAT(read("out/curve.svg"), HasSubstr("<svg"));
    EXPECT_THAT(read("out/map.svg"), HasSubstr("Two crossings: signals to equip first"));
    const std::string run = "out/round-01/runs/crossings/baseline/00000/run.json";
    const auto made = std::filesystem::last_write_time(folder() / run);
    const Ended again = equip({"--policy", "preempt_signals"});
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(std::filesystem::last_write_time(folder() / run), made);
    EXPECT_EQ(read("out/equip.json"), ended.out);
    EXPECT_THAT(again.out, AllOf(HasSubstr("Two crossings"), HasSubstr("EV time s: baseline")));
}

TEST_F(EquipTest, leaves_out_signals_that_no_emergency_vehicle_passes_or_that_are_switched_off) {
    write_scenario("A_north_a");
    const auto turned = nlohmann::json::parse(equip({"--json"}).out);
    EXPECT_EQ(turned.at("not_passed"), 1);
    EXPECT_LE(turned.at("ranked").size(), 1U);
    ASSERT_EQ(clearway({"scenario", "signals", "./crossings", "--out", "p.csv"}).code, 0);
    const std::string text = read("p.csv");
    write("crossings/p.csv", text.substr(0, text.find('\n') + 1) + "A,0,,,,,,,,,,\n");
    write_scenario("A_north_a", "preemption = \"p.csv\"\n");
    const Ended none = equip({"--json"}, "off");
    ASSERT_EQ(none.code, 0) << none.err;
    const auto json = nlohmann::json::parse(none.out);
    EXPECT_EQ(json.at("switched_off"), 1);
    EXPECT_TRUE(json.at("ranked").empty());
    EXPECT_EQ(json.at("end"), "exhausted");
}

TEST_F(EquipTest, refuses_what_has_no_answer_and_leaves_nothing_behind) {
    const auto refused = [&](const std::vector<std::string>& words, int code, const std::string& message) {
        const Ended ended = clearway(words);
        EXPECT_EQ(ended.code, code) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(message));
        EXPECT_THAT(ended.out, IsEmpty());
        EXPECT_FALSE(std::filesystem::exists(folder() / "runs"));
    };
    refused({"equip", "./crossings"}, 2, "--budget");
    refused({"equip", "./crossings", "--budget", "0"}, 2, "--budget");
    refused({"equip", "./crossings", "--budget", "1.5"}, 2, "--budget");
    refused({"equip", "./crossings", "--budget", "-1"}, 2, "--budget");
    refused({"equip", "./crossings", "--budget", "1", "--seeds", "1"}, 2, "--seeds");
    refused({"equip", "./crossings", "--budget", "1", "--policy", "clear_lane"}, 3,
            "has no policy that requests green from signals");
    refused({"equip", "./crossings", "--budget", "1", "--condition", "baseline"}, 3,
            "has no policy that requests green from signals");
    refused({"equip", "./crossings", "--budget", "1", "--set", "actuation.equipped=A"}, 3,
            "is chosen by equip itself");
    write_line_scenario();
    refused({"equip", "line", "--budget", "1"}, 3, "has no signals");
}

TEST_F(EquipTest, refuses_a_folder_of_another_question) {
    ASSERT_EQ(equip({}).code, 0);
    const std::string before = read("out/equip.json");
    const Ended other = equip({"--seed", "9"});
    EXPECT_EQ(other.code, 3);
    EXPECT_THAT(other.err, HasSubstr("holds another study"));
    EXPECT_EQ(read("out/equip.json"), before);
}

TEST_F(EquipTest, has_a_setting_of_its_own_that_names_the_nearest_signal) {
    const Ended ended =
        clearway({"run", "./crossings", "--policy", "corridor", "--set", "actuation.equipped=A,C", "--name",
                  "mine", "--seeds", "1", "--out", "run"});
    EXPECT_EQ(ended.code, 3);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("actuation.equipped"), HasSubstr("no signal \"C\"")));
    EXPECT_FALSE(std::filesystem::exists(folder() / "run"));
}

}  // namespace
}  // namespace clearway::cli
