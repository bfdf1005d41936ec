#include "experiment/settings.hpp"

#include <set>

#include <gmock/gmock.h>

#include "actuation/actuator_config.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "drivers/config.hpp"
#include "experiment/related_conditions.hpp"
#include "experiment/settings_page.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::experiment {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

ConditionSpec corridor() {
    ConditionSpec condition;
    condition.name = "corridor";
    condition.policies = {"corridor"};
    return condition;
}

std::string problems_of(const ConditionSpec& condition) {
    std::string text;
    for (const core::Problem& problem : check_settings(condition, "condition: "))
        text += core::format_problem(problem) + "\n";
    return text;
}

std::string problems_of(const std::string& name, const std::string& value) {
    ConditionSpec condition = corridor();
    set(condition, name, value);
    return problems_of(condition);
}

TEST(Settings, of_an_unknown_component_are_taken_for_those_of_the_part_in_python) {
    const std::vector<core::Problem> found = check_setting("Q.within_m", "80", "--set ", {"Mine"});
    ASSERT_THAT(found, testing::SizeIs(1));
    EXPECT_EQ(found[0].cure, "Did you mean 'Mine.within_m'?");
    EXPECT_THAT(check_setting("Q.within_m", "80", "").at(0).cure, testing::Not(testing::HasSubstr("Mine")));
}

TEST(Settings, HaveDefaultsThatTheirOwnTablesAllow) {
    std::set<std::string> names;
    for (const Component& component : components()) {
        EXPECT_THAT(component.table.rows, testing::Not(IsEmpty())) << component.name;
        for (const core::SettingInfo& row : component.table.rows) {
            const std::string name = component.name + "." + row.name;
            if (!names.insert(name).second) {
                ADD_FAILURE() << name << " stands there twice; a base of its config may have it";
                continue;  // what is said of one would be said of the other
            }
            for (const core::Problem& problem : check_setting(name, row.preset, ""))
                ADD_FAILURE() << "the default of " << name << " is refused: " << problem.what
                              << " (allowed: " << problem.allowed << ")";
            EXPECT_FALSE(row.doc.empty()) << name;
            EXPECT_FALSE(row.source.empty()) << name << " has no reason";
            const bool is_text = name == "actuation.equipped";
            if (is_text || !row.words.empty()) continue;
            EXPECT_LT(row.minimum, row.maximum) << name;
            EXPECT_EQ(check_setting(name, fmt::format("{}", 2.0 * row.maximum + 1.0), "").size(), 1U)
                << name << " has no upper bound";
        }
    }
    EXPECT_TRUE(names.contains("preempt_signals.lead_s"));
    EXPECT_TRUE(names.contains("graphsage.link_threshold"));
    EXPECT_TRUE(names.contains("kalman.along_psd"));
    EXPECT_TRUE(names.contains("actuation.hold_cap_s"));
    EXPECT_TRUE(names.contains("siren.compliance"));
    EXPECT_TRUE(names.contains("loop.policy_period_s"));
    EXPECT_TRUE(names.contains("failure.dark_share"));
}

TEST(Settings, OfEveryPartThatAConditionHasAreAccepted) {
    ConditionSpec condition = corridor();
    condition.predictor = "graphsage";
    for (const std::string& component : components_of(condition)) {
        if (component == "failure") continue;  // its fields depend on each other
        for (const Component& known : components()) {
            if (known.name != component) continue;
            for (const core::SettingInfo& row : known.table.rows)
                set(condition, component + "." + row.name, row.preset);
        }
    }
    for (const std::string part : {"clear_lane", "give_way"}) {
        set(condition, part + ".ask", "linked");    // without it, how it asks the linked has no effect
        set(condition, part + ".ask_humans", "1");  // without it, settings of drivers who are asked have none
    }
    set(condition, "requests.compliance", "0.5");
    EXPECT_THAT(problems_of(condition), IsEmpty());
    EXPECT_THAT(
        components_of(condition),
        testing::ElementsAre("loop", "failure", "graphsage", "preempt_signals", "recover_signals",
                             "clear_lane", "give_way", "actuation", "siren", "requests", "privilege"));
}

TEST(Settings, ThatCannotBeNameTheNearest) {
    EXPECT_THAT(problems_of("preempt_signals.leed_s", "12"), HasSubstr("Did you mean 'lead_s'?"));
    EXPECT_THAT(problems_of("preemt_signals.lead_s", "12"),
                HasSubstr("Did you mean 'preempt_signals.lead_s'?"));
    EXPECT_THAT(problems_of("lead_s", "12"), HasSubstr("Did you mean 'preempt_signals.lead_s'?"));
    EXPECT_THAT(check_setting("give_wy.near_m", "5", "").at(0).cure, HasSubstr("'give_way.near_m'"))
        << "the nearest component first: others have settings of this name";
    EXPECT_THAT(check_setting("vacatelane.horizn_m", "5", "").at(0).cure,
                HasSubstr("'vacate_lane.horizon_m'"));
    EXPECT_THAT(problems_of("preempt_signals.lead_s", "99"),
                testing::AllOf(HasSubstr("preempt_signals.lead_s: 99 is out of range"),
                               HasSubstr("0 to 60 s"), HasSubstr("or leave it out for")));
    EXPECT_THAT(problems_of("preempt_signals.lead_s", "soon"), HasSubstr("\"soon\" is not a number"));
    EXPECT_THAT(problems_of("recover_signals.change_vehicles", "2.5"),
                HasSubstr("2.5 is not a whole number"));
    EXPECT_THAT(problems_of("green_wave.before_s", "5"),
                HasSubstr("is a setting of green_wave, which the condition does not have"));
    EXPECT_THAT(problems_of("kalman.link_threshold", "0.4"),
                testing::AllOf(HasSubstr("kalman, which the condition does not have"),
                               HasSubstr("Did you mean 'none.link_threshold'?")));
    EXPECT_THAT(problems_of("preempt_signals.lead_s", "nan"), HasSubstr("out of range"));
}

TEST(Settings, OfALeaseThatIsShorterThanTwoPolicyPeriodsAreRefused) {
    EXPECT_THAT(problems_of("clear_lane.lease_s", "1"), IsEmpty());
    EXPECT_THAT(problems_of("clear_lane.lease_s", "0.6"),
                testing::AllOf(HasSubstr("clear_lane.lease_s: 0.6 s is shorter than two policy periods"),
                               HasSubstr("loop.policy_period_s is 0.5 s"), HasSubstr("at least 1 s"),
                               HasSubstr("or loop.policy_period_s to 0.3 or less")));
    ConditionSpec slow = corridor();
    set(slow, "loop.policy_period_s", "2");
    EXPECT_THAT(problems_of(slow), IsEmpty()) << "a lease that nobody set lasts two periods";
    set(slow, "recover_signals.lease_s", "3");
    EXPECT_THAT(problems_of(slow), HasSubstr("Set recover_signals.lease_s to 4 or more"));
}

TEST(Settings, OfLinksThatNobodyAsksByAreRefused) {
    EXPECT_THAT(
        problems_of("clear_lane.ask_probability", "0.8"),
        testing::AllOf(HasSubstr("clear_lane.ask_probability: has no effect"),
                       HasSubstr("clear_lane.ask=linked"), HasSubstr("Set clear_lane.ask to linked")));
    ConditionSpec linked = corridor();
    set(linked, "clear_lane.ask", "linked");
    set(linked, "clear_lane.ask_probability", "0.8");
    EXPECT_THAT(problems_of(linked), IsEmpty());
    set(linked, "clear_lane.ask_hops", "2");
    EXPECT_THAT(problems_of(linked), testing::AllOf(HasSubstr("two automated vehicles are never linked"),
                                                    HasSubstr("Set loop.automated_links to 1")));
    set(linked, "loop.automated_links", "1");
    EXPECT_THAT(problems_of(linked), IsEmpty());
    set(linked, "clear_lane.ask", "nobody");
    EXPECT_THAT(problems_of(linked), HasSubstr("everyone, linked"));
}

TEST(Settings, OfConditionsThatReadLinksTellThem) {
    ConditionSpec condition = corridor();
    EXPECT_FALSE(reads_links(condition));
    set(condition, "clear_lane.ask", "linked");
    EXPECT_TRUE(reads_links(condition));
    condition.policies = {"preempt_signals"};
    EXPECT_FALSE(reads_links(condition));
    condition.policies = {"dissertation"};
    EXPECT_TRUE(reads_links(condition));
}

TEST(Settings, OfAnOracleLeaveNoFaultsOfReportsUnused) {
    ConditionSpec condition = corridor();
    condition.predictor = "oracle";
    set(condition, "oracle.links_kept", "0.5");
    EXPECT_THAT(problems_of(condition), IsEmpty());
    condition.failure = "perfect,request_propagation=sharp";
    EXPECT_THAT(problems_of(condition), IsEmpty()) << "requests may fail";
    condition.failure = "B10";
    EXPECT_THAT(problems_of(condition),
                testing::AllOf(HasSubstr("'B10' degrades reports, but oracle does not use reports"),
                               HasSubstr("clearway list settings oracle")));
}

TEST(Settings, OfASoloConditionAreRefused) {
    ConditionSpec solo;
    solo.traffic_model = TrafficModel::free_flow;
    set(solo, "loop.policy_period_s", "1");
    EXPECT_THAT(problems_of(solo), HasSubstr("alone on the road"));
}

TEST(Settings, OfAFailureBecomeAPartOfIt) {
    ConditionSpec condition = corridor();
    condition.failure = "B10";
    set(condition, "failure.dark_share", "0.50");
    EXPECT_EQ(condition.failure, "B10,dark_share=0.5");
    set(condition, "failure.exits", "unknown");
    set(condition, "failure.dark_share", "0.7");
    EXPECT_EQ(condition.failure, "B10,dark_share=0.7,exits=unknown");
    EXPECT_THAT(condition.settings, IsEmpty());
}

TEST(Settings, OfOneValueAreOneTextHoweverItIsSpelled) {
    ConditionSpec one = corridor();
    ConditionSpec other = corridor();
    set(one, "preempt_signals.lead_s", "12.0");
    set(other, "preempt_signals.lead_s", "12");
    EXPECT_EQ(one, other);
}

TEST(Settings, ReachTheConfigurations) {
    ConditionSpec condition = corridor();
    set(condition, "loop.link_radius_m", "80");
    set(condition, "actuation.hold_cap_s", "30");
    set(condition, "siren.compliance", "0.25");
    EXPECT_DOUBLE_EQ(loop_config(condition).link_radius_m, 80.0);
    EXPECT_DOUBLE_EQ(loop_config(condition).policy_period_s, 0.5);
    EXPECT_DOUBLE_EQ(actuator_config(condition, {}).hold_cap_s, 30.0);
    const traffic::SirenConfig siren = siren_config(condition, {.compliance = 1.0, .audible_m = 77.0});
    EXPECT_DOUBLE_EQ(siren.compliance, 0.25);
    EXPECT_DOUBLE_EQ(siren.audible_m, 77.0);
    set(condition, "loop.policy_period_s", "99");
    EXPECT_THROW(loop_config(condition), core::InputError);
}

TEST(Settings, TakeTheSignalsThatAreEquippedAsIdsSeparatedByCommas) {
    EXPECT_THAT(problems_of("actuation.equipped", "A,B"), IsEmpty());
    EXPECT_THAT(problems_of("actuation.equipped", "none"), IsEmpty());
    EXPECT_THAT(problems_of("actuation.equipped", "A,,B"), HasSubstr("\"A,,B\" has an empty id"));
    EXPECT_THAT(problems_of("actuation.equipped", ""), HasSubstr("has an empty id"));
    EXPECT_THAT(problems_of("actuation.equipped", "A,B,A"), HasSubstr("names signal \"A\" twice"));
    EXPECT_THAT(problems_of("actuation.equiped", "A"), HasSubstr("Did you mean 'equipped'?"));
    ConditionSpec condition = corridor();
    set(condition, "actuation.equipped", "A");
    set(condition, "actuation.hold_cap_s", "30");
    EXPECT_DOUBLE_EQ(actuator_config(condition, {}).hold_cap_s, 30.0) << "beside the numbers";
}

TEST(Settings, OfLinksMustFitTheModelOfTheirPredictor) {
    ConditionSpec condition = corridor();
    condition.predictor = "graphsage_corrected";
    condition.settings["loop.link_radius_m"] = "200";
    const std::vector<core::Problem> problems = check_settings(condition, "");
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems[0].where, "loop.link_radius_m with predictor graphsage_corrected");
    EXPECT_NE(problems[0].allowed.find("50 m"), std::string::npos);
    condition.predictor = "graphsage";
    EXPECT_TRUE(check_settings(condition, "").empty());
}

TEST(Settings, NameAConditionAfterWhatItIs) {
    ConditionSpec condition = corridor();
    EXPECT_EQ(described_name(condition), "corridor");
    condition.failure = "B10";
    condition.predictor = "graphsage";
    EXPECT_EQ(described_name(condition), "corridor_B10_graphsage");
    set(condition, "preempt_signals.lead_s", "12");
    EXPECT_EQ(described_name(condition), "corridor_B10_graphsage_lead_s_12");
    EXPECT_EQ(settings_text(condition), "preempt_signals.lead_s=12");
    ConditionSpec alike = corridor();
    set(alike, "clear_lane.horizon_m", "100");
    set(alike, "preempt_signals.horizon_m", "300");
    EXPECT_EQ(described_name(alike), "corridor_clear_lane.horizon_m_100_preempt_signals.horizon_m_300");
    set(condition, "failure.dark_share", "0.5");
    EXPECT_THAT(described_name(condition), testing::StartsWith("corridor_B10_dark_share_0.5_"));
    for (const char* const name : {"lead_per_halted_s", "longest_lead_s", "slowest_share", "halted_mps"})
        set(condition, std::string("preempt_signals.") + name, "1");
    EXPECT_LE(described_name(condition).size(), 80U);
}

TEST(Settings, OfAModelKeepItsContent) {
    const support::TemporaryFolder folder;
    ConditionSpec condition = corridor();
    EXPECT_THROW(set_model(condition, (folder.path() / "none.weights").string(), "--model"),
                 core::InputError);
    const auto file = folder.write("net.weights", "no weights");
    set_model(condition, file.string(), "--model");
    EXPECT_THAT(problems_of(condition), HasSubstr("none is not learned and takes no model"));
    condition.predictor = "graphsage";
    EXPECT_THAT(problems_of(condition), HasSubstr("condition: model: "));
    EXPECT_EQ(checked_model(condition), file.string());
    const std::string before = condition.model_hash;
    folder.write("net.weights", "other weights");
    EXPECT_THROW(checked_model(condition), core::InputError);
    set_model(condition, file.string(), "--model");
    EXPECT_NE(condition.model_hash, before);
}

TEST(SettingsPage, OfAPolicyThatCombinesOthersHasTheirs) {
    const std::vector<Component> found = components_named("corridor");
    ASSERT_EQ(found.size(), 4U);
    const std::string text = settings_console(found);
    EXPECT_THAT(text, HasSubstr("  preempt_signals.lead_s = 8 s (0 to 60)\n"));
    EXPECT_THAT(text, HasSubstr("Why: "));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), 80U) << line;
    for (const auto& [name, cure] :
         {std::pair("corridr", "Did you mean 'corridor'?"),
          std::pair("Leave", "of a class in Python they are the arguments of its __init__")}) {
        try {
            components_named(name);
            FAIL();
        } catch (const core::InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr(cure));
        }
    }
}

TEST(SettingsPage, HasALineForEachSettingOfAPart) {
    const std::string text = settings_lines(components_named("preempt_signals"));
    EXPECT_THAT(text, testing::ContainsRegex("\n  preempt_signals.lead_s +8 s +0 to 60\n"));
    EXPECT_THAT(text, testing::ContainsRegex("\n  preempt_signals.memory +forget +forget, hold_eta, "));
    for (const Component& component : components()) {
        const std::string lines = settings_lines({component});
        std::size_t rows = 0;
        for (std::size_t at = 0; (at = lines.find("\n  " + component.name + ".", at)) != std::string::npos;
             ++at)
            ++rows;
        EXPECT_EQ(rows, component.table.rows.size()) << component.name;
        EXPECT_LE(std::ranges::count(lines, '\n'), 60) << component.name << " does not fit on a page";
    }
}

TEST(SettingsPage, OfACombinationPointsToItsParts) {
    const std::string text = settings_of_parts("corridor", components_named("corridor"));
    EXPECT_THAT(text, testing::StartsWith("corridor: no settings of its own"));
    EXPECT_THAT(text, testing::ContainsRegex("give_way +[0-9]+ settings: clearway list settings give_way\n"));
    EXPECT_THAT(text, testing::Not(HasSubstr("lead_s")));
}

TEST(SettingsPage, ListsASettingThatPartsShareOnce) {
    const std::string text = settings_lines(components());
    std::set<std::string> names;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("  ")) continue;
        const std::string name = line.substr(2, line.find(' ', 2) - 2);
        EXPECT_TRUE(names.insert(name).second) << name << " is listed twice";
    }
    EXPECT_TRUE(names.contains("PART.lease_s"));
}

TEST(Settings, AComplianceOutsideZeroToOneIsRefused) {
    EXPECT_THAT(problems_of("requests.compliance", "1.5"),
                testing::AllOf(HasSubstr("requests.compliance: 1.5 is out of range"), HasSubstr("0 to 1")));
    EXPECT_THAT(problems_of("requests.compliance", "-0.1"), HasSubstr("out of range"));
}

TEST(Settings, OfDriversWhomNobodyAsksAreRefused) {
    ConditionSpec condition = corridor();
    set(condition, "requests.hearing_m", "50");
    EXPECT_THAT(
        problems_of(condition),
        testing::AllOf(HasSubstr("requests.hearing_m: has no effect, because no human driver is asked"),
                       HasSubstr("1 for one of clear_lane.ask_humans, give_way.ask_humans"),
                       HasSubstr("Set clear_lane.ask_humans to 1, or remove requests.hearing_m")));
    condition.policies = {"preempt_signals"};
    EXPECT_THAT(problems_of(condition), HasSubstr("Remove requests.hearing_m"));
    condition.policies = {"corridor"};
    set(condition, "requests.compliance", "0.5");
    set(condition, "give_way.ask_humans", "1");
    EXPECT_THAT(problems_of(condition), IsEmpty());
    condition.policies = {"my_policy.py:Yield"};
    condition.settings.erase("give_way.ask_humans");
    EXPECT_THAT(problems_of(condition), IsEmpty()) << "a part in Python may ask them";
}

TEST(Settings, ThatAskDriversOfWhomNobodyCompliesAreRefused) {
    EXPECT_THAT(
        problems_of("clear_lane.ask_humans", "1"),
        testing::AllOf(HasSubstr("clear_lane.ask_humans: is 1, but no driver complies"),
                       HasSubstr("Set requests.compliance above 0, or remove clear_lane.ask_humans")));
    EXPECT_THAT(problems_of("clear_lane.ask_humans", "0"), IsEmpty());
}

/// The problems of a part with this fault and these settings.
std::string problems_of_requests(const std::string& part, const std::string& failure,
                                 const core::Settings& settings = {}) {
    ConditionSpec condition;
    condition.policies = {part};
    condition.failure = failure;
    condition.settings = settings;
    return problems_of(condition);
}

TEST(Settings, OfRequestsThatEndBeforeTheyArriveAreRefused) {
    const std::string late = "perfect,request_propagation=sharp,request_latency_s=";
    EXPECT_THAT(problems_of_requests("vacate_lane", late + "1.9"), IsEmpty());
    EXPECT_THAT(
        problems_of_requests("vacate_lane", late + "2"),
        testing::AllOf(HasSubstr("failure.request_latency_s: 2 s times request_hops=1 is 2 s, but requests "
                                 "of vacate_lane live 2 s"),
                       HasSubstr("below 2 s"), HasSubstr("Set vacate_lane.lease_s above 2")));
    EXPECT_THAT(problems_of_requests("vacate_lane", late + "1,request_hops=2"), HasSubstr("below 1 s"));
    EXPECT_THAT(problems_of_requests("dissertation", late + "2"), HasSubstr("requests of dissertation"));
    EXPECT_THAT(problems_of_requests("corridor", late + "2"),
                testing::AllOf(HasSubstr("clear_lane"), HasSubstr("give_way")));
    EXPECT_THAT(problems_of_requests("geocast", late + "9"), IsEmpty()) << "its requests live 10 s";
    EXPECT_THAT(problems_of_requests("vacate_lane", late + "5", {{"vacate_lane.lease_s", "6"}}), IsEmpty());
    EXPECT_THAT(problems_of_requests("vacate_lane", late + "5", {{"loop.policy_period_s", "3"}}), IsEmpty())
        << "a lease that nobody set lasts two periods";
    for (const std::string part : {"preempt_signals", "red_privilege", "listing_5_5"})
        EXPECT_THAT(problems_of_requests(part, late + "9"), IsEmpty()) << "no requests to vehicles";
}

TEST(Settings, OfRequestsThatEndBeforeTheNextMessageAreRefused) {
    const std::string seldom = "perfect,request_propagation=sharp,request_interval_s=";
    EXPECT_THAT(problems_of_requests("vacate_lane", seldom + "2"), IsEmpty());
    EXPECT_THAT(
        problems_of_requests("vacate_lane", seldom + "3"),
        testing::AllOf(HasSubstr("failure.request_interval_s: 3 s, but requests of vacate_lane live 2 s"),
                       HasSubstr("up to 2 s"), HasSubstr("Set vacate_lane.lease_s to 3 or more")));
    EXPECT_THAT(problems_of_requests("preempt_signals", seldom + "3"), IsEmpty());
}

TEST(Settings, APolicyThatNeedsTheSublaneModelIsRefusedWithoutIt) {
    ConditionSpec condition;
    condition.policies = {"rescue_lane"};
    EXPECT_THAT(problems_of(condition),
                testing::AllOf(HasSubstr("policy: rescue_lane needs vehicles with a place within their lane"),
                               HasSubstr("--traffic-model sublane")));
    condition.traffic_model = TrafficModel::sublane;
    EXPECT_THAT(problems_of(condition), IsEmpty());
}

TEST(Settings, PartsInPythonAreNotCopied) {
    for (const char* const setting : {"loop.ways_tried", "loop.holds_tried", "loop.units_tried"}) {
        ConditionSpec condition = corridor();
        condition.settings[setting] = "4";
        EXPECT_EQ(problems_of(condition), "") << setting;
        condition.policies.emplace_back("mine.py:Mine");
        EXPECT_THAT(
            problems_of(condition),
            testing::AllOf(HasSubstr(setting), HasSubstr("4 copies of a run are to be made, and a part in "
                                                         "Python cannot be copied")));
        condition.settings[setting] = "0";
        EXPECT_EQ(problems_of(condition), "") << setting;
    }
}

TEST(Settings, TheBestWayIsAmongThoseThatAreTried) {
    ConditionSpec condition = corridor();
    condition.settings["loop.best_way_taken"] = "1";
    EXPECT_THAT(problems_of(condition), HasSubstr("loop.best_way_taken: is 1, and no ways are tried"));
    condition.settings["loop.ways_tried"] = "4";
    EXPECT_EQ(problems_of(condition), "");
}

TEST(Settings, TheBestHoldIsAmongThoseThatAreTried) {
    ConditionSpec condition = corridor();
    condition.settings["loop.best_hold_taken"] = "1";
    EXPECT_THAT(problems_of(condition), HasSubstr("loop.best_hold_taken: is 1, and no holds are tried"));
    condition.settings["loop.holds_tried"] = "1";
    EXPECT_THAT(problems_of(condition), HasSubstr("loop.holds_tried: is 1, which tries no hold alone"));
    condition.settings["loop.holds_tried"] = "8";
    EXPECT_EQ(problems_of(condition), "");
    condition.settings["loop.others_price"] = "0.05";
    EXPECT_EQ(problems_of(condition), "");
    condition.settings.erase("loop.best_hold_taken");
    EXPECT_THAT(problems_of(condition), HasSubstr("loop.others_price: is 0.05, and no best hold is taken"));
    condition.settings.erase("loop.others_price");
    condition.policies.clear();
    EXPECT_THAT(problems_of(condition), HasSubstr("loop.holds_tried: is set where no policy asks signals"));
}

TEST(Settings, OfSumosDeviceNeedTheDevice) {
    ConditionSpec condition = corridor();
    condition.rerouting_signal_penalty = 1.0;
    EXPECT_THAT(problems_of(condition), HasSubstr("no vehicle has SUMO's rerouting device"));
    condition.rerouting_s = 30.0;
    EXPECT_EQ(problems_of(condition), "");
    EXPECT_EQ(to_text(process_of(condition)), "standard-penalty-1");
    EXPECT_THAT(described_name(condition), HasSubstr("rerouting_30s_penalty_1"));
}

TEST(Settings, OneAloneChoosesTheWay) {
    ConditionSpec condition = corridor();
    condition.policies = {"corridor", "navigate"};
    EXPECT_EQ(problems_of(condition), "");
    condition.rerouting_s = 5.0;
    EXPECT_THAT(problems_of(condition),
                AllOf(HasSubstr("rerouting_s: is 5: SUMO's rerouting device and navigate"),
                      HasSubstr("0 with navigate"), HasSubstr("Leave it out")));
}

TEST(Settings, WithoutFailureNothingFailsAndNothingIsRepaired) {
    ConditionSpec condition = corridor();
    EXPECT_EQ(without_failure(condition), condition) << "nothing fails in it";
    condition.failure = "B10";
    condition.predictor = "graphsage";
    set(condition, "failure.dark_share", "0.5");
    set(condition, "graphsage.link_threshold", "0.4");
    set(condition, "preempt_signals.lead_s", "12");
    condition.name = described_name(condition);
    const ConditionSpec perfect = without_failure(condition);
    EXPECT_EQ(perfect.failure, "perfect");
    EXPECT_EQ(perfect.predictor, "none");
    EXPECT_EQ(perfect.settings, (core::Settings{{"preempt_signals.lead_s", "12"}}));
    EXPECT_EQ(perfect.name, described_name(perfect));
    condition.failure = "perfect,dark_share=0.5";
    condition.name = "mine";
    EXPECT_EQ(without_failure(condition).name, "mine_perfect");
}

TEST(Settings, a_condition_without_its_failure_is_known_by_what_it_does) {
    ConditionSpec failing;
    failing.name = "mine";
    failing.policies = {"corridor"};
    failing.failure = "B10";
    failing.predictor = "kalman";
    failing.factors = {{"condition.failure", "B10"}};
    ConditionSpec working = failing;
    working.name = "other";
    working.failure = "perfect";
    working.factors = {{"condition.failure", "perfect"}};
    EXPECT_TRUE(is_without_failure(working, failing)) << "what is repaired does not count";
    EXPECT_FALSE(is_without_failure(failing, working));
    EXPECT_FALSE(is_without_failure(working, working));
    working.settings = {{"preempt_signals.lead_s", "12"}};
    EXPECT_FALSE(is_without_failure(working, failing));
    working.settings.clear();
    working.policies = {"preempt_signals"};
    EXPECT_FALSE(is_without_failure(working, failing));
}

TEST(Settings, PrivilegesAreOfTheEnvironmentSoTheBaselineHasThemToo) {
    ConditionSpec condition = corridor();
    set(condition, "privilege.pass_red", "1");
    const ConditionSpec baseline = baseline_for(condition);
    EXPECT_EQ(baseline.settings.at("privilege.pass_red"), "1");
    EXPECT_FALSE(baseline.acts());
    EXPECT_TRUE(same_environment(condition, baseline));
    EXPECT_FALSE(same_environment(condition, corridor()));
    EXPECT_EQ(privilege_config(condition, {}).pass_red, 1);
    EXPECT_EQ(privilege_config(corridor(), {.between_lanes = 1}).between_lanes, 1) << "as the scenario says";
}

}  // namespace
}  // namespace clearway::experiment
