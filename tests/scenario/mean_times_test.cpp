#include "scenario/mean_times.hpp"

#include <gmock/gmock.h>

#include "core/files.hpp"
#include "scenario/config.hpp"
#include "scratch.hpp"

namespace clearway::scenario {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* head = "# clearway mean times 1: network abc, study seed 77, runs 10, edges 2\n";
constexpr const char* columns = "edge,vehicles,time_s\n";

const roads::Network& measured_crossings() {
    static const roads::Network network =
        roads::Network::read(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml");
    return network;
}

class MeanTimesFile : public ScratchTest {
  protected:
    MeanTimes read(const std::string& text) const {
        std::vector<core::Problem> problems;
        MeanTimes times = read_mean_times(write("times.csv", text), problems);
        if (!problems.empty()) throw core::InputError(std::move(problems));
        return times;
    }
    /// The only problem of a file with these rows, as it is printed.
    std::string refusal(const std::string& rows,
                        const std::string& before = std::string(head) + columns) const {
        const auto problems = problems_of([&] { read(before + rows); });
        EXPECT_EQ(problems.size(), 1U);
        return problems.empty() ? "" : core::format_problem(problems.front());
    }
};

TEST_F(MeanTimesFile, gives_each_edge_what_was_written_and_nothing_to_the_others) {
    const std::string text = mean_times_csv({"abc", 77, 10, {{"A_B", 12, 31.5}, {"B_A", 5, 8.25}}});
    const MeanTimes times = read(text);
    EXPECT_EQ(times.study_seed, 77U);
    EXPECT_EQ(times.replications, 10U);
    const std::vector<double> mean_s = mean_times_of(times, "times.csv", measured_crossings(), "abc");
    ASSERT_EQ(mean_s.size(), measured_crossings().edges().size());
    EXPECT_EQ(mean_s[measured_crossings().find_edge("A_B").value().value], 31.5);
    EXPECT_EQ(mean_s[measured_crossings().find_edge("B_A").value().value], 8.25);
    EXPECT_EQ(mean_s[measured_crossings().find_edge("B_east").value().value], 0.0);
}

TEST_F(MeanTimesFile, may_have_the_line_ends_and_the_mark_of_a_spreadsheet) {
    std::string text = "\xEF\xBB\xBF" + std::string(head) + columns + "A_B,12,31.5\nB_A,5,8.25\n";
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
        text.replace(at, 1, "\r\n");
    const MeanTimes times = read(text);
    ASSERT_EQ(times.edges.size(), 2U);
    EXPECT_EQ(times.edges[0].time_s, 31.5);
    EXPECT_EQ(times.edges[1].time_s, 8.25);
}

TEST_F(MeanTimesFile, is_refused_for_another_network) {
    const MeanTimes times = read(std::string(head) + columns + "A_B,12,31.5\nB_A,5,8\n");
    const auto problems =
        problems_of([&] { mean_times_of(times, "times.csv", measured_crossings(), "def"); });
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_THAT(core::format_problem(problems.front()),
                AllOf(HasSubstr("holds times of network abc"), HasSubstr("def"),
                      HasSubstr("clearway scenario mean-times")));
    const MeanTimes elsewhere{"abc", 77, 10, {{"nowhere", 5, 1.0}}};
    EXPECT_THAT(core::format_problem(problems_of([&] {
                                         mean_times_of(elsewhere, "t.csv", measured_crossings(), "abc");
                                     }).front()),
                HasSubstr("the network has no edge 'nowhere'"));
}

TEST_F(MeanTimesFile, is_refused_when_it_is_something_else) {
    EXPECT_THAT(refusal("", "signal,enabled\nA,1\n"),
                AllOf(HasSubstr("times.csv:1"), HasSubstr("no file of mean times"),
                      HasSubstr("clearway scenario mean-times")));
    EXPECT_THAT(refusal("", "# clearway mean times 1: network abc, study seed x, runs 10, edges 2\n"),
                HasSubstr("no file of mean times"));
    EXPECT_THAT(refusal("", std::string(head) + "edge;vehicles;time_s\n"), HasSubstr("are not the columns"));
    EXPECT_THAT(refusal("", ""), HasSubstr("no file of mean times"));
}

TEST_F(MeanTimesFile, is_refused_when_it_was_cut_short_or_damaged) {
    EXPECT_THAT(refusal("A_B,12,31.5\n"), AllOf(HasSubstr("has 1 row"), HasSubstr("its first line says 2")));
    EXPECT_THAT(refusal("A_B,12,31.5\nB_A,5\n"), AllOf(HasSubstr("times.csv:4"), HasSubstr("has 2 cells")));
    EXPECT_THAT(refusal("A_B,12,31.5\nB_A,5,-8\n"), HasSubstr("time_s: \"-8\""));
    EXPECT_THAT(refusal("A_B,12,31.5\nB_A,5,nan\n"), HasSubstr("time_s: \"nan\""));
    EXPECT_THAT(refusal("A_B,0,31.5\nB_A,5,8\n"), HasSubstr("vehicles: \"0\""));
    EXPECT_THAT(refusal(",12,31.5\nB_A,5,8\n"), HasSubstr("names no edge"));
    EXPECT_THAT(refusal("A_B,12,31.5\nA_B,5,8\n"), HasSubstr("edge 'A_B' is there twice"));
}

TEST_F(MeanTimesFile, has_to_be_in_the_folder_of_the_scenario_that_names_it) {
    write("line.nod.xml", line_nodes);
    write("line.edg.xml", line_edges);
    const auto refused = [&](const std::string& file) {
        const auto text = write("scenario.toml", line_head + ("mean_times = \"" + file + "\"\n"));
        const auto problems = problems_of([&] { load(text.string()); });
        std::string all;
        for (const core::Problem& problem : problems)
            all += core::format_problem(problem) + "\n";
        return all;
    };
    EXPECT_THAT(refused("gone.csv"), AllOf(HasSubstr("network.mean_times"), HasSubstr("no file")));
    EXPECT_THAT(refused("/tmp/times.csv"), HasSubstr("is not in the scenario's folder"));
    EXPECT_THAT(refused("../times.csv"), HasSubstr("leaves the scenario's folder"));
    write("times.csv", "nothing");
    EXPECT_THAT(refused("times.csv"), HasSubstr("no file of mean times"));
}

}  // namespace
}  // namespace clearway::scenario
