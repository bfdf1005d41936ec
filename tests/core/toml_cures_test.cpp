#include <gmock/gmock.h>

#include "core/strict_table.hpp"
#include "support/message_of.hpp"

namespace clearway::core {
namespace {

using support::message_of;
using testing::AllOf;
using testing::HasSubstr;

std::string refusal(const std::string& text) {
    return message_of([&] { parse_toml(text, "city.toml"); });
}

TEST(TomlErrors, TellHowToWriteADecimalComma) {
    EXPECT_THAT(refusal("name = \"x\"\nlatitude = 43,7\n"),
                AllOf(HasSubstr("city.toml:2:"), HasSubstr("Write 43.7: decimals have a point")));
    EXPECT_THAT(refusal("x = -0,25  # west\r\n"), HasSubstr("Write -0.25"));
    EXPECT_THAT(refusal("x = y\n"), HasSubstr("texts stand in quotes"));
    EXPECT_THAT(refusal("[network\nfile = \"a\"\n"), HasSubstr("Write [network]"));
}

TEST(TomlErrors, DoNotTakeABareWordForABooleanOrANumber) {
    for (const char* const word : {"ten", "falcon", "nothing", "inside"})
        EXPECT_THAT(refusal(std::string("replications = ") + word + "\n"),
                    AllOf(HasSubstr("city.toml:1:"), HasSubstr("neither a number, nor true or false")))
            << word;
    EXPECT_THAT(refusal("replications = 1.2.3\n"), testing::Not(HasSubstr("neither a number")));
}

TEST(TomlErrors, TellThatRowsHaveTwoBrackets) {
    EXPECT_THAT(refusal("[incident]\nedge = \"a\"\n[incident]\nedge = \"b\"\n"),
                HasSubstr("Write [[incident]], with two brackets"));
    TomlReading reading;
    reading.file = "city.toml";
    const toml::table table = parse_toml("[emergency_site]\nkind = \"hospital\"\n", "city.toml");
    StrictTable root(table, "", reading);
    EXPECT_TRUE(root.rows("emergency_site").empty());
    ASSERT_EQ(reading.problems.size(), 1U);
    EXPECT_THAT(format_problem(reading.problems.front()),
                AllOf(HasSubstr("is a table"), HasSubstr("Write [[emergency_site]], with two brackets")));
}

TEST(TomlErrors, TellTheValueOfAWrongTypeAndWhichNumbersAreAllowed) {
    TomlReading reading;
    reading.file = "city.toml";
    const toml::table table =
        parse_toml("from_s = \"\"\npasses = true\nroads = [\"a\", 3]\nname = [1]\n", "city.toml");
    StrictTable root(table, "", reading);
    std::optional<double> number;
    int passes = 7;
    std::vector<std::string> roads;
    std::string name;
    root.number("from_s", number);
    root.integer("passes", 0, 1, passes);
    root.texts("roads", roads);
    root.text("name", name);
    std::vector<std::string> told;
    for (const Problem& problem : reading.problems)
        told.push_back(format_problem(problem));
    EXPECT_THAT(told,
                testing::ElementsAre(
                    "city.toml:1:1: from_s: is text, \"\" (allowed: a number)",
                    "city.toml:2:1: passes: is a truth value, true (allowed: a whole number from 0 to 1)",
                    "city.toml:3:1: roads: is a number, 3 (allowed: an array of texts)",
                    "city.toml:4:1: name: is an array (allowed: text)"));
    EXPECT_EQ(passes, 7);
}

}  // namespace
}  // namespace clearway::core
