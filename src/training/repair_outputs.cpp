#include "training/repair_outputs.hpp"

#include "core/files.hpp"
#include "prediction/repair_net.hpp"
#include "training/detail/figures.hpp"
#include "training/outputs.hpp"
#include "training/state_dict.hpp"

namespace clearway::training {
namespace {

using detail::csv_group;
using detail::csv_value;
using detail::field_name;
using detail::Json;
using detail::json_from;

/// What weights say of their training; `round` is what one of its rounds is called.
std::vector<std::string> notes_of(const RepairTraining& result, const Json& summary, const char* round) {
    return {fmt::format("trained by clearway train {}, seed {}, data {}", summary["mode"].get<std::string>(),
                        summary["configuration"]["seed"].get<std::uint64_t>(),
                        summary["data_hash"].get<std::string>()),
            result.groups.empty()
                ? fmt::format("interrupted after {} {}, not measured", round, result.losses.size())
                : fmt::format("threshold of greatest F1 on validation seeds {:.4f}", result.threshold)};
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
    summary["test"] = test_summary(result.groups, "net");
    return summary;
}

Json test_summary(const std::vector<RepairGroup>& groups, const char* model) {
    Json list = Json::array();
    for (const RepairGroup& group : groups) {
        list.push_back({{"scenario", group.scenario.empty() ? Json("all") : Json(group.scenario)},
                        {"failure", group.failure.empty() ? Json("all") : Json(group.failure)},
                        {model, json_from(group.model)},
                        {"route_rule", json_from(group.rule)}});
        if (!group.displacement_error_m) continue;
        list.back()["displacement_error_m"] = *group.displacement_error_m;
        list.back()["route_rule_displacement_error_m"] = group.rule_displacement_error_m.value();
    }
    return list;
}

std::string metrics_csv(const std::vector<RepairGroup>& groups, const std::string& predictor) {
    std::string text = "scenario,failure,predictor";
    core::for_each_field<metrics::LinkQuality>(
        [&](const auto& field) { text += "," + field_name(field.name, field.unit); });
    const bool moves = groups.front().displacement_error_m.has_value();
    text += moves ? ",displacement_error_m\n" : "\n";
    const auto row = [&](const RepairGroup& group, const std::string& name,
                         const metrics::LinkQuality& quality, const std::optional<double>& error_m) {
        text += fmt::format("{},{},{}", csv_group(group.scenario), csv_group(group.failure), name);
        core::for_each_field<metrics::LinkQuality>(
            [&](const auto& field) { text += "," + csv_value(quality.*field.member); });
        text += moves ? "," + csv_value(error_m) + "\n" : "\n";
    };
    for (const RepairGroup& group : groups) {
        row(group, predictor, group.model, group.displacement_error_m);
        row(group, "route_rule", group.rule, group.rule_displacement_error_m);
    }
    return text;
}

void write_outputs(const std::filesystem::path& folder, const RepairTraining& result, const Json& summary,
                   const char* round, prediction::Weights weights) {
    write_common(folder, result.losses, "validation", "Validation Loss", summary);
    const auto predictor = summary["mode"].get<std::string>();
    if (!result.groups.empty())
        core::write_atomically(folder / "metrics.csv", metrics_csv(result.groups, predictor));
    if (weights.tensors.empty()) return;
    weights.link_radius = result.link_radius;
    weights.notes = notes_of(result, summary, round);
    prediction::write_weights(folder / (predictor + ".weights"), weights);
}

void write_outputs(const std::filesystem::path& folder, const RepairResult& result,
                   const RepairConfig& config, const Json& summary) {
    const bool runs = config.is_whole() && !result.state.empty();
    write_outputs(folder, result, summary, "epoch",
                  runs ? repair_weights(result.state, config.net().dimensions) : prediction::Weights{});
}

}  // namespace clearway::training
