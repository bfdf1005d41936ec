#include "training/repair_samples.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/repair_net.hpp"

namespace clearway::training {

using samples::RepairSample;
using samples::RepairSampleFile;

SeedSplit split_repair_files(const std::vector<RepairSampleFile>& files, const SplitShares& shares,
                             const char* model) {
    for (const RepairSampleFile& file : files) {
        const double radius_m = file.origin.link_radius_m;
        if (prediction::repair_radii.contains(radius_m)) continue;
        throw core::InputError({where_of(file.origin), fmt::format("links below {} m", radius_m),
                                fmt::format("{}, for which {} made", text(prediction::repair_radii), model),
                                "Record with another --link-radius"});
    }
    SeedSplit split = split_files(origins_of(files), shares, "SCENARIO --samples --net graphsage");
    const auto require_part = [&](const std::vector<DataSeed>& seeds, const char* part) {
        LabelCounts counts;
        for (const RepairSample* const sample : samples_of(files, seeds))
            counts.add(sample->linked);
        require_both_classes(counts, part);
    };
    require_part(split.train, "training");
    require_part(split.validation, "validation");
    require_part(split.test, "test");
    return split;
}

RepairSamples samples_of(const std::vector<RepairSampleFile>& files, const std::vector<DataSeed>& seeds) {
    RepairSamples samples;
    for (const RepairSampleFile& file : files) {
        if (!is_of(file.origin, seeds)) continue;
        for (const RepairSample& sample : file.samples)
            samples.push_back(&sample);
    }
    return samples;
}

void measure(const std::vector<RepairSampleFile>& files, const ScoreFile& score, TrainingResult& result) {
    const auto scores_of = [&](std::size_t file) {
        Scores scores;
        score(files[file], scores);
        for (const RepairSample& sample : files[file].samples) {
            scores.reference.insert(scores.reference.end(), sample.rule.begin(), sample.rule.end());
            scores.linked.insert(scores.linked.end(), sample.linked.begin(), sample.linked.end());
        }
        return scores;
    };
    measure(origins_of(files), scores_of, result);
}

}  // namespace clearway::training
