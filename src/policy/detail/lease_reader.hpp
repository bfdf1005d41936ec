#pragma once

#include <string>
#include <vector>

#include "core/units.hpp"
#include "traffic/lease.hpp"

namespace clearway::policy::detail {

/// A copy of the text that lives as long as the program, one for each text: what leases point to.
const std::string& kept_text(const std::string& text);

/// Appends the leases of an answer in JSON (python/clearway/parts.py writes it), issued at `now` by `policy`.
/// Returns for each the line of user code that made it, `my_policy.py, line 9`; empty where it is not said.
/// Throws python::PartError, without the part's name, for an answer of another form, which the package does
/// not write: user code can reach behind it.
std::vector<std::string> read_leases(const std::string& answer, const std::string& policy, core::Seconds now,
                                     std::vector<traffic::Lease>& leases);

}  // namespace clearway::policy::detail
