#include "training/repair_outputs.hpp"

#include "core/files.hpp"
#include "prediction/repair_net.hpp"
#include "training/detail/figures.hpp"
#include "training/loss_curve.hpp"
#include "training/outputs.hpp"
#include "training/state_dict.hpp"

namespace clearway::training {
namespace {

using detail::csv_group;
using detail::csv_value;
using detail::field_name;
using detail::Json;
using detail::json_from;

/// An interrupted training ends before it is measured.
bool is_measured(const RepairResult& result) {
    return !result.groups.empty();
}

std::vector<std::string> notes_of(const RepairResult& result, const RepairConfig& config,
                                  const std::string& data_hash) {
    return {fmt::format("trained by clearway train graphsage, seed {}, data {}", config.seed, data_hash),
            is_measured(result)
                ? fmt::format("threshold of greatest F1 on validation seeds {:.4f}", result.threshold)
                : fmt::format("interrupted after epoch {}, not measured", result.losses.size())};
}

}  // namespace

prediction::Weights repair_weights(const StateDict& state, const prediction::RepairDimensions& dimensions) {
    prediction::Weights weights;
    weights.architecture = prediction::repair_architecture;
    weights.features = prediction::repair_schema();
    weights.dimensions = {{"hidden", dimensions.hidden},    {"layers", dimensions.layers},
                          {"motion", dimensions.motion},    {"embedding", dimensions.embedding},
                          {"decoder", dimensions.decoder},  {"last", dimensions.last},
                          {"edge", prediction::edge_width}, {"pair", prediction::pair_width}};
    weights.inputs = prediction::repair_input_names();
    weights.tensors = state;
    return weights;
}

Identity identity_of(const RepairConfig& config, const std::string& data_hash) {
    return {{"mode", "graphsage"}, {"data_hash", data_hash}, {"configuration", json_from(config)}};
}

Json summary_of(const RepairResult& result, const RepairConfig& config, const std::filesystem::path& data,
                const std::string& data_hash) {
    Json summary = detail::summary_start(identity_of(config, data_hash), name(result.outcome), data);
    summary["arithmetic"] = detail::json_from(arithmetic());
    summary["parameter_count"] = result.parameter_count;
    summary["epochs_run"] = result.losses.size();
    summary["best_epoch"] = result.state.empty() ? Json(nullptr) : Json(result.best_epoch);
    summary["seeds"] = json_from(result.seeds);
    summary["train_snapshot_count"] = result.train_snapshots;
    summary["train_pair_count"] = result.train_pairs;
    summary["final_train_loss_nat"] =
        result.losses.empty() ? Json(nullptr) : Json(result.losses.back().train);
    summary["final_validation_loss_nat"] =
        result.losses.empty() ? Json(nullptr) : Json(result.losses.back().held_out);
    summary["test"] = Json::array();
    for (const RepairGroup& group : result.groups) {
        summary["test"].push_back({{"scenario", group.scenario.empty() ? Json("all") : Json(group.scenario)},
                                   {"failure", group.failure.empty() ? Json("all") : Json(group.failure)},
                                   {"net", json_from(group.net)},
                                   {"route_rule", json_from(group.rule)},
                                   {"displacement_error_m", group.displacement_error_m},
                                   {"route_rule_displacement_error_m", group.rule_displacement_error_m}});
    }
    return summary;
}

std::string metrics_csv(const RepairResult& result) {
    std::string text = "scenario,failure,predictor";
    core::for_each_field<metrics::LinkQuality>(
        [&](const auto& field) { text += "," + field_name(field.name, field.unit); });
    text += ",displacement_error_m\n";
    const auto row = [&](const RepairGroup& group, const char* predictor, const metrics::LinkQuality& quality,
                         double error_m) {
        text += fmt::format("{},{},{}", csv_group(group.scenario), csv_group(group.failure), predictor);
        core::for_each_field<metrics::LinkQuality>(
            [&](const auto& field) { text += "," + csv_value(quality.*field.member); });
        text += fmt::format(",{}\n", csv_value(error_m));
    };
    for (const RepairGroup& group : result.groups) {
        row(group, "graphsage", group.net, group.displacement_error_m);
        row(group, "route_rule", group.rule, group.rule_displacement_error_m);
    }
    return text;
}

void write_outputs(const std::filesystem::path& folder, const RepairResult& result,
                   const RepairConfig& config, const Json& summary) {
    core::make_folder(folder);
    core::write_atomically(folder / "losses.csv", losses_csv(result.losses, "validation"));
    core::write_atomically(folder / "train_test_curve.svg", loss_curve_svg(result.losses, "Validation Loss"));
    core::write_atomically(folder / "summary.json",
                           summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    if (result.state.empty()) return;
    if (is_measured(result)) core::write_atomically(folder / "metrics.csv", metrics_csv(result));
    if (!config.is_whole()) return;
    prediction::Weights weights = repair_weights(result.state, config.net().dimensions);
    weights.notes = notes_of(result, config, summary["data_hash"].get<std::string>());
    prediction::write_weights(folder / "graphsage.weights", weights);
}

}  // namespace clearway::training
