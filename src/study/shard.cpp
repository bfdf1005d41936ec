#include "study/shard.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/number.hpp"

namespace clearway::study {
namespace {

constexpr const char* shard_file = ".shard";
constexpr const char* allowed = "I/N with 1 <= I <= N, for example 3/8";

}  // namespace

std::string to_text(const Shard& shard) {
    return fmt::format("{}/{}", shard.index, shard.count);
}

Shard shard_from(const std::string& text, const std::string& where) {
    const std::size_t slash = text.find('/');
    const auto index = core::number_from<std::uint32_t>(text.substr(0, slash));
    const auto count =
        core::number_from<std::uint32_t>(slash == std::string::npos ? "" : text.substr(slash + 1));
    if (!index || !count)
        throw core::InputError({where, fmt::format("\"{}\" is not a shard", text), allowed, ""});
    const Shard shard{*index, *count};
    if (shard.count == 0)
        throw core::InputError({where, text + " divides a study into 0 shards", allowed, ""});
    if (shard.index == 0 || shard.index > shard.count)
        throw core::InputError(
            {where, fmt::format("there is no shard {} of {}", shard.index, shard.count), allowed, ""});
    return shard;
}

Shard shard_of(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / shard_file;
    if (!std::filesystem::exists(file)) return {};
    const std::string text = core::read_file(file);
    return shard_from(text.substr(0, text.find('\n')), file.string());
}

void require_own_shard(const std::filesystem::path& folder, const Shard& shard) {
    if (!std::filesystem::exists(folder / "manifest.json")) return;
    const Shard held = shard_of(folder);
    if (held == shard) return;
    const auto describe = [](const Shard& each) {
        return each.whole() ? std::string("the whole study") : "shard " + to_text(each);
    };
    throw core::InputError({folder.string(), fmt::format("holds {}, not {}", describe(held), describe(shard)),
                            "one shard per folder", "Choose another folder with --out"});
}

void claim(const std::filesystem::path& folder, const Shard& shard) {
    require_own_shard(folder, shard);
    if (shard.whole() || std::filesystem::exists(folder / "manifest.json")) return;
    core::make_folder(folder);
    core::write_atomically(folder / shard_file, to_text(shard) + "\n");
}

bool has_unit(const Shard& shard, std::size_t unit) {
    const std::size_t row = unit / shard.count;
    return (unit + row) % shard.count == shard.index - 1;
}

void keep_shard(Plan& plan, const Shard& shard) {
    std::vector<PlannedUnit> kept;
    for (std::size_t unit = 0; unit < plan.units.size(); ++unit) {
        if (has_unit(shard, unit)) kept.push_back(std::move(plan.units[unit]));
    }
    plan.units = std::move(kept);
}

}  // namespace clearway::study
