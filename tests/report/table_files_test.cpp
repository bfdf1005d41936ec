#include "report/detail/table_files.hpp"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include "core/temporary_folder.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/script.hpp"
#include "report/figure_files.hpp"
#include "report/sample.hpp"

namespace clearway::report::detail {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

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

TEST(TableFiles, AreEscapedForLatex) {
    DataTable table{{"a_b", "50 %"}, {{"x & {y} \\ ~ ^ # $", "\u22121.0"}}};
    EXPECT_EQ(to_latex(table),
              "\\begin{tabular}{lr}\n\\toprule\na\\_b & 50 \\% \\\\\n\\midrule\n"
              "x \\& \\{y\\} \\textbackslash{} \\textasciitilde{} \\textasciicircum{} \\# \\$ & $-$1.0 \\\\\n"
              "\\bottomrule\n\\end{tabular}\n");
    table.cells = DataTable::Cells::words;
    EXPECT_THAT(to_latex(table), HasSubstr("{ll}"));
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
                HasSubstr("Graph made by simulation attributes,1,12.40,9.30,15.50,0.40,-0.80,1.60,20,\n"));
    EXPECT_THAT(text_of(folder.path() / "figures" / "times-merge.tex"), HasSubstr("\\toprule"));
}

}  // namespace
}  // namespace clearway::report::detail
