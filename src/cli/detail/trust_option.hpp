#pragma once

#include "campaign/stored_folder.hpp"
#include "cli/detail/app.hpp"

namespace clearway::cli {

/// Declares `--trust-code`: code in Python that a stored folder names may run.
void add_trust_option(App& app, campaign::CodeTrust& trust);

}  // namespace clearway::cli
