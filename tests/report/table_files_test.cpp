#include "report/detail/table_files.hpp"

#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/temporary_folder.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/script.hpp"
#include "report/figure_files.hpp"
#include "report/sample.hpp"

namespace clearway::report::detail {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::Not;
using ::testing::Pair;

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

TEST(TableFiles, WriteNumbersAsProgramsReadThem) {
    const DataTable table{
        {"Name", "value", "count"},
        {{"a, \"b\"", "\u22121.5", "12,345"}, {"+x", "+2.0", "\u2013"}, {"c,d", "1,23", ""}}};
    EXPECT_EQ(to_csv(table), "Name,value,count\n\"a, \"\"b\"\"\",-1.5,12345\n+x,2.0,\n\"c,d\",\"1,23\",\n");
}

TEST(TableFiles, SplitIntervalsIntoColumnsOfTheirOwn) {
    const DataTable table{
        {"Condition", "difference, s"},
        {{"one", "\u221212.4 [\u221215.5, \u22129.3]"}, {"two", "0.4"}, {"three", "\u2013"}}};
    EXPECT_EQ(to_csv(table),
              "Condition,\"difference, s\",low 95 %,high 95 %\none,-12.4,-15.5,-9.3\ntwo,0.4,,\nthree,,,\n");
}

TEST(TableFiles, KeepWhatStandsBehindAnInterval) {
    const DataTable table{{"Condition", "difference, s"},
                          {{"one", "2.5 [0.6, 4.4] \u2020"}, {"two", "0.4 [0.1, 0.7]"}}};
    EXPECT_EQ(
        to_csv(table),
        "Condition,\"difference, s\",low 95 %,high 95 %,note\none,2.5,0.6,4.4,\u2020\ntwo,0.4,0.1,0.7,\n");
    EXPECT_THAT(to_latex({"t", "c", table}),
                AllOf(HasSubstr("one & 2.5 & [\\num{0.6}, \\num{4.4}]\\,\\dag{} \\\\\n"),
                      HasSubstr("two & 0.4 & [\\num{0.1}, \\num{0.7}] \\\\\n")));
}

TEST(TableFiles, AreEscapedForLatex) {
    Table table{"a-b", "50 % of a_b", {{"a_b", "50 %"}, {{"x & {y} \\ ~ ^ # $ < >", "\u22121.0"}}}};
    EXPECT_EQ(
        to_latex(table),
        "% needs \\usepackage{booktabs,graphicx,siunitx}\n\\begin{table}\n\\centering\n\\caption{50 \\% of "
        "a\\_b}\n"
        "\\label{tab:a-b}\n\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n\\begin{"
        "tabular}{l S[table-format=-1.1]}\n\\toprule\na\\_b & {50 \\%} \\\\\n"
        "\\midrule\nx \\& \\{y\\} \\textbackslash{} \\textasciitilde{} \\textasciicircum{} \\# \\$ $<$ $>$ & "
        "-1.0 \\\\\n\\bottomrule\n\\end{tabular}}\n\\end{table}\n");
    table.data.cells = DataTable::Cells::words;
    EXPECT_THAT(to_latex(table), HasSubstr("{l l}"));
    // Two bytes a letter: 60 stay on one line, 61 do not.
    for (const std::size_t letters : {60U, 61U}) {
        table.data.rows[0][1].clear();
        for (std::size_t letter = 0; letter < letters; ++letter)
            table.data.rows[0][1] += "\u00fc";
        EXPECT_THAT(to_latex(table), HasSubstr(letters == 60 ? "{l l}" : "{l p{0.7\\linewidth}}"));
    }
}

TEST(TableFiles, OfManyColumnsStandOnTheirSideInLatex) {
    Table table{"t", "c", {{"Condition"}, {{"one"}}}};
    const auto add = [&](const char* cell) {
        table.data.head.emplace_back("column");
        table.data.rows[0].emplace_back(cell);
    };
    for (int column = 0; column < 8; ++column)
        add("1");
    add("1.0 [0.5, 1.5]");
    EXPECT_THAT(to_latex(table), HasSubstr("\\begin{table}\n")) << "as wide as the page";
    add("2");
    EXPECT_THAT(to_latex(table),
                AllOf(HasSubstr("graphicx,rotating,siunitx"), HasSubstr("\\begin{sidewaystable}\n"),
                      HasSubstr("\\end{sidewaystable}\n"), Not(HasSubstr("tab:t-2"))));
    for (int column = 0; column < 4; ++column)
        add("-11.0 [-20.5, 1.5]");
    EXPECT_THAT(to_latex(table), AllOf(HasSubstr("\\caption{c (1 of 2)}\n\\label{tab:t}"),
                                       HasSubstr("\\label{tab:t-2}"), HasSubstr("\\caption{c (2 of 2)}")));
}

TEST(TableFiles, SetLongHeadsInLines) {
    const Table table{"t", "c", {{"Condition", "EV travel time, all, s"}, {{"one", "75.2 [62.3, 88.1]"}}}};
    EXPECT_THAT(to_latex(table), HasSubstr("\\multicolumn{2}{c}{\\shortstack{EV travel time,\\\\all, s}}"));
}

TEST(TableFiles, SetNumbersAndIntervalsInColumnsOfSiunitx) {
    const Table table{"t",
                      "c",
                      {{"Condition", "difference", "p", "count", "why"},
                       {{"one", "\u221212.4 [\u221215.5, \u22129.3]", "< 0.001", "12,345", "a"},
                        {"two", "+0.4 [0.1, 0.7]", "0.25", "7", ""},
                        {"three", "\u2013", "0.3", "0", "b"}}}};
    EXPECT_THAT(
        to_latex(table),
        HasSubstr("{l S[table-format=+2.1,retain-explicit-plus]@{\\,}l S[table-format=1.2] "
                  "S[table-format=5.0] l}\n\\toprule\n"
                  "Condition & \\multicolumn{2}{c}{difference} & {p} & {count} & why \\\\\n\\midrule\n"
                  "one & -12.4 & [\\num{-15.5}, \\num{-9.3}] & {$<$ 0.001} & 12345 & a \\\\\n"
                  "two & +0.4 & [\\num{0.1}, \\num{0.7}] & 0.25 & 7 &  \\\\\n"
                  "three & {--} & & 0.3 & 0 & b \\\\\n"));
}

TEST(Standalone, DrawingNeedsNothingOfThePage) {
    const std::string svg =
        standalone("<svg class=\"plot\" viewBox=\"0 0 400 120\">\n<text class=\"tick\">1</text></svg>\n");
    EXPECT_THAT(svg, HasSubstr("xmlns=\"http://www.w3.org/2000/svg\""));
    EXPECT_THAT(svg, HasSubstr("width=\"400\" height=\"120\""));
    EXPECT_THAT(svg, HasSubstr("<style>"));
    EXPECT_THAT(svg, Not(HasSubstr("var(--")));
}

TEST(PolicySource, IsTheHashInBase64) {
    // SHA-256 of the empty text, FIPS 180-4.
    EXPECT_EQ(policy_source("e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"),
              "sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=");
}

TEST(FigureFiles, HoldEveryFigureAndTableOfTheReport) {
    const core::TemporaryFolder folder;
    const FigureFiles files =
        write_figures(tests::study({"merge", "<b>City</b>/../x"}), folder.path() / "figures");
    EXPECT_GE(files.drawings.size(), 20u);
    EXPECT_GE(files.typeset.size(), 10u);
    std::set<std::filesystem::path> names;
    for (const auto* const list : {&files.drawings, &files.tables, &files.typeset}) {
        for (const std::filesystem::path& file : *list) {
            EXPECT_TRUE(std::filesystem::exists(file)) << file;
            EXPECT_EQ(file.parent_path(), folder.path() / "figures");
            EXPECT_TRUE(names.insert(file).second) << file << " was written twice";
        }
    }
    EXPECT_TRUE(names.contains(folder.path() / "figures" / "tradeoff-b-city-b-x.svg"));
    const std::string data = text_of(folder.path() / "figures" / "tradeoff-merge.csv");
    EXPECT_THAT(data,
                HasSubstr("Graph made by simulation attributes,1,12.40,9.30,15.50,0.40,-0.80,1.60,20\n"));
    EXPECT_THAT(text_of(folder.path() / "figures" / "replications-merge.csv"),
                ContainsRegex("simulation attributes,20,6.0,[0-9.]*,141\n"))
        << "the number of pairs also where an effect is shown";
    EXPECT_THAT(text_of(folder.path() / "figures" / "times-merge.tex"),
                AllOf(HasSubstr("\\toprule"), HasSubstr("\\label{tab:times-merge}"), HasSubstr("\\num{")));
}

TEST(FigureFiles, HaveTitleSeedsAndNoteInThemUnlessTheyAreBare) {
    const core::TemporaryFolder folder;
    FigureChoice choice{{"tradeoff"}};
    write_figures(tests::study({"merge"}), folder.path() / "figures", choice);
    const std::string framed = text_of(folder.path() / "figures" / "tradeoff-merge.svg");
    EXPECT_THAT(framed, AllOf(HasSubstr(">merge: Gain and cost against the baseline; 20 seeds</text>"),
                              HasSubstr(">Up is better for emergency vehicles")));
    choice.words = FigureChoice::Words::bare;
    write_figures(tests::study({"merge"}), folder.path() / "figures", choice);
    EXPECT_THAT(text_of(folder.path() / "figures" / "tradeoff-merge.svg"), Not(HasSubstr("seeds</text>")));
}

TEST(FigureFiles, BareOnesDoNotLetTheConditionOfTheHeadlineStandOut) {
    const core::TemporaryFolder folder;
    FigureChoice choice{{"tradeoff", "pairs"}};
    const auto drawn = [&](const char* name) {
        write_figures(tests::study({"merge"}), folder.path() / "figures", choice);
        return text_of(folder.path() / "figures" / name);
    };
    EXPECT_THAT(drawn("tradeoff-merge.svg"),
                AllOf(HasSubstr("class=\"ring"), HasSubstr(">ring, of the headline: ")));
    EXPECT_THAT(drawn("pairs-merge.svg"), HasSubstr(" lead\""));
    choice.words = FigureChoice::Words::bare;
    EXPECT_THAT(drawn("tradeoff-merge.svg"), AllOf(Not(HasSubstr("class=\"ring")), Not(HasSubstr("headline")),
                                                   HasSubstr(">95 % intervals<")));
    EXPECT_THAT(drawn("pairs-merge.svg"), Not(HasSubstr(" lead\"")));
}

TEST(FigureFiles, HaveTheSameDataWithAndWithoutTheHeadline) {
    const core::TemporaryFolder folder;
    const StudyFacts study = tests::study({"merge", "intersection", "city"});
    write_figures(study, folder.path() / "framed");
    write_figures(study, folder.path() / "bare", {.only = {}, .words = FigureChoice::Words::bare});
    for (const char* const scenario : {"merge", "intersection", "city"}) {
        const std::string name = fmt::format("precision-{}.csv", scenario);
        EXPECT_EQ(text_of(folder.path() / "framed" / name), text_of(folder.path() / "bare" / name));
    }
}

TEST(FigureFiles, OfPairsHaveMarksAtTheEndsOfMeansAlone) {
    const core::TemporaryFolder folder;
    const StudyFacts study = tests::study({"merge"});
    write_figures(study, folder.path(), {{"pairs"}});
    const std::string svg = text_of(folder.path() / "pairs-merge.svg");
    EXPECT_THAT(svg, HasSubstr(">each from the baseline (left) to a condition (right)</text>"));
    const auto count = [&](const std::string& text) {
        std::size_t found = 0;
        for (std::size_t at = svg.find(text); at != std::string::npos; at = svg.find(text, at + 1))
            ++found;
        return found;
    };
    EXPECT_GT(count("class=\"line s"), 2u);
    // A mean and its entry in the legend have a line each; three marks for both.
    EXPECT_EQ(2 * count("<path class=\"dot s"), 3 * (count("class=\"line s")));
}

TEST(FigureFiles, HaveTheTimeOfThoseThatArrivedInCsvAloneWhereAllDid) {
    const core::TemporaryFolder folder;
    StudyFacts study = tests::study({"merge"});
    const auto table = [&](const char* ending) {
        write_figures(study, folder.path());
        const std::string text = text_of(folder.path() / (std::string("times-merge") + ending));
        return std::regex_replace(text, std::regex(R"(\\\\)"), " ");  // lines of heads in LaTeX
    };
    const auto head = [&] {
        const std::string text = table(".csv");
        return text.substr(0, text.find('\n'));
    };
    const std::string repeated = info(Measure::emergency_travel_time).title;
    const std::string columns = head();
    EXPECT_THAT(columns, HasSubstr(repeated));
    EXPECT_THAT(table(".tex"),
                AllOf(HasSubstr(info(Measure::emergency_restricted_time).title), Not(HasSubstr(repeated)),
                      HasSubstr(info(Measure::emergency_time_loss).title)));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "statistics-merge-emergency-travel-time-s.tex"));
    for (analysis::MetricSummary& metric : study.scenarios[0].conditions.back().metrics)
        if (metric.metric.name == info(Measure::emergency_travel_time).field) metric.estimate->mean -= 0.01;
    EXPECT_THAT(table(".tex"), HasSubstr(repeated)) << "one did not arrive under one condition";
    EXPECT_EQ(head(), columns) << "programs find the same columns";
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "statistics-merge-emergency-travel-time-s.tex"));
}

TEST(FigureFiles, AreThoseThatWereChosen) {
    const core::TemporaryFolder folder;
    const std::filesystem::path out = folder.path() / "figures";
    const FigureFiles files = write_figures(tests::study({"merge"}), out, {{"tradeoff", "times-merge"}});
    EXPECT_EQ(files.drawings.size(), 1u);
    EXPECT_EQ(files.typeset, std::vector{out / "times-merge.tex"});
    try {
        write_figures(tests::study({"merge"}), out, {{"tradeof"}});
        ADD_FAILURE() << "no figure has this name";
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("`tradeof` names no figure"), HasSubstr("differences"),
                                        HasSubstr("Did you mean 'tradeoff'?")));
    }
    EXPECT_TRUE(std::filesystem::exists(out / "tradeoff-merge.svg")) << "nothing was removed";
}

TEST(FigureFiles, ThatWereNotChosenStayWithTheirEntriesAndPictures) {
    const core::TemporaryFolder folder;
    const std::filesystem::path& out = folder.path();
    StudyFacts study = tests::study({"merge"});
    write_index(write_figures(study, out), out);
    const auto holds = [&] {
        std::map<std::string, std::string> texts;
        for (const auto& entry : std::filesystem::directory_iterator(out))
            texts[entry.path().filename()] = text_of(entry.path());
        return texts;
    };
    for (const char* const picture : {"tradeoff-merge.pdf", "pairs-merge.pdf"})
        std::ofstream(out / picture) << "%PDF";
    write_index(write_figures(study, out), out);  // the same once more: the pictures fit
    const auto before = holds();
    EXPECT_THAT(before.at("index.html"),
                AllOf(HasSubstr("tradeoff-merge.pdf"), HasSubstr("pairs-merge.pdf")));
    write_index(write_figures(study, out, {{"tradeoff"}}), out);
    EXPECT_EQ(holds(), before);
    study.reference = "corridor";
    write_index(write_figures(study, out, {{"tradeoff"}}), out);
    auto after = holds();
    EXPECT_THAT(after.at("tradeoff-merge.svg"), HasSubstr("corridor"));
    EXPECT_FALSE(after.contains("tradeoff-merge.pdf")) << "it was of another drawing";
    EXPECT_THAT(after.at("index.html"),
                AllOf(Not(HasSubstr("tradeoff-merge.pdf")), HasSubstr("fig:tradeoff-merge-against-corridor"),
                      HasSubstr("pairs-merge.pdf"), Not(HasSubstr("fig:pairs-merge-against"))));
    for (const char* const name :
         {"tradeoff-merge.svg", "tradeoff-merge.csv", "tradeoff-merge.pdf", "index.html"})
        after[name] = before.at(name);
    EXPECT_EQ(after, before);
    write_figures(study, out);
    EXPECT_FALSE(std::filesystem::exists(out / "pairs-merge.pdf")) << "all were refreshed";
}

TEST(FigureFiles, ThatStayAreNamedWhereTheyAreOfAnotherNumberOfSeeds) {
    const core::TemporaryFolder folder;
    const std::filesystem::path& out = folder.path();
    StudyFacts study = tests::study({"merge", "city"});
    study.scenarios[0].replications = 5;
    study.scenarios[1].replications = 7;
    EXPECT_TRUE(write_figures(study, out).of_other_seeds.empty());
    EXPECT_TRUE(write_figures(study, out, {{"tradeoff"}}).of_other_seeds.empty());
    study.scenarios[0].replications = 10;
    const FigureFiles files = write_figures(study, out, {{"tradeoff"}});
    write_index(files, out);
    ASSERT_TRUE(files.of_other_seeds.contains("5 seeds"));
    const std::vector<std::string>& left = files.of_other_seeds.at("5 seeds");
    EXPECT_THAT(left,
                AllOf(Contains("pairs-merge"), Not(Contains("pairs-city")), Not(Contains("tradeoff-merge"))));
    EXPECT_THAT(files.of_other_seeds, Contains(Key("5, 7 seeds"))) << "what shows both";
    EXPECT_THAT(text_of(out / "tradeoff-merge.svg"), HasSubstr("10 seeds"));
    write_figures(study, out, {{"pairs"}});
    EXPECT_THAT(write_figures(study, out, {{"tradeoff"}}).of_other_seeds.at("5 seeds"),
                AllOf(Contains("times-merge"), Not(Contains("pairs-merge"))));
    EXPECT_TRUE(write_figures(study, out).of_other_seeds.empty()) << "all are refreshed";
    std::ofstream(out / ".clearway-figures") << "pairs-merge\n";  // an older export's
    EXPECT_THAT(write_figures(study, out, {{"tradeoff"}}).of_other_seeds,
                ElementsAre(Pair("", ElementsAre("pairs-merge"))));
}

/// Texts of the SVG files of a study with a CSS class.
std::vector<std::string> texts_of_drawings(const FigureFiles& files, const std::string& style) {
    std::vector<std::string> texts;
    for (const std::filesystem::path& file : files.drawings) {
        const std::string drawing = text_of(file);
        const std::string begin = "<text class=\"" + style + "\"";
        for (std::size_t at = drawing.find(begin); at != std::string::npos;
             at = drawing.find(begin, at + 1)) {
            const std::size_t from = drawing.find('>', at) + 1;
            texts.push_back(drawing.substr(from, drawing.find('<', from) - from));
        }
    }
    return texts;
}

TEST(FigureFiles, NameMeasureAndUnitOnEveryAxis) {
    const core::TemporaryFolder folder;
    const FigureFiles files = write_figures(tests::study({"merge", "city"}), folder.path() / "figures");
    const std::vector<std::string> axes = texts_of_drawings(files, "axis");
    ASSERT_GE(axes.size(), 20u);
    for (const std::string& axis : axes)
        EXPECT_THAT(axis,
                    ::testing::MatchesRegex(".*, (s|m|%|nat|number|0 to 1)(; across: .*|, in decades.*)?"));
    for (const std::filesystem::path& file : files.drawings) {
        const std::string drawing = text_of(file);
        const bool has_grid = drawing.find("<path class=\"grid\"") != std::string::npos;
        EXPECT_TRUE(!has_grid || drawing.find("<text class=\"axis\"") != std::string::npos) << file;
    }
}

TEST(FigureFiles, HoldOnlyWhatTheStudyUsed) {
    StudyFacts study = tests::study({"merge"});
    const core::TemporaryFolder folder;
    const auto table = [&](const char* name) {
        write_figures(study, folder.path());
        return text_of(folder.path() / name);
    };
    EXPECT_THAT(table("times-merge.tex"), HasSubstr("Gap closed"));
    EXPECT_THAT(table("tradeoff-merge.csv"), Not(HasSubstr("objection")));
    for (ConditionFacts& condition : study.scenarios[0].conditions)
        tests::value(condition, Measure::gap_closed).reset();
    EXPECT_THAT(table("times-merge.tex"), Not(HasSubstr("Gap closed, ")));
    for (JourneyFacts& journey : study.scenarios[0].journeys)
        std::erase_if(journey.signals, [](const SignalSpan& span) { return span.state == "yellow"; });
    EXPECT_THAT(table("journey-merge-baseline.svg"),
                AllOf(HasSubstr("signal red"), Not(HasSubstr("signal yellow"))));
}

/// Two factors, of which the second has a level at which one combination is missing.
TEST(FigureFiles, HaveTheGridOfFactorsWithItsIntervals) {
    StudyFacts study = tests::study({"merge"});
    std::vector<ConditionFacts>& conditions = study.scenarios[0].conditions;
    conditions.resize(1);
    const auto add = [&](const char* failure, const char* policy, double gain_s) {
        ConditionFacts& made =
            conditions.emplace_back(tests::condition(fmt::format("own+{}+{}", failure, policy), "", 90.0));
        tests::compare(made, tests::around(-gain_s, 1.5), tests::around(0.5, 0.2));
        made.factors = {{"condition.failure", failure}, {"condition.policy", policy}};
    };
    add("perfect", "corridor", 12.0);
    add("B10", "corridor", 8.0);
    add("B20", "corridor", 4.0);
    add("perfect", "geocast", 14.0);
    add("B20", "geocast", 6.0);
    const core::TemporaryFolder folder;
    write_figures(study, folder.path());
    EXPECT_EQ(
        text_of(folder.path() / "factors-emergency-grid.csv"),
        "failure,corridor,corridor low 95 %,corridor high 95 %,geocast,geocast low 95 %,geocast high 95 %\n"
        "perfect,-12.0,-13.5,-10.5,-14.0,-15.5,-12.5\n"
        "B10,-8.0,-9.5,-6.5,,,\n"
        "B20,-4.0,-5.5,-2.5,-6.0,-7.5,-4.5\n")
        << "what all rows have in common is left out";
    EXPECT_THAT(text_of(folder.path() / "factors-others-grid.tex"),
                AllOf(HasSubstr("\\label{tab:factors-others-grid}"), HasSubstr("\\caption{merge: "),
                      HasSubstr("by policy; n = 20 pairs, 95 \\% intervals in brackets}"),
                      HasSubstr("0.5 & [\\num{0.3}, \\num{0.7}]")));
    tests::difference(study.scenarios[0].conditions.back(), primary)->n = 12;
    write_figures(study, folder.path());
    EXPECT_THAT(text_of(folder.path() / "factors-emergency-grid.tex"), HasSubstr("; n = 12 to 20 pairs,"));
    const auto grid = [&] { return text_of(folder.path() / "factors-emergency.svg"); };
    EXPECT_THAT(grid(), AllOf(Not(HasSubstr("after Holm")), Not(HasSubstr("\"heading\""))))
        << "the caption names it";
    tests::comparison(study.scenarios[0].conditions.back(), primary).holm_p = 0.2;
    write_figures(study, folder.path());
    EXPECT_THAT(grid(), AllOf(HasSubstr("6.0 \u2020</text>"), HasSubstr("significant alone, not after Holm"),
                              Not(HasSubstr("4.0 \u2020</text>"))));
    const auto typeset = [&] { return text_of(folder.path() / "factors-emergency-grid.tex"); };
    EXPECT_THAT(typeset(), AllOf(HasSubstr("\\num{-4.5}]\\,\\dag{} "),
                                 HasSubstr("; \\dag{} significant alone, not after Holm")));
    study.scenarios[0].conditions.back().least_relevant_s = 10.0;
    write_figures(study, folder.path());
    EXPECT_THAT(typeset(), HasSubstr("\\num{-4.5}]\\,\\dag{} ")) << "also where it is below what counts";
    study.scenarios[0].conditions.back().condition.policies = {"check_in_out"};
    study.scenarios[0].conditions.back().condition.failure = "Q50";
    write_figures(study, folder.path());
    EXPECT_THAT(grid(),
                AllOf(HasSubstr("6.0 (n/a)</text>"), HasSubstr("it sends no message that could be lost"),
                      Not(HasSubstr("after Holm"))));
    EXPECT_THAT(typeset(), AllOf(HasSubstr("\\,(n/a) "), HasSubstr("; (n/a) it sends no message")));
}

TEST(FigureFiles, HaveAPanelForEachLevelOfAThirdFactorInTheOrderOfTheStudy) {
    StudyFacts study = tests::study({"merge"});
    std::vector<ConditionFacts>& conditions = study.scenarios[0].conditions;
    conditions.resize(1);
    for (const auto& [predictor, words] :
         {std::pair("none", "no repair"), std::pair("kalman", "as repaired")}) {
        for (const char* const failure : {"B10", "B20"}) {
            for (const char* const policy : {"corridor", "geocast", "mine"}) {
                ConditionFacts& made = conditions.emplace_back(
                    tests::condition(fmt::format("own+{}+{}+{}", failure, policy, predictor), "", 90.0));
                tests::compare(made, tests::around(-5.0, 1.5), tests::around(0.5, 0.2));
                made.factors = {{"condition.failure", failure},
                                {"condition.policy", policy},
                                {"condition.predictor", predictor}};
                made.aspects = {{"predictor", words}};
            }
        }
    }
    const core::TemporaryFolder folder;
    write_figures(study, folder.path());
    const std::string grid = text_of(folder.path() / "factors-emergency-grid.csv");
    EXPECT_THAT(grid, testing::StartsWith("predictor,policy,B10,"));
    EXPECT_LT(grid.find("no repair,corridor"), grid.find("as repaired,corridor"));
    EXPECT_THAT(grid, HasSubstr("as repaired,mine,-5.0"));
}

TEST(FigureFiles, SayOverHowManyComparisonsAndOfWhichTestPIsCorrected) {
    const core::TemporaryFolder folder;
    StudyFacts study = tests::study({"merge"});
    for (ConditionFacts& one : study.scenarios[0].conditions) {
        for (const Measure measure : {Measure::emergency_restricted_time, Measure::collisions})
            if (one.outcome(measure).comparison) {
                tests::comparison(one, measure).holm_p.reset();
                if (measure == Measure::collisions) tests::comparison(one, measure).t_p.reset();
            }
    }
    ConditionFacts& condition = study.scenarios[0].conditions[1];
    analysis::Comparison& times = tests::comparison(condition, Measure::emergency_restricted_time);
    times.t_p = times.holm_p = 0.03;
    analysis::Comparison& collisions = tests::comparison(condition, Measure::collisions);
    collisions.wilcoxon_p = collisions.holm_p = 0.25;
    const FigureFiles files = write_figures(study, folder.path());
    const auto caption = [&](const char* measure) {
        return text_of(folder.path() / fmt::format("statistics-merge-{}.tex", measure));
    };
    EXPECT_THAT(caption("emergency-restricted-travel-time-s"),
                HasSubstr("p (Holm): of t, over 1 comparison"));
    EXPECT_THAT(caption("collisions"),
                testing::ContainsRegex("p .Holm.: of Wilcoxon.+s test, over 1 comparison"));
}

TEST(FigureFiles, AreAllOnOnePage) {
    const core::TemporaryFolder beside;
    const std::filesystem::path folder = beside.path() / "figures";
    const FigureFiles files = write_figures(tests::study({"merge", "<b>City</b>/../x"}), folder);
    write_index(files, folder);
    EXPECT_THAT(text_of(folder / "index.html"), Not(HasSubstr(".pdf\"")));
    for (const std::filesystem::path& drawing : files.drawings)
        std::ofstream(std::filesystem::path(drawing).replace_extension(".pdf")) << "%PDF";
    write_index(files, folder);
    const std::string index = text_of(folder / "index.html");
    for (const auto* const list : {&files.drawings, &files.tables, &files.typeset}) {
        for (const std::filesystem::path& file : *list)
            EXPECT_THAT(index, HasSubstr("href=\"" + file.filename().string() + "\""));
    }
    EXPECT_THAT(index, HasSubstr("href=\"tradeoff-merge.pdf\""));
    EXPECT_THAT(index, HasSubstr("\\label{fig:tradeoff-merge}"));
    EXPECT_THAT(index, HasSubstr("<details><summary>Table</summary><div class=\"scroll\""));
    EXPECT_THAT(index, HasSubstr("height=.8\\textheight,keepaspectratio]{figures/tradeoff-merge.pdf}"));
    EXPECT_THAT(index, Not(HasSubstr("<b>")));
}

}  // namespace
}  // namespace clearway::report::detail
