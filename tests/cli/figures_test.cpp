// Figures and tables of a study as files, from the command line.
#include <fstream>
#include <map>

#include "user.hpp"

namespace clearway::cli {
namespace {

class FiguresTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
    }

    void run() const {
        const Ended ended = clearway({"run", "line", "--seeds", "2", "--no-solo", "--policy", "dissertation",
                                      "--name", "mine", "--out", "study"});
        ASSERT_EQ(ended.code, 0) << ended.err;
    }
    /// How many files a folder has, by their ending.
    std::map<std::string, std::size_t> files(const std::string& name) const {
        std::map<std::string, std::size_t> count;
        for (const auto& entry : std::filesystem::directory_iterator(folder() / name))
            ++count[entry.path().extension()];
        return count;
    }
    /// A PATH without the program that draws pixels.
    Environment without_rasteriser() const {
        std::filesystem::create_directory(folder() / "bin");
        for (const char* const program : {"sh", "netconvert"})
            std::filesystem::create_symlink(std::filesystem::path("/usr/bin") / program,
                                            folder() / "bin" / program);
        return {.environment = {{"PATH", folder() / "bin"}}};
    }
};

TEST_F(FiguresTest, every_drawing_becomes_svg_pdf_and_png_and_every_table_csv_and_latex) {
    run();
    const Ended ended = clearway({"export", "figures", "study", "--out", "new/figures"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, IsEmpty());
    const auto count = files("new/figures");
    EXPECT_GE(count.at(".svg"), 5U);
    EXPECT_EQ(count.at(".png"), count.at(".svg"));
    EXPECT_EQ(count.at(".pdf"), count.at(".svg"));
    EXPECT_GE(count.at(".tex"), 3U);
    EXPECT_GE(count.at(".csv"), count.at(".tex"));
    EXPECT_THAT(ended.err, HasSubstr("written to new/figures: " + std::to_string(count.at(".svg")) +
                                     " figures as SVG, PDF and PNG, " + std::to_string(count.at(".csv")) +
                                     " tables as CSV, " + std::to_string(count.at(".tex")) + " as LaTeX"));
    EXPECT_THAT(ended.err, testing::ContainsRegex("pdf files.*\n.*png files"));
    EXPECT_TRUE(read("new/figures/tradeoff-line.png").starts_with("\x89PNG"));
    EXPECT_TRUE(read("new/figures/tradeoff-line.pdf").starts_with("%PDF-"));
    const std::string index = read("new/figures/index.html");
    for (const auto& entry : std::filesystem::directory_iterator(folder() / "new/figures")) {
        const std::string name = entry.path().filename();
        const bool is_linked = index.find("href=\"" + name + "\"") != std::string::npos;
        EXPECT_EQ(is_linked, name != "index.html" && name != ".clearway-figures") << name;
    }
    EXPECT_THAT(read("new/figures/times-line.tex"), HasSubstr("\\toprule"));
}

TEST_F(FiguresTest, an_unfinished_study_is_told_as_by_report) {
    run();
    std::filesystem::remove_all(folder() / "study/runs/line/mine/00001");
    const Ended ended = clearway({"export", "figures", "study", "--out", "figures", "--svg-only"});
    EXPECT_EQ(ended.code, 5) << ended.err;
    EXPECT_EQ(clearway({"report", "study"}).code, 5);
    EXPECT_THAT(ended.err, HasSubstr("1 of 4 runs are missing"));
}

TEST_F(FiguresTest, an_export_replaces_the_last_one_and_nothing_else) {
    run();
    const std::vector<std::string> command = {"export", "figures", "study", "--out", "figures", "--svg-only"};
    ASSERT_EQ(clearway(command).code, 0);
    const auto first = files("figures");
    std::filesystem::copy_file(folder() / "figures/times-line.csv", folder() / "figures/times-gone.csv");
    std::ofstream(folder() / "figures/.clearway-figures", std::ios::app) << "times-gone\n../study/runs\n";
    std::ofstream(folder() / "figures/mine.csv") << "kept\n";
    ASSERT_EQ(clearway(command).code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder() / "figures/times-gone.csv"));
    EXPECT_EQ(read("figures/mine.csv"), "kept\n");
    std::filesystem::remove(folder() / "figures/mine.csv");
    EXPECT_EQ(files("figures"), first);
    const Ended refused = clearway({"export", "figures", "study", "--out", "study", "--svg-only"});
    EXPECT_EQ(refused.code, 3);
    EXPECT_THAT(refused.err, HasSubstr("--out: study holds something else (allowed: a new or empty folder"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "study/index.html"));
}

TEST_F(FiguresTest, with_svg_only_no_other_program_is_needed) {
    run();
    const Environment bare = without_rasteriser();
    const Ended ended = clearway({"export", "figures", "study", "--out", "figures", "--svg-only"}, bare);
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, AllOf(HasSubstr("figures as SVG, "), Not(HasSubstr("PDF"))));
    EXPECT_THAT(
        clearway({"export", "figures", "study", "--out", "few", "--svg-only", "--only", "tradeoff"}).err,
        HasSubstr(": 1 figure as SVG, 1 table as CSV, 0 as LaTeX;"));
    EXPECT_EQ(files("figures").count(".png") + files("figures").count(".pdf"), 0U);
    EXPECT_THAT(read("figures/index.html"),
                AllOf(HasSubstr("tradeoff-line.svg"), HasSubstr("line: Gain and cost against the baseline"),
                      Not(HasSubstr("Training of the nets")), Not(HasSubstr(".pdf\""))));
    const Ended lacking = clearway({"export", "figures", "study", "--out", "others"}, bare);
    EXPECT_EQ(lacking.code, 4);
    EXPECT_THAT(lacking.err, AllOf(HasSubstr("rsvg-convert cannot be started"), HasSubstr("librsvg2-bin"),
                                   HasSubstr("--svg-only"),
                                   HasSubstr("SVG, CSV and LaTeX files and index.html are written")));
    EXPECT_EQ(files("others"), files("figures"));
}

TEST_F(FiguresTest, a_second_time_gives_the_same_bytes) {
    run();
    for (const char* const into : {"one/figures", "two/figures"})
        ASSERT_EQ(clearway({"export", "figures", "study", "--out", into, "--svg-only"}).code, 0);
    for (const auto& entry : std::filesystem::directory_iterator(folder() / "one/figures")) {
        const std::string name = entry.path().filename();
        EXPECT_EQ(read("one/figures/" + name), read("two/figures/" + name)) << name;
    }
}

TEST_F(FiguresTest, what_cannot_be_read_or_written_is_told_and_nothing_is_written) {
    const auto refused = [&](const std::vector<std::string>& words, int code, const std::string& said) {
        std::vector<std::string> all = {"export", "figures"};
        all.insert(all.end(), words.begin(), words.end());
        const Ended ended = clearway(all);
        EXPECT_EQ(ended.code, code) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(said));
        EXPECT_THAT(ended.out, IsEmpty());
        EXPECT_FALSE(std::filesystem::exists(folder() / "figures"));
    };
    refused({"nowhere", "--out", "figures"}, 3, "nowhere: is not a run folder: it has no manifest.json");
    refused({"line", "--out", "figures"}, 3, "line: is not a run folder");
    refused({}, 2, "folder");
    run();
    refused({"study"}, 2, "--out");
    refused({"study", "--out", "figures", "--pixels"}, 2, "--pixels");
    refused({"study", "--out", "figures", "--least-difference", "-1"}, 2, "0 to 1");
    write("taken", "a file");
    refused({"study", "--out", "taken"}, 4, "taken");
    refused({"study", "--out", "taken/figures"}, 4, "taken/figures");
    refused({"study", "--out", "/proc/figures"}, 4, "/proc/figures");
    EXPECT_EQ(read("taken"), "a file");
    write("study/manifest.json", "{");
    refused({"study", "--out", "figures"}, 3, "manifest.json");
}

}  // namespace
}  // namespace clearway::cli
