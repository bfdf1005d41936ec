#include "training/output_folder.hpp"

#include <initializer_list>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "core/own_output.hpp"

namespace clearway::training {
namespace {

constexpr const char* cure = "Train into another folder (--out), or remove this one";

nlohmann::ordered_json read_json(const std::filesystem::path& file, const char* cure_damaged) {
    try {
        return nlohmann::ordered_json::parse(core::read_file(file));
    } catch (const nlohmann::json::exception& error) {
        throw core::InputError({file.string(), error.what(), "a file of clearway links train", cure_damaged});
    }
}

void add_differences(const nlohmann::ordered_json& found, const nlohmann::ordered_json& wanted,
                     const std::filesystem::path& file, std::vector<core::Problem>& problems) {
    for (const auto& [key, value] : wanted.items()) {
        const nlohmann::ordered_json other = found.is_object() ? found.value(key, Identity()) : Identity();
        if (value.is_object()) {
            add_differences(other, value, file, problems);
        } else if (other != value) {
            problems.push_back({file.string(), fmt::format("was made with {} = {}", key, other.dump()),
                                fmt::format("{} = {}, as this training has", key, value.dump()), cure});
        }
        // Another mode has another configuration altogether.
        if (key == "mode" && !problems.empty()) return;
    }
}

}  // namespace

void require_same_training(const nlohmann::ordered_json& found, const Identity& wanted,
                           const std::filesystem::path& file) {
    std::vector<core::Problem> problems;
    add_differences(found, wanted, file, problems);
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

OutputFolder::OutputFolder(std::filesystem::path folder, const Identity& identity)
    : folder_(std::move(folder)) {
    core::claim(folder_, {"clearway links train", {".clearway-training", "summary.json", checkpoint_file}});
    core::remove_abandoned_parts(folder_);
    const std::initializer_list<std::pair<const char*, const char*>> files = {{"summary.json", cure},
                                                                              {checkpoint_file, cure_anew}};
    for (const auto& [name, cure_damaged] : files) {
        const std::filesystem::path file = folder_ / name;
        if (!std::filesystem::exists(file)) continue;
        const nlohmann::ordered_json found = read_json(file, cure_damaged);
        require_same_training(found, identity, file);
        if (found.contains("outcome")) whole_ = found["outcome"] != training::name(Outcome::interrupted);
    }
}

bool OutputFolder::keeps_earlier(Outcome outcome, std::size_t epochs) const {
    return outcome == Outcome::interrupted && (whole_ || epochs == 0);
}

}  // namespace clearway::training
