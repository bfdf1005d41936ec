// One table, printed as text and as JSON.
#include "campaign/printout.hpp"

#include <gmock/gmock.h>

namespace clearway::campaign {
namespace {

Table ships() {
    return {"ships",
            {{"name", "ship"}, {"length_m", "length, m"}, {"", "cargo"}, {"crew", ""}},
            {{{"Ane", 12.5, core::Json{"tea", "salt"}, 3}}, {{"Bö", nullptr, "-", 4}, {"in dock"}}}};
}

TEST(Printout, aligns_columns_and_leaves_out_what_has_no_title) {
    EXPECT_EQ(text_of(ships()),
              "ship  length, m  cargo\n"
              "Ane        12.5  tea+salt\n"
              "Bö            -  -\n"
              "    in dock\n");
    EXPECT_EQ(
        text_of({"", {{"", "set"}}, {{{core::Json{{"a", 1}, {"b", "two"}}}}, {{core::Json::object()}}}}),
        "set\n"
        "a=1 b=two\n"
        "-\n");
}

TEST(Printout, a_last_column_of_words_keeps_to_80_columns) {
    const std::string words =
        "nine ships of the line and a tender with tea for the whole of the long way home";
    EXPECT_EQ(text_of({"", {{"", "grade"}, {"", "text"}}, {{{"ok", words}}}}),
              "grade  text\n"
              "ok     nine ships of the line and a tender with tea for the whole of the long\n"
              "       way home\n");
    const std::string wide(60, 'x');
    EXPECT_EQ(text_of({"", {{"", "a"}, {"", "b"}}, {{{wide, "one two three four five six"}}}}),
              "a" + std::string(61, ' ') + "b\n" + wide + "  one two three four\n    five six\n");
}

TEST(Printout, json_has_the_facts_and_what_has_a_key) {
    testing::internal::CaptureStdout();
    print({{{"harbour", "Aarhus"}}, {ships()}, "unheard"}, Printing::json);
    EXPECT_EQ(
        core::Json::parse(testing::internal::GetCapturedStdout()),
        core::Json::parse(R"({"harbour": "Aarhus", "ships": [{"name": "Ane", "length_m": 12.5, "crew": 3},
                                    {"name": "Bö", "length_m": null, "crew": 4}]})"));
}

TEST(Printout, a_table_without_a_key_is_all_of_the_json) {
    Table table = ships();
    table.key = "";
    testing::internal::CaptureStdout();
    print({.tables = {table}}, Printing::json);
    EXPECT_TRUE(core::Json::parse(testing::internal::GetCapturedStdout()).is_array());
}

}  // namespace
}  // namespace clearway::campaign
