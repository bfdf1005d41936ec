#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "core/spellings.hpp"

namespace clearway::results {

/// What a planned comparison is to show.
enum class Claim : std::uint8_t {
    difference,   ///< The condition differs from the other.
    equivalence,  ///< The difference is smaller than the margin.
};
constexpr core::Spellings<Claim, 2> spellings(Claim) {
    return {{{Claim::difference, "difference"}, {Claim::equivalence, "equivalence"}}};
}
using core::name;

/// One comparison that a study names in advance: a condition minus another, paired by replication.
struct PlannedComparison {
    std::string name;
    std::string scenario;  ///< Empty: one comparison in every scenario.
    std::string condition;
    std::string against;
    Claim claim = Claim::difference;

    bool operator==(const PlannedComparison&) const = default;
};

/// What a study sets out to show, fixed before it runs. Everything else that it prints is exploratory.
struct AnalysisPlan {
    std::string metric = "emergency_restricted_travel_time_s";  ///< Of metrics::RunMetrics.
    double alpha = 0.05;
    double margin_s = 1.0;
    double margin_share = 0.05;
    std::vector<PlannedComparison> comparisons;

    bool operator==(const AnalysisPlan&) const = default;

    /// The members that are numbers.
    static constexpr void fields(const auto& table) {
        using P = AnalysisPlan;
        using core::Field;
        table(
            Field{"alpha", "1", &P::alpha, 0.0001, 0.2,
                  "Probability of a false claim among all comparisons of the plan (Holm)", "usual"},
            Field{
                "margin_s", "s", &P::margin_s, 0.0, 3600.0,
                "A difference below this counts as none, or below margin_share of the delay if that is more",
                "1 s: assumed the least that matters to an emergency vehicle"},
            Field{"margin_share", "1", &P::margin_share, 0.0, 1.0,
                  "The same as a share of the baseline's delay (travel time - solo)", "5 %, likewise"});
    }
};

}  // namespace clearway::results
