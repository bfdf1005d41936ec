#include "training/repair_scores.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "prediction/repair_net.hpp"
#include "training/detail/sample_parts.hpp"

namespace clearway::training {
namespace {

using samples::RepairSample;
using samples::RepairSampleFile;

void check_radius(const RepairSampleFile& file, const char* model) {
    const double radius_m = file.origin.link_radius_m;
    if (prediction::repair_radii.contains(radius_m)) return;
    throw core::InputError({fmt::format("--data: {}, {}, replication {}", file.origin.scenario,
                                        file.origin.failure, file.origin.replication),
                            fmt::format("links below {} m", radius_m),
                            fmt::format("{}, for which {} made", text(prediction::repair_radii), model),
                            "Record with another --link-radius"});
}

RepairScores scores_of(const RepairSampleFile& file, const ScoreFile& score) {
    RepairScores scores;
    score(file, scores);
    for (const RepairSample& sample : file.samples) {
        scores.rule.insert(scores.rule.end(), sample.rule.begin(), sample.rule.end());
        scores.linked.insert(scores.linked.end(), sample.linked.begin(), sample.linked.end());
    }
    return scores;
}

RepairGroup group_of(const std::string& scenario, const std::string& failure, const RepairScores& scores,
                     const RepairTraining& result) {
    RepairGroup group{scenario,
                      failure,
                      quality_of_logits(scores.logits, scores.linked, result.threshold),
                      metrics::link_quality({scores.rule, scores.linked}, result.rule_threshold),
                      {},
                      {}};
    if (scores.displacements) {
        const double count = static_cast<double>(std::max<std::size_t>(scores.displacements->count, 1));
        group.displacement_error_m = scores.displacements->model_m / count;
        group.rule_displacement_error_m = scores.displacements->rule_m / count;
    }
    return group;
}

}  // namespace

void RepairScores::append(const RepairScores& more) {
    logits.insert(logits.end(), more.logits.begin(), more.logits.end());
    rule.insert(rule.end(), more.rule.begin(), more.rule.end());
    linked.insert(linked.end(), more.linked.begin(), more.linked.end());
    if (!more.displacements) return;
    DisplacementErrors& sum = displacements ? *displacements : displacements.emplace();
    sum.model_m += more.displacements->model_m;
    sum.rule_m += more.displacements->rule_m;
    sum.count += more.displacements->count;
}

SeedSplit split_repair_files(const std::vector<RepairSampleFile>& files, const SplitShares& shares,
                             const char* model) {
    if (files.empty()) {
        throw core::InputError({"--data", "no samples", "",
                                "Record some with clearway dataset SCENARIO --samples --net graphsage"});
    }
    for (const RepairSampleFile& file : files)
        check_radius(file, model);
    return detail::split_files(files, shares);
}

RepairSamples samples_of(const std::vector<RepairSampleFile>& files, const std::vector<DataSeed>& seeds) {
    RepairSamples samples;
    for (const RepairSampleFile& file : files) {
        if (!detail::is_of(file, seeds)) continue;
        for (const RepairSample& sample : file.samples)
            samples.push_back(&sample);
    }
    return samples;
}

void require_both_classes(const RepairSamples& samples, const char* part) {
    detail::LabelCounts counts;
    for (const RepairSample* const sample : samples)
        counts.add(sample->linked);
    detail::require_both_classes(counts, part);
}

void measure(const std::vector<RepairSampleFile>& files, const ScoreFile& score, RepairTraining& result) {
    RepairScores validation, all;
    const auto by_radius = [](const RepairSampleFile& file) { return file.origin.link_radius_m; };
    const auto [least, most] = std::ranges::minmax_element(files, {}, by_radius);
    result.link_radius = {by_radius(*least), by_radius(*most)};
    std::map<std::string, RepairScores> by_failure;
    std::map<std::pair<std::string, std::string>, RepairScores> by_both;
    for (const RepairSampleFile& file : files) {
        if (detail::is_of(file, result.seeds.validation)) validation.append(scores_of(file, score));
        if (!detail::is_of(file, result.seeds.test)) continue;
        const RepairScores scores = scores_of(file, score);
        all.append(scores);
        by_failure[file.origin.failure].append(scores);
        by_both[{file.origin.failure, file.origin.scenario}].append(scores);
    }
    result.threshold = metrics::best_f1_threshold({probabilities(validation.logits), validation.linked});
    result.rule_threshold = metrics::best_f1_threshold({validation.rule, validation.linked});
    result.groups.push_back(group_of("", "", all, result));
    for (const auto& [failure, scores] : by_failure)
        result.groups.push_back(group_of("", failure, scores, result));
    for (const auto& [both, scores] : by_both)
        result.groups.push_back(group_of(both.second, both.first, scores, result));
}

}  // namespace clearway::training
