#pragma once

#include <cstdint>

#include "core/spellings.hpp"

namespace clearway::actuation {

/// Where the least yellow and red clearance of a transition come from.
enum class ClearanceRule : std::uint8_t {
    fixed,  ///< `yellow_s` and `all_red_s` of every link, whatever the program shows: the control of audits.
    ite,    ///< The program's own; where it shows none, by the formulas of the ITE.
    rilsa,  ///< The program's own; where it shows none, by the German RiLSA.
};

constexpr core::Spellings<ClearanceRule, 3> spellings(ClearanceRule) {
    return {{{ClearanceRule::fixed, "fixed"}, {ClearanceRule::ite, "ite"}, {ClearanceRule::rilsa, "rilsa"}}};
}

}  // namespace clearway::actuation
