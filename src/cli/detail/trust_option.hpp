#pragma once

#include <CLI/App.hpp>

#include "campaign/stored_folder.hpp"

namespace clearway::cli {

/// Declares `--trust-code`: code in Python that a stored folder names may run.
void add_trust_option(CLI::App& app, campaign::CodeTrust& trust);

}  // namespace clearway::cli
