#include "training/seeds.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "core/error.hpp"

namespace clearway::training {

SeedSplit split_seeds(std::vector<DataSeed> seeds, const SplitShares& shares) {
    std::ranges::sort(seeds);
    seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
    if (seeds.size() < 3) {
        throw core::InputError(
            {"--data", core::counted(seeds.size(), "seed"), "3 seeds or more",
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

SeedSplit split_files(const Origins& origins, const SplitShares& shares, const std::string& recording) {
    if (origins.empty())
        throw core::InputError(
            {"--data", "no samples", "", "Record some with clearway links dataset " + recording});
    std::vector<DataSeed> seeds;
    for (const samples::SampleOrigin* const origin : origins)
        seeds.push_back({origin->study_seed, origin->replication});
    return split_seeds(std::move(seeds), shares);
}

bool is_of(const samples::SampleOrigin& origin, const std::vector<DataSeed>& seeds) {
    return std::ranges::binary_search(seeds, DataSeed{origin.study_seed, origin.replication});
}

prediction::RadiusRange link_radii(const Origins& origins) {
    const auto [least, most] =
        std::ranges::minmax_element(origins, {}, &samples::SampleOrigin::link_radius_m);
    return {(*least)->link_radius_m, (*most)->link_radius_m};
}

void require_alike(const Origins& origins) {
    const auto text = [](const samples::SampleOrigin& origin) {
        return fmt::format("features {} {} ({} inputs), links below {} m", origin.features.name,
                           origin.features.version, origin.features.width, origin.link_radius_m);
    };
    for (const samples::SampleOrigin* const origin : origins) {
        const samples::SampleOrigin& first = *origins.front();
        if (origin->features == first.features && origin->link_radius_m == first.link_radius_m) continue;
        throw core::InputError({where_of(*origin), text(*origin), text(first) + ", as in the other files",
                                "Record all files with one version of the program and one link radius"});
    }
}

std::string where_of(const samples::SampleOrigin& origin) {
    return fmt::format("--data: {}, {}, replication {}", origin.scenario, origin.failure, origin.replication);
}

void require_both_classes(const LabelCounts& counts, const char* part) {
    if (counts.linked > 0 && counts.unlinked > 0) return;
    const bool empty = counts.linked + counts.unlinked == 0;
    throw core::InputError({"--data",
                            empty ? fmt::format("the {} seeds hold no candidate pair", part)
                                  : fmt::format("the {} seeds hold only pairs that are {}linked", part,
                                                counts.linked > 0 ? "" : "not "),
                            "linked and unlinked pairs in each part",
                            "Record denser traffic, a sensor failure, or more seeds"});
}

}  // namespace clearway::training
