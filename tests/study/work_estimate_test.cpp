// The work of a study by the wall time of its runs.
#include "study/work_estimate.hpp"

#include <gtest/gtest.h>

namespace clearway::study {
namespace {

constexpr std::size_t cheap = 0;
constexpr std::size_t dear = 1;

TEST(WorkEstimate, ten_cheap_runs_are_a_small_part_of_a_study_with_ten_dear_ones) {
    WorkEstimate work({{1.0}, {9.0}});
    for (int i = 0; i < 10; ++i) {
        work.add(cheap);
        work.add(dear);
    }
    EXPECT_DOUBLE_EQ(work.total_s(), 100.0);
    for (int i = 0; i < 10; ++i)
        work.end(cheap, 1.0);
    EXPECT_DOUBLE_EQ(work.done_s() / work.total_s(), 0.1) << "half of the runs, a tenth of the work";
}

TEST(WorkEstimate, what_is_measured_corrects_what_is_expected_elsewhere) {
    WorkEstimate work({{1.0}, {9.0}});
    work.add(cheap);
    work.add(dear);
    work.end(cheap, 3.0);  // three times as long as expected
    EXPECT_DOUBLE_EQ(work.run_s(dear), 27.0);
    EXPECT_DOUBLE_EQ(work.done_s() / work.total_s(), 0.1);
    work.add(dear);
    work.end(dear, 5.0);
    EXPECT_DOUBLE_EQ(work.run_s(dear), 5.0);
    EXPECT_DOUBLE_EQ(work.total_s(), 13.0);
}

TEST(WorkEstimate, runs_of_an_empty_road_say_nothing_about_those_in_traffic) {
    WorkEstimate work({{1.0, 0}, {9.0, 1}});
    work.add(cheap);
    work.add(dear);
    work.end(cheap, 5.0);
    EXPECT_DOUBLE_EQ(work.run_s(dear), 9.0);
    EXPECT_DOUBLE_EQ(work.total_s(), 14.0);
}

}  // namespace
}  // namespace clearway::study
