#pragma once

#include <string>

#include "results/store.hpp"

namespace clearway::results::detail {

/// Hash of everything in the runs of a folder that its tables hold: what each `run.json` says, which knows
/// the hash of its vehicles, and why other runs failed. It changes when a run is added, removed or made anew
/// with another result. Times of files would see a copied folder as another one. Reads every record: 0.03 ms
/// for one of 100 KB. Throws core::InputError for a damaged error.
std::string runs_hash(const Store& store);

}  // namespace clearway::results::detail
