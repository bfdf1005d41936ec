#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "training/detail/figures.hpp"
#include "training/gradient_boosting.hpp"
#include "training/loss_curve.hpp"
#include "training/outputs.hpp"

namespace clearway::training {
namespace {

using detail::csv_group;
using detail::csv_value;
using detail::field_name;
using detail::Json;
using detail::json_from;

std::string metrics_csv(const BoostingResult& result) {
    std::string text = "scenario,failure,predictor";
    core::for_each_field<metrics::LinkQuality>(
        [&](const auto& field) { text += "," + field_name(field.name, field.unit); });
    text += "\n";
    const auto row = [&](const BoostingGroup& group, const char* predictor,
                         const metrics::LinkQuality& quality) {
        text += fmt::format("{},{},{}", csv_group(group.scenario), csv_group(group.failure), predictor);
        core::for_each_field<metrics::LinkQuality>(
            [&](const auto& field) { text += "," + csv_value(quality.*field.member); });
        text += "\n";
    };
    for (const BoostingGroup& group : result.groups) {
        row(group, "gradient_boosting", group.trees);
        row(group, "route_rule", group.rule);
    }
    return text;
}

}  // namespace

Identity identity_of(const BoostingConfig& config, const std::string& data_hash) {
    return {{"mode", "gradient_boosting"}, {"data_hash", data_hash}, {"configuration", json_from(config)}};
}

Json summary_of(const BoostingResult& result, const BoostingConfig& config, const std::filesystem::path& data,
                const std::string& data_hash) {
    Json summary = detail::summary_start(identity_of(config, data_hash), name(result.outcome), data);
    summary["trees_grown"] = result.losses.size();
    summary["trees_kept"] = result.losses.empty() ? Json(nullptr) : Json(result.best_tree + 1);
    summary["seeds"] = json_from(result.seeds);
    summary["train_pair_count"] = result.train_pairs;
    const bool grown = !result.losses.empty();
    summary["train_loss_nat"] = grown ? Json(result.losses[result.best_tree].train) : Json(nullptr);
    summary["validation_loss_nat"] = grown ? Json(result.losses[result.best_tree].held_out) : Json(nullptr);
    summary["test"] = Json::array();
    for (const BoostingGroup& group : result.groups) {
        summary["test"].push_back({{"scenario", group.scenario.empty() ? Json("all") : Json(group.scenario)},
                                   {"failure", group.failure.empty() ? Json("all") : Json(group.failure)},
                                   {"trees", json_from(group.trees)},
                                   {"route_rule", json_from(group.rule)}});
    }
    return summary;
}

void write_outputs(const std::filesystem::path& folder, const BoostingResult& result, const Json& summary) {
    core::make_folder(folder);
    core::write_atomically(folder / "losses.csv", losses_csv(result.losses, "validation"));
    core::write_atomically(folder / "train_test_curve.svg", loss_curve_svg(result.losses, "Validation Loss"));
    core::write_atomically(folder / "summary.json",
                           summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    if (result.losses.empty()) return;
    if (!result.groups.empty()) core::write_atomically(folder / "metrics.csv", metrics_csv(result));
    prediction::Weights weights = result.weights;
    weights.notes = {
        fmt::format("trained by clearway train gradient_boosting, seed {}, data {}",
                    summary["configuration"]["seed"].get<std::uint64_t>(),
                    summary["data_hash"].get<std::string>()),
        result.groups.empty()
            ? fmt::format("interrupted after tree {}, not measured", result.losses.size())
            : fmt::format("threshold of greatest F1 on validation seeds {:.4f}", result.threshold)};
    prediction::write_weights(folder / "gradient_boosting.weights", weights);
}

}  // namespace clearway::training
