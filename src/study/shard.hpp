#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "study/plan.hpp"

namespace clearway::study {

/// Part `index` of `count` of a study's units, counted from 1.
struct Shard {
    std::uint32_t index = 1;
    std::uint32_t count = 1;

    bool whole() const { return count == 1; }
    bool operator==(const Shard&) const = default;
};

/// `3/8`.
std::string to_text(const Shard& shard);
/// Reads `3/8`. Throws core::InputError, saying `where`, unless 1 <= index <= count.
Shard shard_from(const std::string& text, const std::string& where);

/// Which shard a run folder holds; the whole study unless claimed for a shard.
Shard shard_of(const std::filesystem::path& folder);
/// Throws core::InputError when `folder` holds another shard or the whole study.
void require_own_shard(const std::filesystem::path& folder, const Shard& shard);
/// Marks `folder` as that of a shard. Throws likewise.
void claim(const std::filesystem::path& folder, const Shard& shard);

/// Whether a shard has the unit of this number. A shard has exactly one of every `count` consecutive units,
/// at a position that moves from group to group, so that traffic models and scenarios are spread over the
/// shards. Every unit is in exactly one shard.
bool has_unit(const Shard& shard, std::size_t unit);
/// Removes from `plan` the units of other shards.
void keep_shard(Plan& plan, const Shard& shard);

}  // namespace clearway::study
