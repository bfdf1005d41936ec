#include "training/repair_checkpoint.hpp"

#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "training/state_dict.hpp"

namespace clearway::training {
namespace {

using Json = nlohmann::ordered_json;

/// What must be the same for a training to go on: all of the configuration, the number of epochs included,
/// because the learning rate's course depends on it.
Json identity_of(const Checkpoint& checkpoint, const RepairConfig& config) {
    Json json = {{"format", "clearway training checkpoint 1"}, {"data_hash", checkpoint.data_hash}};
    core::for_each_field<RepairConfig>([&](const auto& field) {
        const auto& value = config.*field.member;
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_enum_v<Value>) {
            json[field.name] = static_cast<int>(value);
        } else {
            json[field.name] = value;
        }
    });
    return json;
}

constexpr std::string_view net_prefix = "net.";
constexpr std::string_view best_prefix = "best.";
constexpr std::string_view adam_prefix = "adam.";

void append(StateDict& all, const StateDict& part, std::string_view prefix) {
    for (prediction::Tensor tensor : part) {
        tensor.name = std::string(prefix) + tensor.name;
        all.push_back(std::move(tensor));
    }
}

StateDict part_of(const StateDict& all, std::string_view prefix) {
    StateDict part;
    for (const prediction::Tensor& tensor : all) {
        if (!tensor.name.starts_with(prefix)) continue;
        part.push_back(tensor);
        part.back().name = tensor.name.substr(prefix.size());
    }
    return part;
}

std::filesystem::path tensors_of(const Checkpoint& checkpoint) {
    return checkpoint.folder / "checkpoint.pth";
}
std::filesystem::path identity_file_of(const Checkpoint& checkpoint) {
    return checkpoint.folder / "checkpoint.json";
}

void require_same(const Json& found, const Json& wanted, const std::filesystem::path& file) {
    std::vector<core::Problem> problems;
    for (const auto& [key, value] : wanted.items()) {
        const Json other = found.contains(key) ? found[key] : Json(nullptr);
        if (other == value) continue;
        problems.push_back({file.string(), fmt::format("was made with {} = {}", key, other.dump()),
                            fmt::format("{} = {}, as this training has", key, value.dump()),
                            "Train into another folder, or remove the checkpoint"});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

}  // namespace

void write_checkpoint(const Checkpoint& checkpoint, const RepairConfig& config,
                      const RepairProgress& progress) {
    if (checkpoint.folder.empty()) return;
    StateDict all;
    append(all, progress.net, net_prefix);
    append(all, progress.best, best_prefix);
    append(all, progress.optimizer, adam_prefix);
    prediction::Tensor losses{"losses", {static_cast<std::uint32_t>(progress.losses.size()), 2}, {}};
    for (const EpochLoss& loss : progress.losses) {
        losses.values.push_back(static_cast<float>(loss.train));
        losses.values.push_back(static_cast<float>(loss.held_out));
    }
    all.push_back(std::move(losses));
    all.push_back(
        {"best_epoch", {2}, {static_cast<float>(progress.best_epoch), progress.stopped_early ? 1.0F : 0.0F}});
    core::make_folder(checkpoint.folder);
    core::write_atomically(identity_file_of(checkpoint), identity_of(checkpoint, config).dump(2) + "\n");
    write_pth(tensors_of(checkpoint), all);
}

bool read_checkpoint(const Checkpoint& checkpoint, const RepairConfig& config, RepairProgress& progress) {
    if (checkpoint.folder.empty() || !std::filesystem::exists(tensors_of(checkpoint))) return false;
    const std::filesystem::path file = identity_file_of(checkpoint);
    Json found;
    try {
        found = Json::parse(core::read_file(file));
    } catch (const Json::exception& error) {
        throw core::InputError({file.string(), error.what(), "a checkpoint of clearway train",
                                "Remove checkpoint.json and checkpoint.pth to start anew"});
    }
    require_same(found, identity_of(checkpoint, config), file);
    const StateDict all = read_pth(tensors_of(checkpoint).string());
    progress.net = part_of(all, net_prefix);
    progress.best = part_of(all, best_prefix);
    progress.optimizer = part_of(all, adam_prefix);
    const StateDict losses = part_of(all, "losses");
    const StateDict best = part_of(all, "best_epoch");
    if (losses.size() != 1 || best.size() != 1 || best.front().values.size() != 2) {
        throw core::InputError({tensors_of(checkpoint).string(), "lacks its losses",
                                "a checkpoint of clearway train",
                                "Remove checkpoint.json and checkpoint.pth to start anew"});
    }
    progress.losses.clear();
    for (std::size_t at = 0; at + 1 < losses.front().values.size(); at += 2) {
        progress.losses.push_back({losses.front().values[at], losses.front().values[at + 1]});
    }
    progress.best_epoch = static_cast<std::uint32_t>(best.front().values[0]);
    progress.stopped_early = best.front().values[1] > 0.5F;
    return true;
}

}  // namespace clearway::training
