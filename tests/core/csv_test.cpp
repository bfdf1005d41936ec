#include "core/csv.hpp"

#include <string>
#include <vector>

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

TEST(Csv, rows_may_end_with_a_carriage_return_too) {
    CsvReader reader("a,1\r\n\"b\",\"2\r\"\r\n\r\nc\r,3\r");
    std::vector<std::vector<std::string>> rows;
    while (reader.next())
        rows.emplace_back(reader.cells().begin(), reader.cells().end());
    const std::vector<std::vector<std::string>> expected = {{"a", "1"}, {"b", "2\r"}, {""}, {"c\r", "3"}};
    EXPECT_EQ(rows, expected);
}

}  // namespace
}  // namespace clearway::core
