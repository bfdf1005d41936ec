#include <nlohmann/json.hpp>

#include "training/detail/figures.hpp"
#include "training/gradient_boosting.hpp"
#include "training/repair_outputs.hpp"

namespace clearway::training {

using detail::Json;
using detail::json_from;

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
    summary["test"] = test_summary(result.groups, "trees");
    return summary;
}

void write_outputs(const std::filesystem::path& folder, const BoostingResult& result, const Json& summary) {
    write_outputs(folder, result, summary, "tree", result.weights);
}

}  // namespace clearway::training
