#pragma once

#include "core/error.hpp"
#include "report/facts.hpp"
#include "results/store.hpp"
#include "results/table_reader.hpp"

namespace clearway::campaign {

/// Tells on standard error why runs failed, equal failures of a condition once, with what to do.
void name_errors(const results::Store& store, const results::Results& results);

/// The last line, where a screen ends: how many runs failed, and of which conditions there is nothing.
void tell_failed(const results::Results& results, const report::StudyFacts& facts, core::ExitCode code);

}  // namespace clearway::campaign
