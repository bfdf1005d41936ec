#include "training/outputs.hpp"

#include <initializer_list>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "prediction/state_dict.hpp"
#include "training/detail/figures.hpp"
#include "training/loss_curve.hpp"

namespace clearway::training {
namespace {

using detail::csv_value;
using detail::field_name;
using detail::Json;
using detail::json_from;

/// Which pairs a figure is about: their scenario or their failure, by name.
std::string group_name(const std::string& name) {
    return name.empty() ? "all" : name;
}

Json json_of(const SeedSplit& split) {
    Json json = Json::object();
    const std::initializer_list<std::pair<const char*, const std::vector<DataSeed>*>> parts = {
        {"train", &split.train}, {"validation", &split.validation}, {"test", &split.test}};
    for (const auto& [name, seeds] : parts) {
        Json& list = json[name] = Json::array();
        for (const DataSeed& seed : *seeds)
            list.push_back({{"study_seed", seed.study_seed}, {"replication", seed.replication}});
    }
    return json;
}

Json json_of(const std::vector<GroupQuality>& groups, const char* reference) {
    Json list = Json::array();
    for (const GroupQuality& group : groups) {
        list.push_back({{"scenario", group_name(group.scenario)},
                        {"failure", group_name(group.failure)},
                        {"model", json_from(group.model)}});
        if (group.reference) list.back()[reference] = json_from(*group.reference);
        if (!group.displacement_error_m) continue;
        list.back()["displacement_error_m"] = *group.displacement_error_m;
        list.back()[fmt::format("{}_displacement_error_m", reference)] =
            group.reference_displacement_error_m.value();
    }
    return list;
}

/// What a model says of its training.
std::vector<std::string> notes_of(const TrainingResult& result, const Json& summary) {
    std::vector<std::string> notes = {fmt::format(
        "trained by clearway links train {}, seed {}, data {}", summary["mode"].get<std::string>(),
        summary["configuration"]["seed"].get<std::uint64_t>(), summary["data_hash"].get<std::string>())};
    if (!result.groups.empty()) {
        notes.push_back(fmt::format("threshold of greatest F1 on validation seeds {:.4f}", result.threshold));
    } else if (result.outcome == Outcome::interrupted) {
        notes.push_back(
            fmt::format("interrupted after {} {}, not measured", result.round, result.losses.size()));
    }
    return notes;
}

}  // namespace

Json summary_of(const TrainingResult& result, const Identity& identity, const std::filesystem::path& data) {
    Json summary = {{"format", "clearway training summary 2"},
                    {"mode", identity.at("mode")},
                    {"outcome", name(result.outcome)},
                    {"data", data.string()}};
    summary.update(identity);
    if (!result.losses.empty()) {
        summary[fmt::format("{}s_run", result.round)] = result.losses.size();
        summary[fmt::format("best_{}", result.round)] =
            result.state.empty() ? Json(nullptr) : Json(result.best_round);
        // A loss that is not finite becomes null: JSON cannot write it.
        summary["final_train_loss_nat"] = result.losses.back().train;
        summary[fmt::format("final_{}_loss_nat", result.held_out)] = result.losses.back().held_out;
    }
    summary["train_pair_count"] = result.train_pairs;
    if (!result.seeds.train.empty()) summary["seeds"] = json_of(result.seeds);
    summary["test"] = json_of(result.groups, result.reference);
    summary.update(result.facts());
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

std::string metrics_csv(const std::vector<GroupQuality>& groups, const std::string& model,
                        const std::string& reference) {
    std::string text = "scenario,failure,predictor";
    core::for_each_field<metrics::LinkQuality>(
        [&](const auto& field) { text += "," + field_name(field.name, field.unit); });
    const bool moves = groups.front().displacement_error_m.has_value();
    text += moves ? ",displacement_error_m\n" : "\n";
    const auto row = [&](const GroupQuality& group, const std::string& predictor,
                         const metrics::LinkQuality& quality, const std::optional<double>& error_m) {
        text += fmt::format("{},{},{}", core::csv_text(group_name(group.scenario)),
                            core::csv_text(group_name(group.failure)), predictor);
        core::for_each_field<metrics::LinkQuality>(
            [&](const auto& field) { text += "," + csv_value(quality.*field.member); });
        text += moves ? "," + csv_value(error_m) + "\n" : "\n";
    };
    for (const GroupQuality& group : groups) {
        row(group, model, group.model, group.displacement_error_m);
        if (group.reference) row(group, reference, *group.reference, group.reference_displacement_error_m);
    }
    return text;
}

void write_outputs(const std::filesystem::path& folder, const TrainingResult& result, const Json& summary) {
    core::make_folder(folder);
    if (!result.losses.empty()) {
        const std::string label = result.held_out == std::string("test") ? "Test Loss" : "Validation Loss";
        core::write_atomically(folder / "losses.csv", losses_csv(result.losses, result.held_out));
        core::write_atomically(folder / "train_test_curve.svg", loss_curve_svg(result.losses, label));
    }
    core::write_atomically(folder / "summary.json",
                           summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    const auto model = summary["mode"].get<std::string>();
    if (!result.groups.empty())
        core::write_atomically(folder / "metrics.csv", metrics_csv(result.groups, model, result.reference));
    prediction::Weights weights = result.weights();
    if (weights.tensors.empty()) return;
    weights.link_radius = result.link_radius;
    weights.notes = notes_of(result, summary);
    prediction::write_weights(folder / (model + ".weights"), weights);
    if (!result.pth.empty()) prediction::write_pth(folder / (result.pth + ".pth"), weights.tensors);
    result.write_more(folder);
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
