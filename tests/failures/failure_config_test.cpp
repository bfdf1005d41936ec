#include "failures/failure_config.hpp"

#include <limits>

#include <gmock/gmock.h>

namespace clearway::failures {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

TEST(FailurePresets, AreThoseOfTheBenchmarkInItsOrder) {
    std::vector<std::string> names;
    for (const FailurePreset& preset : failure_presets()) {
        names.push_back(preset.name);
    }
    EXPECT_THAT(
        names, ElementsAre("perfect", "A.1", "A.2", "A.3", "A.4", "A.5", "A.6", "A.7", "B5", "B10", "B20",
                           "C.link", "C.range", "D1", "D3", "D5", "DL2", "D3B10", "B40", "D3M", "D5M", "R50",
                           "R0", "S0", "mixed", "Q10", "Q20", "Q30", "Q40", "Q50", "Q60", "Q70", "Q80", "Q90",
                           "range_75m", "range_150m", "range_300m", "range_600m", "range_10km"));
}

TEST(FailurePresets, HaveTheFrozenValues) {
    EXPECT_DOUBLE_EQ(failure_from("A.7").loss_rate, 0.7);
    EXPECT_DOUBLE_EQ(failure_from("A.7").dark_share, 0.0);
    EXPECT_DOUBLE_EQ(failure_from("B20").mean_outage_s, 20.0);
    EXPECT_DOUBLE_EQ(failure_from("B20").dark_share, 0.3);
    EXPECT_DOUBLE_EQ(failure_from("C.link").link_detection_rate, 0.5);
    EXPECT_DOUBLE_EQ(failure_from("C.link").mean_outage_s, 10.0);
    EXPECT_EQ(failure_from("C.link").detection, Detection::presence);
    EXPECT_EQ(failure_from("C.range").detection, Detection::range);
    EXPECT_DOUBLE_EQ(failure_from("C.range").range_sigma_m, 1.0);
    EXPECT_DOUBLE_EQ(failure_from("D5").position_sigma_m, 5.0);
    EXPECT_DOUBLE_EQ(failure_from("DL2").latency_s, 2.0);
    EXPECT_DOUBLE_EQ(failure_from("D3B10").position_sigma_m, 3.0);
    EXPECT_DOUBLE_EQ(failure_from("D3B10").dark_share, 0.3);
    EXPECT_DOUBLE_EQ(failure_from("perfect").report_interval_s, 0.0);
    EXPECT_EQ(failure_from("B40"), failure_from("B10,mean_outage_s=40"));
    EXPECT_EQ(failure_from("D3M"), failure_from("D3,heading_sigma_deg=5,map_matching=nearest"));
    EXPECT_EQ(failure_from("D5M"), failure_from("D5,heading_sigma_deg=5,map_matching=nearest"));
    EXPECT_EQ(failure_from("R50"), failure_from("route_share=0.5"));
    EXPECT_EQ(failure_from("R0"), failure_from("route_share=0"));
    EXPECT_EQ(failure_from("S0"), failure_from("signals_known=0"));
    EXPECT_EQ(failure_from("mixed"), failure_from("B20,position_sigma_m=3,heading_sigma_deg=5,"
                                                  "map_matching=nearest,route_share=0.5"));
}

TEST(FailurePresets, AreAllValid) {
    for (const FailurePreset& preset : failure_presets()) {
        EXPECT_TRUE(problems_of(preset.config, preset.name).empty()) << preset.name;
    }
}

TEST(FailurePresets, NameTheNearestOfAnUnknownOne) {
    try {
        failure_from("C.lnk");
        FAIL() << "accepted";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("Did you mean 'C.link'?"));
        EXPECT_THAT(error.what(), HasSubstr("D3B10"));
    }
}

TEST(FailureText, ChangesFieldsOfAPresetOrOfReportsThatNeverFail) {
    FailureConfig darker = failure_from("B10");
    darker.dark_share = 0.5;
    darker.exits = Exits::unknown;
    EXPECT_EQ(failure_from("B10,dark_share=0.5,exits=unknown"), darker);
    EXPECT_EQ(failure_from(" B10 , exits = unknown, dark_share = 0.5 "), darker);
    FailureConfig partly;
    partly.connected_share = 0.3;
    EXPECT_EQ(failure_from("connected_share=0.3"), partly);
}

/// The message with which a failure is refused.
std::string refusal(const char* text) {
    try {
        failure_from(text);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(FailureText, IsRefusedWithAllThatIsWrong) {
    EXPECT_THAT(refusal("perfect,loss_rate=0.1"),
                HasSubstr("Add report_interval_s=1 to the failure, or --set failure.report_interval_s=1"));
    EXPECT_THAT(refusal("B10,dark_shore=0.5"), HasSubstr("Did you mean 'dark_share'?"));
    EXPECT_THAT(refusal("B10,dark_share=half"), HasSubstr("failure.dark_share: \"half\" is not a number"));
    EXPECT_THAT(refusal("B10,dark_share="), HasSubstr("a number"));
    EXPECT_THAT(refusal("B10,exits=maybe"), HasSubstr("known, unknown"));
    EXPECT_THAT(refusal("B10,dark_share=0.1,dark_share=0.2"), HasSubstr("occurs twice"));
    EXPECT_THAT(refusal("dark_share=0.1,B10"), HasSubstr("one preset of reports, at the front"));
    EXPECT_THAT(refusal("B10,"), HasSubstr("'' is not a failure preset"));
    EXPECT_THAT(refusal(""), HasSubstr("'' is not a failure preset"));
    EXPECT_THAT(refusal("B10,dark_share=1.5"), HasSubstr("1.5 is out of range"));
    EXPECT_THAT(refusal("B10,dark_share=nan"), HasSubstr("out of range"));
    EXPECT_THAT(refusal("B10,dark_share=0.5,mean_outage_s=1"), HasSubstr("too short"));
    EXPECT_THAT(refusal("B1O,dark_shore=1"), ::testing::AllOf(HasSubstr("'B1O'"), HasSubstr("dark_shore")));
}

TEST(FailureText, CombinesPresetsOfRequestsWithOneOfReports) {
    EXPECT_EQ(failure_from("Q50"), failure_from("signal_request_propagation=sharp,signal_request_range_m="
                                                "10000,signal_request_loss_rate=0.5"));
    EXPECT_EQ(failure_from("perfect,range_150m"),
              failure_from("perfect,signal_request_propagation=los,signal_request_range_m=150"));
    EXPECT_EQ(failure_from("B10,Q30,range_75m"),
              failure_from("B10,signal_request_propagation=los,signal_request_range_m=75,"
                           "signal_request_loss_rate=0.3"));
    EXPECT_EQ(failure_from("range_75m,Q30"), failure_from("Q30,range_75m"));
    EXPECT_EQ(failure_from("Q30,signal_request_latency_s=2").SignalRequestChannel::latency_s, 2.0);
    EXPECT_EQ(failure_from("Q90").RequestChannel::propagation, Propagation::perfect) << "vehicles hear all";
}

TEST(FailureText, RefusesPresetsThatDoNotCombine) {
    EXPECT_THAT(refusal("B10,B20"), HasSubstr("the preset 'B20' after other items"));
    EXPECT_THAT(refusal("Q10,Q20"), HasSubstr("the preset 'Q20' after other items"));
    EXPECT_THAT(refusal("range_75m,range_150m"), HasSubstr("one of range of requests"));
    EXPECT_THAT(refusal("Q10,B10"), HasSubstr("one preset of reports, at the front"));
    EXPECT_THAT(refusal("signal_request_latency_s=2,Q10"), HasSubstr("then fields"));
    EXPECT_THAT(refusal("Q55"), HasSubstr("'Q55' is not a failure preset"));
    EXPECT_THAT(refusal("Q50,signal_request_loss_rate=1.2"), HasSubstr("1.2 is out of range"));
    EXPECT_THAT(refusal("Q50,signal_request_latency_s=-1"), HasSubstr("-1 is out of range"));
}

TEST(FailureConfig, RefusesPartsOfAnErrorThatIsNotThere) {
    EXPECT_THAT(refusal("B10,position_correlation_s=5"), HasSubstr("Give position_sigma_m"));
    EXPECT_THAT(refusal("B10,speed_correlation_s=5"), HasSubstr("Give speed_sigma_mps"));
    EXPECT_THAT(refusal("C.link,range_sigma_m=1"), HasSubstr("Give detection=range"));
    EXPECT_THAT(refusal("perfect,roadside_range_m=50"), HasSubstr("drawn for each report"));
    EXPECT_THAT(refusal("perfect,onboard_range_m=50"), HasSubstr("drawn for each report"));
    EXPECT_EQ(refusal("D3,position_correlation_s=5"), "accepted");
    for (const char* const part :
         {"heading_sigma_deg=5", "map_matching=nearest", "route_share=0.5", "signals_known=0"}) {
        EXPECT_THAT(refusal((std::string("perfect,") + part).c_str()), HasSubstr("drawn for each report"));
    }
    EXPECT_THAT(refusal("signals_known=2"), HasSubstr("0, 1"));
    EXPECT_THAT(refusal("map_matching=guess"), HasSubstr("exact, nearest"));
}

TEST(FailureConfig, RefusesEachNewPartOutOfItsRange) {
    const auto refused = [](double FailureConfig::*member, double value) {
        FailureConfig config;
        config.*member = value;
        return problems_of(config, "f").size() == 1;
    };
    EXPECT_TRUE(refused(&FailureConfig::connected_share, 1.01));
    EXPECT_TRUE(refused(&FailureConfig::connected_share, -0.1));
    EXPECT_TRUE(refused(&FailureConfig::roadside_range_m, -1.0));
    EXPECT_TRUE(refused(&FailureConfig::roadside_sigma_m, -1.0));
    EXPECT_TRUE(refused(&FailureConfig::onboard_range_m, 1001.0));
    EXPECT_TRUE(refused(&FailureConfig::onboard_sigma_m, -0.5));
    EXPECT_TRUE(refused(&FailureConfig::speed_correlation_s, -1.0));
    EXPECT_TRUE(refused(&FailureConfig::link_detection_range_m, -1.0));
    EXPECT_TRUE(refused(&FailureConfig::heading_sigma_deg, 91.0));
    EXPECT_TRUE(refused(&FailureConfig::route_share, 1.1));
    EXPECT_TRUE(refused(&FailureConfig::route_share, -0.1));
}

TEST(FailureConfig, RefusesOcclusionWhereNobodyLooks) {
    FailureConfig config;
    config.occlusion = Occlusion::considered;
    ASSERT_THAT(problems_of(config, "f"), SizeIs(1));
    config.onboard_range_m = 50.0;
    EXPECT_THAT(problems_of(config, "f"), SizeIs(0));
}

TEST(FailureConfig, ReportsEveryValueOutOfItsRangeAtOnce) {
    FailureConfig config;
    config.loss_rate = 1.5;
    config.latency_s = -1.0;
    config.position_sigma_m = std::numeric_limits<double>::quiet_NaN();
    const auto problems = problems_of(config, "study.toml: failure");
    ASSERT_THAT(problems, SizeIs(3));
    EXPECT_EQ(problems[0].where, "study.toml: failure.loss_rate");
    EXPECT_THAT(problems[0].what, HasSubstr("1.5"));
    EXPECT_EQ(problems[0].allowed, "0 to 1");
    EXPECT_EQ(problems[2].allowed, "0 to 60 s");
}

TEST(FailureConfig, RefusesValuesThatDoNotGoTogether) {
    FailureConfig too_frequent;
    too_frequent.report_interval_s = 0.05;
    EXPECT_THAT(problems_of(too_frequent, "f"), SizeIs(1));

    FailureConfig perfect_but_lossy = failure_from("perfect");
    perfect_but_lossy.loss_rate = 0.1;
    EXPECT_THAT(problems_of(perfect_but_lossy, "f"), SizeIs(1));

    FailureConfig perfect_but_partly_connected = failure_from("perfect");
    perfect_but_partly_connected.connected_share = 0.5;
    EXPECT_THAT(problems_of(perfect_but_partly_connected, "f"), SizeIs(1));

    FailureConfig perfect_but_out_of_reach = failure_from("perfect");
    perfect_but_out_of_reach.dark_commands = DarkCommands::lost;
    EXPECT_THAT(problems_of(perfect_but_out_of_reach, "f"), SizeIs(1));

    FailureConfig too_short;
    too_short.dark_share = 0.5;
    too_short.mean_outage_s = 1.9;
    ASSERT_THAT(problems_of(too_short, "f"), SizeIs(1));
    EXPECT_THAT(problems_of(too_short, "f")[0].allowed, HasSubstr("= 2 s"));
    too_short.mean_outage_s = 2.0;
    EXPECT_THAT(problems_of(too_short, "f"), SizeIs(0));
}

std::string refusal_of(const std::string& text) {
    try {
        failure_from(text);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(RequestChannel, ReadsItsFieldsBesideAPreset) {
    const RequestChannel channel =
        failure_from("B10,request_propagation=los,request_range_m=120,request_hops=2,request_latency_s=0.1");
    EXPECT_EQ(channel.propagation, Propagation::los);
    EXPECT_DOUBLE_EQ(channel.range_m, 120.0);
    EXPECT_EQ(channel.hops, 2);
    EXPECT_DOUBLE_EQ(channel.latency_s, 0.1);
    EXPECT_EQ(failure_from("B10").SignalRequestChannel::propagation, Propagation::perfect);
    const FailureConfig both = failure_from("request_propagation=nlos,signal_request_propagation=los");
    EXPECT_EQ(both.RequestChannel::propagation, Propagation::nlos);
    EXPECT_EQ(both.SignalRequestChannel::propagation, Propagation::los);
    EXPECT_DOUBLE_EQ(both.RequestChannel::range_m, 300.0);
    EXPECT_DOUBLE_EQ(both.SignalRequestChannel::range_m, 500.0);
}

TEST(RequestChannel, OfNoReachIsRefusedLikeAnyOtherOutsideTheRange) {
    for (const char* const reach : {"0", "-5", "10001"}) {
        const std::string setting = std::string("request_propagation=sharp,request_range_m=") + reach;
        EXPECT_THAT(refusal_of(setting),
                    AllOf(HasSubstr("request_range_m: " + std::string(reach) + " is out of range"),
                          HasSubstr("allowed: 1 to 10000 m"), HasSubstr("Give another number")));
    }
    EXPECT_THAT(refusal_of("signal_request_propagation=nlos,signal_request_range_m=0"),
                HasSubstr("signal_request_range_m: 0 is out of range (allowed: 1 to 10000 m)"));
}

TEST(RequestChannel, ThatIsPerfectTakesNoOtherSetting) {
    EXPECT_THAT(refusal_of("request_loss_rate=0.2"),
                AllOf(HasSubstr("failure.request_propagation"), HasSubstr("is perfect"),
                      HasSubstr("sharp, los, nlos"), HasSubstr("leave the other settings out")));
    EXPECT_THAT(refusal_of("signal_request_latency_s=1"), HasSubstr("failure.signal_request_propagation"));
    EXPECT_EQ(refusal_of("B10,emergency_dark=no"), "");
}

TEST(RequestChannel, RefusesWhatIsOutOfRangeOrContradictory) {
    EXPECT_THAT(refusal_of("request_propagation=sharp,request_hops=0"),
                AllOf(HasSubstr("request_hops"), HasSubstr("1 to 5")));
    EXPECT_THAT(refusal_of("request_propagation=sharp,request_hops=1.5"), HasSubstr("a whole number"));
    EXPECT_THAT(refusal_of("request_propagation=sharp,request_hops=99999999999"),
                HasSubstr("99999999999 is out of range (allowed: 1 to 5)"));
    EXPECT_THAT(refusal_of("request_propagation=sharp,request_loss_rate=1.1"), HasSubstr("0 to 1"));
    EXPECT_THAT(refusal_of("request_propagation=far"), HasSubstr("perfect, sharp, los, nlos"));
    EXPECT_THAT(refusal_of("request_propagation=sharp,request_dark_share=0.9,request_mean_outage_s=4"),
                AllOf(HasSubstr("request_mean_outage_s"), HasSubstr("4 is too short for a dark share of 0.9"),
                      HasSubstr("= 5 s")));
}

TEST(RequestChannel, NeedsNoReportsThatFail) {
    EXPECT_EQ(refusal_of("perfect,request_propagation=sharp,request_range_m=50"), "");
    EXPECT_FALSE(reports_fail(failure_from("perfect,request_propagation=sharp,request_range_m=50")));
    EXPECT_TRUE(reports_fail(failure_from("emergency_sensor_range_m=80")));
    EXPECT_TRUE(reports_fail(failure_from("B10")));
}

}  // namespace
}  // namespace clearway::failures
