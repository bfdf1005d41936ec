#include "training/repair_checkpoint.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/json.hpp"
#include "prediction/state_dict.hpp"
#include "training/output_folder.hpp"

namespace clearway::training {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format = "clearway training checkpoint 2";

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
std::filesystem::path head_of(const Checkpoint& checkpoint) {
    return checkpoint.folder / checkpoint_file;
}

Json head_from(const std::filesystem::path& file) {
    const std::string text = core::read_file(file);
    try {
        return core::parse_object(text, file.string());
    } catch (const core::InputError& error) {
        core::Problem problem = error.problems().front();
        problem.cure = cure_anew;
        throw core::InputError(std::move(problem));
    }
}

/// The hashes that the tensors may have: that of the newest checkpoint and, if any, of the one before.
std::vector<std::string> content_hashes(const Checkpoint& checkpoint, const RepairConfig& config) {
    const std::filesystem::path file = head_of(checkpoint);
    if (!std::filesystem::exists(file))
        throw core::InputError({file.string(), "is missing beside checkpoint.pth", "", cure_anew});
    const Json head = head_from(file);
    try {
        if (head.at("format") != format)
            throw core::InputError({file.string(), head["format"].dump(), format, cure_anew});
        require_same_training(head, identity_of(config, checkpoint.data_hash), file);
        return head.at("content_hashes").get<std::vector<std::string>>();
    } catch (const Json::exception& error) {
        throw core::InputError(
            {file.string(), error.what(), "a checkpoint of clearway links train", cure_anew});
    }
}

/// Whether there is a checkpoint, whole and of this training.
bool exists(const Checkpoint& checkpoint, const RepairConfig& config) {
    const std::filesystem::path file = tensors_of(checkpoint);
    const bool has_tensors = std::filesystem::exists(file);
    if (!has_tensors && !std::filesystem::exists(head_of(checkpoint))) return false;
    const std::vector<std::string> allowed = content_hashes(checkpoint, config);
    if (!has_tensors && allowed.size() == 1)
        return false;  // Killed between the two files of the first checkpoint.
    if (!has_tensors)
        throw core::InputError({file.string(), "is missing beside checkpoint.json", "", cure_anew});
    const std::string found = core::content_hash(core::read_file(file));
    if (core::contains(allowed, found)) return true;
    throw core::InputError({file.string(), fmt::format("its content hash is {}", found),
                            fmt::format("{}, as checkpoint.json says", fmt::join(allowed, " or ")),
                            "It was changed or damaged. " + std::string(cure_anew)});
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
    const std::string tensors = prediction::format_pth(all, tensors_of(checkpoint).stem().string());
    Json head = {{"format", format}, {"content_hashes", {core::content_hash(tensors)}}};
    // Two files cannot be replaced at once, so until the second is replaced, the first also lists the hash of
    // its previous content.
    if (std::filesystem::exists(tensors_of(checkpoint)))
        head["content_hashes"].push_back(core::content_hash(core::read_file(tensors_of(checkpoint))));
    head.update(identity_of(config, checkpoint.data_hash));
    core::write_atomically(head_of(checkpoint), head.dump(2) + "\n");
    core::write_atomically(tensors_of(checkpoint), tensors);
}

bool read_checkpoint(const Checkpoint& checkpoint, const RepairConfig& config, RepairProgress& progress) {
    if (checkpoint.folder.empty() || !exists(checkpoint, config)) return false;
    const std::string file = tensors_of(checkpoint).string();
    const StateDict all = prediction::parse_pth(core::read_file(file), file);
    progress.net = part_of(all, net_prefix);
    progress.best = part_of(all, best_prefix);
    progress.optimizer = part_of(all, adam_prefix);
    const StateDict losses = part_of(all, "losses");
    const StateDict best = part_of(all, "best_epoch");
    if (losses.size() != 1 || best.size() != 1 || best.front().values.size() != 2) {
        throw core::InputError({tensors_of(checkpoint).string(), "lacks its losses",
                                "a checkpoint of clearway links train", cure_anew});
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
