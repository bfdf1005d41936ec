#include "core/csv.hpp"

#include <gtest/gtest.h>

namespace clearway::core {
namespace {

TEST(Csv, quotes_a_cell_only_where_a_reader_needs_it) {
    EXPECT_EQ(csv_text("B10"), "B10");
    EXPECT_EQ(csv_text(""), "");
    EXPECT_EQ(csv_text("B10,dark_share=0.5"), "\"B10,dark_share=0.5\"");
    EXPECT_EQ(csv_text("a \"b\""), "\"a \"\"b\"\"\"");
    EXPECT_EQ(csv_text("two\nlines"), "\"two\nlines\"");
}

}  // namespace
}  // namespace clearway::core
