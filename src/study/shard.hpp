#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "study/plan.hpp"

namespace clearway::study {

/// A part of a study's units: number `index` of `count`, from 1.
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

/// Which shard a run folder holds; the whole study where nothing else was said.
Shard shard_of(const std::filesystem::path& folder);
/// Makes `folder` that of a shard. Throws core::InputError when it holds another one, or the whole study.
void claim(const std::filesystem::path& folder, const Shard& shard);

/// Whether a shard has the unit of this number: of each `count` units in a row exactly one, at a place that
/// moves from row to row, so that engines and scenarios are spread over the shards. Every unit is in exactly
/// one shard, whatever the count.
bool has_unit(const Shard& shard, std::size_t unit);
/// Leaves in `plan` the units of a shard.
void keep_shard(Plan& plan, const Shard& shard);

}  // namespace clearway::study
