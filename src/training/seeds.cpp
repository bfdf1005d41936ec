#include "training/seeds.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/random.hpp"

namespace clearway::training {

SeedSplit split_seeds(std::vector<DataSeed> seeds, const SplitShares& shares) {
    std::ranges::sort(seeds);
    seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
    if (seeds.size() < 3) {
        throw core::InputError(
            {"--data", fmt::format("{} seed{}", seeds.size(), seeds.size() == 1 ? "" : "s"),
             "3 seeds or more",
             "Training, validation and test each need seeds of their own: record more replications"});
    }
    const core::KeyedRandom random(core::StudySeed{shares.seed}, core::Replication{0});
    const auto draw = [&](const DataSeed& seed) {
        return random.bits(core::Purpose::training, core::mix64(seed.study_seed) ^ seed.replication, 1);
    };
    std::ranges::stable_sort(seeds, {}, draw);
    const auto part = [&](double share) {
        return std::max<std::size_t>(
            1, static_cast<std::size_t>(std::lround(share * static_cast<double>(seeds.size()))));
    };
    const std::size_t test = part(shares.test);
    const std::size_t validation = part(shares.validation);
    if (test + validation >= seeds.size()) {
        throw core::InputError({"--validation-share, --test-share",
                                fmt::format("{} and {} take {} and {} of {} seeds", shares.validation,
                                            shares.test, validation, test, seeds.size()),
                                "shares that leave a seed to train on",
                                "Give smaller shares, or record more replications"});
    }
    const auto first_validation = seeds.begin() + static_cast<std::ptrdiff_t>(test);
    const auto first_train = first_validation + static_cast<std::ptrdiff_t>(validation);
    SeedSplit split{
        {first_train, seeds.end()}, {first_validation, first_train}, {seeds.begin(), first_validation}};
    for (auto* seeds_of_part : {&split.train, &split.validation, &split.test})
        std::ranges::sort(*seeds_of_part);
    return split;
}

}  // namespace clearway::training
