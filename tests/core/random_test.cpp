#include "core/random.hpp"

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "core/ids.hpp"

namespace clearway::core {
namespace {

const KeyedRandom random_numbers({1}, {0});

TEST(Fnv1a64, GivesThePublishedValues) {
    EXPECT_EQ(fnv1a64(""), 0xcbf29ce484222325ULL);
    EXPECT_EQ(fnv1a64("a"), 0xaf63dc4c8601ec8cULL);
    EXPECT_EQ(fnv1a64("foobar"), 0x85944171f73967e8ULL);
}

TEST(Mix64, GivesTheFirstOutputsOfSplitMix64) {
    EXPECT_EQ(mix64(0), 0xe220a8397b1dcdafULL);
    EXPECT_EQ(mix64(0x9e3779b97f4a7c15ULL), 0x6e789e6aa1b965f4ULL);
}

// Frozen: results on disk depend on these. A change here makes every stored study unrepeatable.
TEST(KeyedRandom, GivesTheFrozenValues) {
    EXPECT_EQ(random_numbers.bits(Purpose::demand, 0, 0), 0x11693ba2aabd56e7ULL);
    EXPECT_EQ(random_numbers.bits(Purpose::outage, 42, 7), 0x2fb0565135e58715ULL);
    EXPECT_EQ(KeyedRandom({2023}, {5}).bits(Purpose::driver, vehicle_key("veh1").value, 3),
              0x4f0ce95f51416b7dULL);
    EXPECT_EQ(random_numbers.below(1000, Purpose::demand, 8, 9), 611u);
    EXPECT_NEAR(random_numbers.uniform(Purpose::demand, 8, 9), 0.61110428099219727, 1e-15);
    EXPECT_NEAR(random_numbers.normal(Purpose::position_noise, 8, 9), 1.177814920814688, 1e-12);
    EXPECT_EQ(vehicle_key("veh1").value, 0x1fe8fe44d8c7f4c4ULL);
}

TEST(KeyedRandom, DependsOnEachPartOfItsKey) {
    std::set<std::uint64_t> draws;
    for (const std::uint64_t seed : {1, 2}) {
        for (const std::uint32_t replication : {0, 1}) {
            for (const Purpose purpose : {Purpose::report_loss, Purpose::outage}) {
                for (const std::uint64_t subject : {10, 11}) {
                    for (const std::uint64_t counter : {0, 1}) {
                        draws.insert(KeyedRandom({seed}, {replication}).bits(purpose, subject, counter));
                    }
                }
            }
        }
    }
    EXPECT_EQ(draws.size(), 32u);
}

TEST(KeyedRandom, DoesNotRememberEarlierDraws) {
    const double alone = KeyedRandom({3}, {4}).uniform(Purpose::driver, 5, 6);
    const KeyedRandom used({3}, {4});
    for (std::uint64_t draw = 0; draw < 100; ++draw) {
        used.normal(Purpose::driver, draw, draw);
    }
    EXPECT_EQ(used.uniform(Purpose::driver, 5, 6), alone);
}

/// Chi-square over 100 classes; 99 degrees of freedom exceed 180 with probability 1e-6.
double chi_square(const std::array<int, 100>& counts, int draws) {
    double sum = 0.0;
    for (const int count : counts) {
        const double excess = count - draws / 100.0;
        sum += excess * excess / (draws / 100.0);
    }
    return sum;
}

TEST(KeyedRandom, UniformDrawsFillTheIntervalEvenlyAlongSubjectsAndCounters) {
    constexpr int draws = 100'000;
    std::array<int, 100> by_subject{};
    std::array<int, 100> by_counter{};
    for (std::uint64_t draw = 0; draw < draws; ++draw) {
        const double over_subjects = random_numbers.uniform(Purpose::report_loss, draw);
        const double over_counters = random_numbers.uniform(Purpose::report_loss, 7, draw);
        ASSERT_GE(over_subjects, 0.0);
        ASSERT_LT(over_subjects, 1.0);
        ++by_subject[static_cast<std::size_t>(100.0 * over_subjects)];
        ++by_counter[static_cast<std::size_t>(100.0 * over_counters)];
    }
    EXPECT_LT(chi_square(by_subject, draws), 180.0);
    EXPECT_LT(chi_square(by_counter, draws), 180.0);
}

double correlation(const std::vector<double>& left, const std::vector<double>& right) {
    double sum = 0.0;
    for (std::size_t row = 0; row < left.size(); ++row) {
        sum += (left[row] - 0.5) * (right[row] - 0.5);
    }
    return 12.0 * sum / static_cast<double>(left.size());
}

TEST(KeyedRandom, NeighbouringKeysAreUncorrelated) {
    std::vector<double> here, next_subject, next_counter, other_purpose, next_replication;
    const KeyedRandom following({1}, {1});
    for (std::uint64_t draw = 0; draw < 100'000; ++draw) {
        here.push_back(random_numbers.uniform(Purpose::outage, draw, draw / 3));
        next_subject.push_back(random_numbers.uniform(Purpose::outage, draw + 1, draw / 3));
        next_counter.push_back(random_numbers.uniform(Purpose::outage, draw, draw / 3 + 1));
        other_purpose.push_back(random_numbers.uniform(Purpose::report_loss, draw, draw / 3));
        next_replication.push_back(following.uniform(Purpose::outage, draw, draw / 3));
    }
    // The standard error of a correlation of 100,000 pairs is 0.0032.
    for (const auto* other : {&next_subject, &next_counter, &other_purpose, &next_replication}) {
        EXPECT_LT(std::abs(correlation(here, *other)), 0.016);
    }
}

TEST(KeyedRandom, NormalDrawsHaveTheMomentsOfTheNormalDistribution) {
    constexpr int draws = 200'000;
    double sum = 0.0, squares = 0.0, fourth = 0.0;
    for (std::uint64_t draw = 0; draw < draws; ++draw) {
        const double value = random_numbers.normal(Purpose::position_noise, draw);
        sum += value;
        squares += value * value;
        fourth += value * value * value * value;
    }
    EXPECT_NEAR(sum / draws, 0.0, 0.012);
    EXPECT_NEAR(squares / draws, 1.0, 0.016);
    EXPECT_NEAR(fourth / draws, 3.0, 0.11);
}

TEST(KeyedRandom, BelowReachesEveryNumberEvenly) {
    std::array<int, 7> counts{};
    for (std::uint64_t draw = 0; draw < 70'000; ++draw) {
        ++counts.at(random_numbers.below(7, Purpose::bootstrap, draw));
    }
    for (const int count : counts) {
        EXPECT_NEAR(count, 10'000, 500);
    }
    EXPECT_EQ(random_numbers.below(1, Purpose::bootstrap, 3), 0u);
}

TEST(VehicleKey, DependsOnTheIdAlone) {
    EXPECT_EQ(vehicle_key("veh1"), vehicle_key(std::string("veh") + "1"));
    std::set<VehicleKey> keys;
    for (int number = 0; number < 100'000; ++number) {
        keys.insert(vehicle_key("veh" + std::to_string(number)));
    }
    EXPECT_EQ(keys.size(), 100'000u);
}

TEST(Index, KnowsWhenThereIsNone) {
    EXPECT_FALSE(LaneIndex::none().exists());
    EXPECT_FALSE(LaneIndex{}.exists());
    EXPECT_TRUE(LaneIndex{0}.exists());
    EXPECT_LT(LaneIndex{3}, LaneIndex{4});
}

}  // namespace
}  // namespace clearway::core
