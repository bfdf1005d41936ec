#include "training/outputs.hpp"

#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "training/detail/figures.hpp"
#include "training/loss_curve.hpp"
#include "training/state_dict.hpp"

namespace clearway::training {
namespace {

using Json = nlohmann::ordered_json;

using detail::csv_group;
using detail::csv_value;
using detail::field_name;
using detail::json_from;
using detail::json_value;

Json last_loss(const std::vector<EpochLoss>& losses, double EpochLoss::*member) {
    // A loss that is not finite becomes null: JSON cannot write it.
    return losses.empty() ? Json(nullptr) : Json(losses.back().*member);
}

std::string note_of(const Json& summary) {
    return fmt::format("trained by clearway train, {}, seed {}, data {}", summary["mode"].get<std::string>(),
                       summary["configuration"]["seed"].get<std::uint64_t>(),
                       summary["data_hash"].get<std::string>());
}

// NOLINTNEXTLINE(readability-function-size): every argument is a file or what goes into it
void write_model(const std::filesystem::path& folder, const std::string& model, const StateDict& state,
                 const prediction::FeatureSchema& features, const TrainingConfig& config, const Json& summary,
                 Convolution convolution, double link_radius_m) {
    prediction::Weights weights =
        weights_from(state, features, {features.width, config.hidden, config.output}, convolution);
    weights.link_radius = {link_radius_m, link_radius_m};
    weights.notes.push_back(note_of(summary));
    prediction::write_weights(folder / (model + ".weights"), weights);
    const std::string net = convolution == Convolution::sage ? "GraphSAGENet" : model;
    write_pth(folder / (net + ".pth"), state);
}

/// What a training on many snapshots is called.
std::string mode_of(Convolution convolution) {
    return convolution == Convolution::sage ? "corrected" : std::string(name(convolution));
}

}  // namespace

Identity identity_of(PairChoice pairs, const RunDescription& run) {
    return {{"mode", "as_published"},
            {"data_hash", run.data_hash},
            {"configuration", json_from(run.training)},
            {"pairs", pairs == PairChoice::true_only ? "true-links" : "candidates"}};
}

Identity identity_of(const CorrectedConfig& config, const RunDescription& run) {
    Json configuration = json_from(run.training);
    configuration.update(json_from(config));
    // The mode says it; trainings of before there was a choice go on.
    configuration.erase("convolution");
    return {{"mode", mode_of(config.convolution)},
            {"data_hash", run.data_hash},
            {"configuration", configuration}};
}

Json summary_of(const AsPublishedResult& result, PairChoice pairs, const RunDescription& run) {
    Json summary = detail::summary_start(identity_of(pairs, run), name(result.outcome), run.data);
    summary["arithmetic"] = detail::json_from(arithmetic());
    summary["epochs_run"] = result.losses.size();
    summary["vehicle_count"] = result.dataset.vehicle_count();
    summary["feature_count"] = result.dataset.feature_count;
    summary["pair_count"] = result.dataset.pair_count();
    summary["train_pair_count"] = result.split.train;
    summary["test_pair_count"] = result.split.test;
    summary["final_train_loss_nat"] = last_loss(result.losses, &EpochLoss::train);
    summary["final_test_loss_nat"] = last_loss(result.losses, &EpochLoss::held_out);
    summary["constant_test_loss_nat"] = result.constant_test_loss;
    if (!result.state.empty()) {
        summary["train"] = json_from(result.train_quality);
        summary["test"] = json_from(result.test_quality);
    }
    for (const UnseenQuality& unseen : result.unseen) {
        summary["unseen"].push_back({{"data", unseen.data},
                                     {"messages_listed", json_from(unseen.listed)},
                                     {"messages_true_links", json_from(unseen.true_links)},
                                     {"messages_none", json_from(unseen.no_messages)}});
    }
    summary["warnings"] = result.warnings;
    return summary;
}

Json summary_of(const CorrectedResult& result, const CorrectedConfig& config, const RunDescription& run) {
    Json summary = detail::summary_start(identity_of(config, run), name(result.outcome), run.data);
    summary["arithmetic"] = detail::json_from(arithmetic());
    summary["epochs_run"] = result.losses.size();
    summary["seeds"] = json_from(result.seeds);
    summary["train_snapshot_count"] = result.train_snapshots;
    summary["train_pair_count"] = result.train_pairs;
    summary["final_train_loss_nat"] = last_loss(result.losses, &EpochLoss::train);
    summary["final_validation_loss_nat"] = last_loss(result.losses, &EpochLoss::held_out);
    summary["best_epoch"] = result.state.empty() ? Json(nullptr) : Json(result.best_epoch);
    summary["test"] = Json::array();
    for (const GroupQuality& group : result.groups) {
        summary["test"].push_back({{"scenario", group.scenario.empty() ? Json("all") : Json(group.scenario)},
                                   {"failure", group.failure.empty() ? Json("all") : Json(group.failure)},
                                   {"net", json_from(group.net)},
                                   {"dead_reckoning",
                                    {{"auc", json_value(group.dead_reckoning.auc)},
                                     {"ap", json_value(group.dead_reckoning.ap)},
                                     {"f1", json_value(group.dead_reckoning.f1)}}}});
    }
    return summary;
}

std::string losses_csv(const std::vector<EpochLoss>& losses, const std::string& held_out) {
    std::string text = fmt::format("epoch,train_loss_nat,{}_loss_nat\n", held_out);
    for (std::size_t epoch = 0; epoch < losses.size(); ++epoch) {
        text += fmt::format("{},{},{}\n", epoch, csv_value(losses[epoch].train),
                            csv_value(losses[epoch].held_out));
    }
    return text;
}

std::string predictions_csv(const AsPublishedResult& result) {
    std::string text = "pair,source,target,label,split,logit,probability\n";
    const std::vector<double> probability = probabilities(result.logits);
    for (std::size_t pair = 0; pair < result.logits.size(); ++pair) {
        text +=
            fmt::format("{},{},{},{},{},{},{}\n", pair, result.dataset.source[pair],
                        result.dataset.target[pair], result.dataset.label[pair],
                        pair < result.split.train ? "train" : "test", result.logits[pair], probability[pair]);
    }
    return text;
}

std::string metrics_csv(const CorrectedResult& result) {
    std::string text = "scenario,failure";
    core::for_each_field<metrics::LinkQuality>(
        [&](const auto& field) { text += "," + field_name(field.name, field.unit); });
    text += ",dead_reckoning_auc,dead_reckoning_ap,dead_reckoning_f1\n";
    for (const GroupQuality& group : result.groups) {
        text += csv_group(group.scenario) + "," + csv_group(group.failure);
        core::for_each_field<metrics::LinkQuality>(
            [&](const auto& field) { text += "," + csv_value(group.net.*field.member); });
        text += fmt::format(",{},{},{}\n", csv_value(group.dead_reckoning.auc),
                            csv_value(group.dead_reckoning.ap), csv_value(group.dead_reckoning.f1));
    }
    return text;
}

void write_common(const std::filesystem::path& folder, const std::vector<EpochLoss>& losses,
                  const std::string& held_out, const std::string& label, const Json& summary) {
    core::make_folder(folder);
    core::write_atomically(folder / "losses.csv", losses_csv(losses, held_out));
    core::write_atomically(folder / "train_test_curve.svg", loss_curve_svg(losses, label));
    core::write_atomically(folder / "summary.json",
                           summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void write_outputs(const std::filesystem::path& folder, const AsPublishedResult& result, const Json& summary,
                   const TrainingConfig& config) {
    write_common(folder, result.losses, "test", "Test Loss", summary);
    if (result.state.empty()) return;
    core::write_atomically(folder / "predictions.csv", predictions_csv(result));
    write_model(folder, "graphsage_as_published", result.state,
                as_published_schema(result.dataset.feature_count), config, summary, Convolution::sage,
                prediction::RadiusRange{}.least_m);  // The data do not say which.
}

void write_outputs(const std::filesystem::path& folder, const CorrectedResult& result, const Json& summary,
                   const TrainingConfig& config, const prediction::FeatureSchema& features) {
    write_common(folder, result.losses, "validation", "Validation Loss", summary);
    if (result.state.empty()) return;
    core::write_atomically(folder / "metrics.csv", metrics_csv(result));
    const bool is_sage = result.convolution == Convolution::sage;
    const std::string model = is_sage ? "graphsage_corrected" : std::string(name(result.convolution));
    write_model(folder, model, result.state, features, config, summary, result.convolution,
                result.link_radius_m);
}

std::string hash_of_files(const std::vector<std::filesystem::path>& files) {
    std::string hashes;
    for (const std::filesystem::path& file : files)
        hashes += core::content_hash(core::read_file(file));
    return core::content_hash(hashes);
}

void require_distinct(const std::vector<std::filesystem::path>& files,
                      const std::vector<std::string>& hashes) {
    std::map<std::string, std::filesystem::path> first;
    std::vector<core::Problem> problems;
    for (std::size_t at = 0; at < files.size(); ++at) {
        const auto [earlier, is_new] = first.emplace(hashes[at], files[at]);
        if (is_new) continue;
        problems.push_back({files[at].string(),
                            fmt::format("holds the same as {}", earlier->second.filename().string()),
                            "each recording once", "Remove one of them"});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

}  // namespace clearway::training
