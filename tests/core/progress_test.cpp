#include "core/progress.hpp"

#include <gmock/gmock.h>

namespace clearway::core {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(ClockText, ShowsHoursOnlyWhenThereAreAny) {
    EXPECT_EQ(clock_text(0.0), "0:00");
    EXPECT_EQ(clock_text(7.4), "0:07");
    EXPECT_EQ(clock_text(59.6), "1:00");
    EXPECT_EQ(clock_text(754.0), "12:34");
    EXPECT_EQ(clock_text(3723.0), "1:02:03");
    EXPECT_EQ(clock_text(-5.0), "0:00");
}

TEST(ProgressBar, ShowsCountsFailuresAndTimes) {
    EXPECT_EQ(Progress::render_bar("merge", 15, 60, 2, 65.0),
              "merge [=======>                      ] 15/60, 2 failed, 1:05 elapsed, 3:15 left");
    EXPECT_THAT(Progress::render_bar("x", 0, 60, 0, 1.0), EndsWith("0/60, 0:01 elapsed"));
    EXPECT_THAT(Progress::render_bar("x", 60, 60, 0, 9.0),
                StartsWith("x [==============================] 60/60, 0:09 elapsed"));
    EXPECT_THAT(Progress::render_bar("x", 0, 0, 0, 0.0), HasSubstr("0/0"));
}

}  // namespace
}  // namespace clearway::core
