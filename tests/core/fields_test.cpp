#include "core/fields.hpp"

#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "core/number_range.hpp"
#include "core/settings.hpp"
#include "core/units.hpp"

namespace clearway::core {
namespace {

struct Config {
    double radius_m = 50.0;
    int lanes = 2;
    std::string name = "city";

    static constexpr void fields(const auto& table) {
        table(Field{"radius_m", "m", &Config::radius_m, 1.0, 1000.0, "Link radius.", "assumed"},
              Field{"lanes", "1", &Config::lanes, 1.0, 9.0, "Lanes.", "TABLE I"},
              Field{"name", "", &Config::name, 0.0, 0.0, "Name.", ""});
    }
};

struct Share {
    double share = 0.9;
    static constexpr void fields(const auto& table) {
        table(Field{"share", "1", &Share::share, 0.95, 1.0, "A share.", "assumed"});
    }
};

TEST(Fields, AreVisitedInTheOrderOfTheirTable) {
    std::vector<std::string> names;
    for_each_field<Config>([&](const auto& field) { names.emplace_back(field.name); });
    EXPECT_EQ(names, (std::vector<std::string>{"radius_m", "lanes", "name"}));
}

TEST(Fields, ReachTheirMembers) {
    Config config;
    for_each_field<Config>([&](const auto& field) {
        auto& value = config.*field.member;
        if constexpr (std::is_arithmetic_v<std::remove_reference_t<decltype(value)>>) {
            EXPECT_GE(static_cast<double>(value), field.minimum);
            EXPECT_LE(static_cast<double>(value), field.maximum);
            value *= 2;
        } else {
            value += "!";
        }
    });
    EXPECT_EQ(config.radius_m, 100.0);
    EXPECT_EQ(config.lanes, 4);
    EXPECT_EQ(config.name, "city!");
}

TEST(NumberRange, holds_its_ends_and_nothing_that_is_not_finite) {
    const NumberRange range{0.5, 2.0};
    for (const char* const inside : {"0.5", "1", "2.0", "2e0"})
        EXPECT_EQ(range(inside), "") << inside;
    for (const char* const outside : {"0.49", "2.1", "-1", "nan", "-nan", "inf", "-inf"})
        EXPECT_EQ(range(outside), std::string(outside) + " is out of range (allowed: 0.5 to 2)");
    for (const char* const word : {"", "one", "1 ", "1e999", "1,5"})
        EXPECT_EQ(range(word), "\"" + std::string(word) + "\" is not a number (allowed: 0.5 to 2)");
}

TEST(SettingsTable, IsNotCompiledWithADefaultOutOfItsRange) {
    EXPECT_TRUE(defaults_lie_in_their_ranges<Config>());
    EXPECT_FALSE(defaults_lie_in_their_ranges<Share>());
}

TEST(Units, ConvertAndCompare) {
    EXPECT_DOUBLE_EQ(from_kmh(36.0).value, 10.0);
    EXPECT_LT(Seconds(1.0), Seconds(1.5));
    EXPECT_DOUBLE_EQ((Metres(3.0) - Metres(1.0) * 2.0).value, 1.0);
    EXPECT_DOUBLE_EQ(Metres(10.0) / Metres(4.0), 2.5);
    Seconds time(1.0);
    time += Seconds(0.25);
    EXPECT_EQ(time, Seconds(1.25));
}

}  // namespace
}  // namespace clearway::core
