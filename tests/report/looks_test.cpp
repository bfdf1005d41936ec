// How conditions look: told apart by colour, dash and mark, by every reader, and none hidden behind another.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include <gmock/gmock.h>

#include "report/detail/figures.hpp"
#include "report/detail/style.hpp"
#include "report/page.hpp"
#include "report/sample.hpp"

namespace clearway::report::detail {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Triple = std::array<double, 3>;

/// The shape of a mark, without its place and colour.
std::string shape_of(std::size_t number) {
    const std::string mark = mark_of({number}, 0.0, 0.0, 4.0);
    return mark.substr(std::min(mark.size(), mark.find(" d=")));
}

std::string dash_of(std::size_t number) {
    const std::string style = line_style({number});
    return style.substr(std::min(style.size(), style.find(" d")));
}

TEST(Looks, of_twenty_conditions_differ_without_colour_and_of_sixty_with_it) {
    std::set<std::string> grey;
    std::set<std::string> coloured;
    for (std::size_t number = 1; number <= 60; ++number) {
        if (number <= 20) grey.insert(dash_of(number) + shape_of(number));
        coloured.insert(line_style({number}) + shape_of(number));
    }
    EXPECT_EQ(grey.size(), 20u);
    EXPECT_EQ(coloured.size(), 60u);
}

TEST(Looks, of_the_baseline_is_no_other_conditions) {
    EXPECT_EQ(line_style({0}), "line s0");
    EXPECT_EQ(mark_of({0}, 1.0, 1.0, 4.0), "");
    for (std::size_t number = 1; number <= 200; ++number) {
        EXPECT_NE(colour_of({number}), "s0") << number;
        EXPECT_NE(mark_of({number}, 1.0, 1.0, 4.0), "") << number;
    }
}

/// Linear RGB of `#rgb` or `#rrggbb`.
Triple linear(const std::string& hex) {
    Triple rgb;
    const std::size_t digits = hex.size() == 4 ? 1 : 2;
    for (std::size_t i = 0; i < 3; ++i) {
        std::string part = hex.substr(1 + digits * i, digits);
        if (digits == 1) part += part;
        const double value = std::stoi(part, nullptr, 16) / 255.0;
        rgb[i] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    }
    return rgb;
}

/// CIE L*a*b*, white of D65.
Triple lab(const Triple& rgb) {
    const double x = (0.4124 * rgb[0] + 0.3576 * rgb[1] + 0.1805 * rgb[2]) / 0.95047;
    const double y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    const double z = (0.0193 * rgb[0] + 0.1192 * rgb[1] + 0.9505 * rgb[2]) / 1.08883;
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
    return {116.0 * f(y) - 16.0, 500.0 * (f(x) - f(y)), 200.0 * (f(y) - f(z))};
}

/// Full colour vision, and without one kind of cone: Machado, Oliveira and Fernandes, 2009, severity 1.
constexpr std::array<std::array<Triple, 3>, 4> visions = {
    {{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}},
     {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
     {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
     {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}}};

Triple seen(const Triple& rgb, const std::array<Triple, 3>& vision) {
    Triple result;
    for (std::size_t i = 0; i < 3; ++i)
        result[i] =
            std::clamp(vision[i][0] * rgb[0] + vision[i][1] * rgb[1] + vision[i][2] * rgb[2], 0.0, 1.0);
    return result;
}

/// The colours that the page gives to lines, text and what is better or worse: light, then dark.
std::array<std::map<std::string, Triple>, 2> colours_of_page() {
    std::array<std::map<std::string, Triple>, 2> schemes;
    const std::string style = page_style();
    const std::regex pattern("--(ink|better|worse|s[0-9]):(#[0-9a-f]+)");
    for (std::sregex_iterator at(style.begin(), style.end(), pattern); at != std::sregex_iterator(); ++at) {
        auto& scheme = schemes[0].contains((*at)[1]) ? schemes[1] : schemes[0];
        scheme[(*at)[1]] = linear((*at)[2]);
    }
    return schemes;
}

TEST(Looks, are_told_apart_by_readers_without_one_kind_of_cone) {
    for (const auto& scheme : colours_of_page()) {
        ASSERT_EQ(scheme.size(), 9u);
        for (const auto& vision : visions) {
            for (auto one = scheme.begin(); one != scheme.end(); ++one) {
                for (auto other = std::next(one); other != scheme.end(); ++other) {
                    const Triple a = lab(seen(one->second, vision));
                    const Triple b = lab(seen(other->second, vision));
                    EXPECT_GT(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), 15.0)
                        << one->first << " and " << other->first;
                }
            }
        }
    }
}

/// A scenario with `count` conditions beside the baseline, all at one place.
StudyFacts crowd(std::size_t count) {
    StudyFacts study = tests::study({"merge"});
    ScenarioFacts& scenario = study.scenarios[0];
    const ConditionFacts one = scenario.conditions[1];
    scenario.conditions.resize(1);
    for (std::size_t number = 1; number <= count; ++number) {
        scenario.conditions.push_back(one);
        scenario.conditions.back().condition.name = scenario.conditions.back().title =
            "policy" + std::to_string(number);
    }
    return study;
}

std::size_t count_of(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        ++count;
    return count;
}

std::string figure_of(const std::string& page, const std::string& id) {
    const std::size_t begin = page.find("<figure id=\"" + id + "\"");
    return page.substr(begin, page.find("</svg>", begin) - begin);
}

TEST(Looks, of_a_page_with_sixteen_policies_give_the_baselines_to_it_alone) {
    const std::string page = tests::page_of(crowd(16));
    for (const char* const id : {"travel-time-merge", "precision-merge", "pairs-merge"}) {
        const std::string figure = figure_of(page, id);
        EXPECT_LE(count_of(figure, "<polyline class=\"line s0"), 1u) << id;
        EXPECT_EQ(count_of(figure, "<polyline class=\"line "), std::string(id)[0] == 't' ? 17u : 16u) << id;
    }
}

TEST(Looks, make_the_condition_of_the_headline_the_most_prominent) {
    const StudyFacts study = tests::study({"merge"});
    const std::string page = tests::page_of(study);
    ASSERT_THAT(page, HasSubstr("class=\"headline\">Graph made by simulation attributes saves"));
    for (const char* const id : {"travel-time-merge", "precision-merge", "pairs-merge", "trip-merge"}) {
        const std::string figure = figure_of(page, id);
        EXPECT_EQ(count_of(figure, "<polyline class=\"line s1 d0 lead\""), 1u) << id;
        EXPECT_EQ(count_of(figure, " lead\" points"), 1u) << id;
    }
    const std::string trade = figure_of(page, "tradeoff-merge");
    EXPECT_EQ(count_of(trade, "class=\"ring s1\""), 2u) << "around the mark, and in the legend";
    EXPECT_EQ(count_of(trade, "class=\"ring"), 2u);
    EXPECT_THAT(trade, AllOf(HasSubstr(">ring, of the headline: Graph made by simulation"),
                             HasSubstr(">grey: below 1.0 s, does not count<"), HasSubstr("up is better")));
    EXPECT_EQ(count_of(figure_of(page, "differences-merge"), "label lead"), 3u) << "once for each measure";
}

TEST(Differences, of_many_conditions_have_a_figure_for_each_measure) {
    StudyFacts few = crowd(6);
    EXPECT_THAT(figure_of(tests::page_of(few), "differences-merge"),
                AllOf(HasSubstr("EV waiting time"), Not(HasSubstr("Holm"))));
    tests::comparison(few.scenarios[0].conditions[1], Measure::emergency_waiting_time).holm_p = 0.2;
    EXPECT_THAT(figure_of(tests::page_of(few), "differences-merge"),
                AllOf(HasSubstr("] \u2020</text>"), HasSubstr(">\u2020 significant alone, not after Holm")));
    const std::string page = tests::page_of(crowd(7));
    EXPECT_THAT(page, Not(HasSubstr("<figure id=\"differences-merge\">")));
    for (const char* const measure :
         {"emergency-restricted-travel-time-s", "emergency-waiting-time-s", "others-time-loss-s"})
        EXPECT_EQ(count_of(page, "<figure id=\"differences-merge-" + std::string(measure) + "\">"), 1u)
            << measure;
}

std::string drawing_of(const std::string& figure) {
    return figure.substr(0, figure.find("<g transform"));
}

/// `shape` finds the x and y of `count` centres in the drawing, each two of which are `apart` at least.
void expect_apart(const std::string& drawing, const char* shape, std::size_t count, double apart) {
    const std::regex centre(shape);
    std::vector<std::pair<double, double>> places;
    for (std::sregex_iterator at(drawing.begin(), drawing.end(), centre); at != std::sregex_iterator(); ++at)
        places.emplace_back(std::stod((*at)[1]), std::stod((*at)[2]));
    ASSERT_EQ(places.size(), count);
    for (std::size_t one = 0; one < places.size(); ++one) {
        for (std::size_t other = 0; other < one; ++other)
            EXPECT_GE(std::hypot(places[one].first - places[other].first,
                                 places[one].second - places[other].second),
                      apart);
    }
}

TEST(TradeOff, moves_numbers_so_that_none_hides_another) {
    const std::string drawing = drawing_of(figure_of(tests::page_of(crowd(12)), "tradeoff-merge"));
    expect_apart(drawing, "<circle class=\"dot s[0-9]\" cx=\"([0-9.]+)\" cy=\"([0-9.]+)\" r=\"8.0\"", 12,
                 16.0);
    EXPECT_LT(drawing.rfind("r=\"2.6\""), drawing.find("r=\"8.0\"")) << "no dot lies on a number";
    EXPECT_EQ(count_of(drawing, "class=\"leader "), 11u)
        << "a line leads from each moved number to its point";
}

/// Policies under failures, by the aspects alone.
StudyFacts crossed(std::size_t policies, std::size_t failures) {
    StudyFacts study = crowd(policies * failures);
    std::size_t number = 0;
    for (std::size_t policy = 0; policy < policies; ++policy) {
        for (std::size_t failure = 0; failure < failures; ++failure) {
            ConditionFacts& condition = study.scenarios[0].conditions[++number];
            condition.aspects = {{"failure", "loss " + std::to_string(failure)},
                                 {"policy", "Policy " + std::to_string(policy)},
                                 {"predictor", "no repair"}};
            const double gain = 3.0 * static_cast<double>(policy) + 1.5 * static_cast<double>(failure);
            tests::difference(condition, Measure::emergency_restricted_time) = tests::around(-gain, 2.0);
            tests::difference(condition, Measure::other_time_loss) = tests::around(0.3 * gain, 0.4);
        }
    }
    return study;
}

TEST(TradeOff, of_policies_under_failures_has_a_colour_for_each_policy_and_a_mark_for_each_failure) {
    StudyFacts study = crossed(5, 2);
    study.scenarios[0].conditions[3].objections.emergency.removed = 2;
    const std::string figure = figure_of(tests::page_of(study), "tradeoff-merge");
    const std::string drawing = drawing_of(figure);
    for (int policy = 1; policy <= 5; ++policy) {
        const std::string colour = "s" + std::to_string(policy);
        EXPECT_EQ(count_of(drawing, "<path class=\"dot " + colour), 2u);
        EXPECT_EQ(count_of(drawing, "class=\"bar thin " + colour + " d" + std::to_string(policy)), 4u)
            << "without colour, the dash says the policy";
        EXPECT_THAT(figure, HasSubstr(">Policy " + std::to_string(policy - 1) + "</text>"));
    }
    EXPECT_EQ(count_of(drawing, "a5.5 5.5 0 1 0 -11.0 0"), 5u) << "discs of the first failure";
    EXPECT_EQ(count_of(drawing, "h9.6v9.6h-9.6z"), 5u) << "squares of the second";
    EXPECT_EQ(count_of(drawing, "class=\"leader"), 0u);
    EXPECT_EQ(count_of(drawing, "onDot"), 0u) << "no numbers";
    EXPECT_EQ(count_of(drawing, "class=\"ring "), 1u) << "the headline's";
    EXPECT_EQ(count_of(drawing, "hollow\""), 1u);
    for (const char* const words : {">policy:<", ">failure:<", ">loss 0<", ">loss 1<", ">hollow: lost EVs<"})
        EXPECT_THAT(figure, HasSubstr(words));
}

TEST(TradeOff, has_marks_at_the_true_places_of_points) {
    const StudyFacts study = crossed(5, 2);
    const std::string drawing = drawing_of(figure_of(tests::page_of(study), "tradeoff-merge"));
    const std::regex disc("<path class=\"dot s([1-5]) through\" d=\"M([0-9.]+) ([0-9.]+)m5.5 0a");
    std::map<int, std::pair<double, double>> places;
    for (std::sregex_iterator at(drawing.begin(), drawing.end(), disc); at != std::sregex_iterator(); ++at)
        places[std::stoi((*at)[1])] = {std::stod((*at)[2]), std::stod((*at)[3])};
    ASSERT_EQ(places.size(), 5u);
    for (int policy = 2; policy <= 5; ++policy) {  // equal steps of gain and cost
        EXPECT_NEAR(places[policy].first - places[policy - 1].first, places[2].first - places[1].first, 0.15);
        EXPECT_NEAR(places[policy].second - places[policy - 1].second, places[2].second - places[1].second,
                    0.15);
    }
}

TEST(TradeOff, leaves_marks_at_their_values_and_says_that_some_lie_on_others) {
    // The third failure of a policy is where the first of the next one is.
    const auto figure_of_failures = [](std::size_t failures) {
        const StudyFacts study = crossed(5, failures);
        return tradeoff_figure(study, study.scenarios[0]);
    };
    EXPECT_EQ(count_of(drawing_of(figure_of_failures(3).drawing), "class=\"leader "), 0u);
    EXPECT_THAT(figure_of_failures(3).note, HasSubstr("8 marks touch others; the data have each."));
    EXPECT_THAT(figure_of_failures(2).note, Not(HasSubstr("touch others")));
}

TEST(TradeOff, has_a_mark_for_each_failure_with_each_repair) {
    StudyFacts study = crossed(3, 4);
    std::vector<ConditionFacts>& conditions = study.scenarios[0].conditions;
    for (std::size_t number = 1; number < conditions.size(); ++number) {
        conditions[number].aspects["failure"] = (number - 1) % 4 < 2 ? "B10" : "B20";
        conditions[number].aspects["predictor"] = number % 2 == 1 ? "no repair" : "repaired";
    }
    const std::string figure = figure_of(tests::page_of(study), "tradeoff-merge");
    EXPECT_EQ(count_of(drawing_of(figure), "onDot"), 0u) << "no numbers";
    for (const char* const words :
         {">failure, predictor:<", ">B10, no repair<", ">B10, repaired<", ">B20, repaired<"})
        EXPECT_THAT(figure, HasSubstr(words));
}

TEST(TradeOff, has_one_mark_for_conditions_with_the_same_runs) {
    StudyFacts study = crossed(5, 2);
    const auto marks = [&] {
        return count_of(drawing_of(figure_of(tests::page_of(study), "tradeoff-merge")),
                        "<path class=\"dot s");
    };
    EXPECT_EQ(marks(), 10u);
    std::vector<ConditionFacts>& conditions = study.scenarios[0].conditions;
    conditions[4].same_as = conditions[3].name();
    EXPECT_EQ(marks(), 10u) << "their opponents differ: so do their gains";
    for (const Measure measure : {Measure::emergency_restricted_time, Measure::other_time_loss})
        tests::difference(conditions[4], measure) = tests::difference(conditions[3], measure);
    EXPECT_EQ(marks(), 9u);
    const std::string both = conditions[4].label() + " = " + conditions[3].label();
    const Figure figure = tradeoff_figure(study, study.scenarios[0]);
    EXPECT_THAT(figure.note, HasSubstr("Of equal runs one mark is drawn: " + both + "."));
    EXPECT_THAT(figure.drawing, HasSubstr(">equal runs, one mark: " + both + "<"));
    EXPECT_EQ(tradeoff_figure(study, study.scenarios[0]).data.rows.size(), 10u) << "the data have all";
    conditions[4].same_as = conditions[0].name();
    EXPECT_EQ(marks(), 10u) << "the baseline has no mark";
}

TEST(Looks, do_not_change_with_what_is_compared) {
    StudyFacts study = crossed(5, 2);
    for (std::size_t number : {1u, 2u}) {  // those of the first policy, with which the others are compared
        study.scenarios[0].conditions[number].baseline.clear();
        study.scenarios[0].conditions[number].condition.policies = {"first"};
    }
    const std::string drawing = drawing_of(figure_of(tests::page_of(study), "tradeoff-merge"));
    EXPECT_EQ(count_of(drawing, "<path class=\"dot s1 "), 0u);
    EXPECT_EQ(count_of(drawing, "<path class=\"dot s2 "), 2u) << "the second policy";
}

TEST(TradeOff, keeps_numbers_for_few_conditions_and_where_there_are_more_levels_than_looks) {
    const auto has_numbers = [](const StudyFacts& study) {
        return count_of(figure_of(tests::page_of(study), "tradeoff-merge"), "onDot") > 0;
    };
    EXPECT_TRUE(has_numbers(crossed(2, 2)));
    EXPECT_FALSE(has_numbers(crossed(3, 2)));
    EXPECT_FALSE(has_numbers(crossed(6, 6)));
    EXPECT_TRUE(has_numbers(crossed(7, 2))) << "more policies than colours";
    StudyFacts study = crossed(3, 6);
    EXPECT_FALSE(has_numbers(study));
    study.scenarios[0].conditions[1].aspects["pull_aside.lease_s"] = "lease 10 s";
    EXPECT_TRUE(has_numbers(study)) << "a seventh mark";
}

TEST(Looks, of_policies_under_failures_are_the_same_in_all_figures) {
    const std::string figure = figure_of(tests::page_of(crossed(5, 2)), "travel-time-merge");
    for (int policy = 1; policy <= 5; ++policy) {
        const std::string style =
            "<polyline class=\"line s" + std::to_string(policy) + " d" + std::to_string(policy);
        EXPECT_EQ(count_of(figure, style), 2u);
    }
}

TEST(LineFigures, of_policies_under_failures_have_a_panel_for_each_failure_and_one_legend) {
    const std::string page = tests::page_of(crossed(5, 3));
    for (const char* const id : {"travel-time-merge", "precision-merge", "pairs-merge"}) {
        const std::string figure = figure_of(page, id);
        for (const char* const failure : {">loss 0<", ">loss 1<", ">loss 2<"})
            EXPECT_EQ(count_of(figure, failure), 1u) << id;
        for (const char* const policy : {">Policy 0<", ">Policy 4<"})
            EXPECT_EQ(count_of(figure, policy), 1u) << id << ": the legend tells policies alone";
        EXPECT_EQ(count_of(figure, "<polyline class=\"line s1 d1"), 3u) << id;
        EXPECT_THAT(figure, Not(HasSubstr(" d0"))) << "the baseline alone is solid";
    }
    const std::string times = figure_of(page, "travel-time-merge");
    EXPECT_EQ(count_of(times, "<polyline class=\"line s0\""), 3u) << "the baseline is in each";
    EXPECT_EQ(count_of(times, ">0.2</text>"), 3u) << "one axis, in each";
    EXPECT_EQ(count_of(figure_of(tests::page_of(crowd(5)), "travel-time-merge"), ">0.2</text>"), 1u);
}

TEST(DataTables, become_lists_where_their_cells_need_more_room_than_there_is) {
    const DataTable narrow{{"Name", "a", "b"}, {{"one", "1.0", "2.0"}}};
    EXPECT_THAT(to_html(narrow), Not(HasSubstr("data-label")));
    DataTable wide{{"Name"}, {{"one"}}};
    for (int column = 0; column < 6; ++column) {
        wide.head.push_back("column <" + std::to_string(column) + ">");
        wide.rows[0].emplace_back("\u22121,234.56 [\u22121,300.00, \u22121,100.00]");
    }
    EXPECT_THAT(to_html(wide), HasSubstr("<table class=\"data wider\">"));
    EXPECT_THAT(to_html(wide), HasSubstr("<td data-label=\"column &lt;0&gt;\">"));
    EXPECT_THAT(page_style(), HasSubstr("@container (max-width:880px){\ntable.wider{display:block"));
}

}  // namespace
}  // namespace clearway::report::detail
