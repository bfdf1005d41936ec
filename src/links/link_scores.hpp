#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/fields.hpp"
#include "links/link_histogram.hpp"

namespace clearway::links {

/// Which candidate pairs are scored.
enum class LinkSubset : std::uint8_t {
    all,     ///< Every candidate.
    hard,    ///< See `is_hard`.
    policy,  ///< See PairTraits::ahead_of_emergency.
};
inline constexpr std::array link_subsets = {LinkSubset::all, LinkSubset::hard, LinkSubset::policy};
std::string_view name(LinkSubset subset);

/// A pair is hard when simple kinematics does not decide it: dead reckoning puts it within half a link radius
/// of the radius (25 to 75 m for 50 m), or the last reports and dead reckoning disagree on whether it is
/// linked. Does not depend on the predictor.
bool is_hard(float last_seen_m, float dead_reckoned_m, float radius_m);

/// Upper bounds of the age classes, s, by the older of the two reports. The last class has no bound.
inline constexpr std::array age_ends_s = {1.0F, 2.0F, 5.0F, 10.0F, 20.0F, 40.0F};
inline constexpr std::size_t age_classes = age_ends_s.size() + 1;
/// A bound belongs to the class below it.
std::size_t age_class_of(float age_s);

/// Traits of a candidate pair, from the reports alone.
struct PairTraits {
    std::size_t age_class = 0;
    bool hard = false;
    /// One end is an emergency vehicle and the other is ahead on its route, within the policies' horizon, by
    /// its last seen or dead-reckoned position.
    bool ahead_of_emergency = false;
};

/// Summaries of one predictor's scores under one failure in one run.
struct LinkScoreSummary {
    std::array<LinkSummary, 2 * age_classes> cells;  ///< By age class, each easy first, then hard.
    LinkSummary policy;

    LinkSummary of(LinkSubset subset) const;
    /// All pairs of an age class.
    LinkSummary of_age(std::size_t age_class) const;
    void add(const LinkScoreSummary& other);
    bool operator==(const LinkScoreSummary&) const = default;
};

/// Counts pairs one by one into a LinkScoreSummary.
class LinkScores {
  public:
    void add(float probability, bool linked, const PairTraits& traits);
    LinkScoreSummary summary() const;

  private:
    std::array<LinkHistogram, 2 * age_classes> cells_;
    LinkHistogram policy_;
};

/// What there was to find under one failure in the scored reports of a run; the same for every predictor.
struct LinkTruth {
    std::uint64_t reports = 0;
    std::uint64_t vehicles = 0;
    std::uint64_t true_links = 0;
    std::uint64_t never_seen = 0;
    std::uint64_t outside = 0;
    std::uint64_t policy_links = 0;
    std::uint64_t dark_vehicles = 0;
    std::uint64_t unseen_vehicles = 0;

    bool operator==(const LinkTruth&) const = default;
    static constexpr void fields(const auto& table) {
        using T = LinkTruth;
        using core::Field;
        table(Field{"reports", "1", &T::reports, 0.0, 1e15, "Scored report rounds", ""},
              Field{"vehicles", "1", &T::vehicles, 0.0, 1e15, "Vehicles on the road, summed over rounds", ""},
              Field{"true_links", "1", &T::true_links, 0.0, 1e15, "True links, summed over rounds", ""},
              Field{"never_seen", "1", &T::never_seen, 0.0, 1e15,
                    "Of them: one end never reported or was forgotten", ""},
              Field{"outside", "1", &T::outside, 0.0, 1e15,
                    "Of them: both ends are known of, but the pair is neither known, nor detected, nor a "
                    "candidate",
                    ""},
              Field{"policy_links", "1", &T::policy_links, 0.0, 1e15,
                    "Of them: between an emergency vehicle and one ahead on its route", ""},
              Field{"dark_vehicles", "1", &T::dark_vehicles, 0.0, 1e15,
                    "Vehicles on the road that were not heard just now, summed over rounds", ""},
              Field{"unseen_vehicles", "1", &T::unseen_vehicles, 0.0, 1e15,
                    "Of them: never reported, or forgotten", ""});
    }
};

/// How the believed graph compares, at the predictor's own link threshold.
struct LinkBelief {
    std::uint64_t listed_true = 0;
    std::uint64_t listed_false = 0;
    std::uint64_t policy_found = 0;
    std::uint64_t believed_vehicles = 0;
    std::uint64_t ghosts = 0;
    std::uint64_t dark_believed = 0;
    std::uint64_t next_cases = 0;
    std::uint64_t next_right = 0;

    bool operator==(const LinkBelief&) const = default;
    static constexpr void fields(const auto& table) {
        using B = LinkBelief;
        using core::Field;
        table(Field{"listed_true", "1", &B::listed_true, 0.0, 1e15, "Believed links that are true", ""},
              Field{"listed_false", "1", &B::listed_false, 0.0, 1e15, "Believed links that are not", ""},
              Field{"policy_found", "1", &B::policy_found, 0.0, 1e15, "Policy links that are believed", ""},
              Field{"believed_vehicles", "1", &B::believed_vehicles, 0.0, 1e15, "Believed vehicles", ""},
              Field{"ghosts", "1", &B::ghosts, 0.0, 1e15, "Of them: no longer on the road", ""},
              Field{"dark_believed", "1", &B::dark_believed, 0.0, 1e15,
                    "Dark vehicles on the road that are believed, somewhere", ""},
              Field{"next_cases", "1", &B::next_cases, 0.0, 1e15,
                    "Emergency and automated vehicles whose true or believed next vehicle ahead is dark", ""},
              Field{"next_right", "1", &B::next_right, 0.0, 1e15,
                    "Of them: the believed one is the true one, or there is none in both", ""});
    }
};

/// Adds every count of a field table.
template <class Counts>
void add_counts(Counts& total, const Counts& other) {
    core::for_each_field<Counts>([&](const auto& field) { total.*field.member += other.*field.member; });
}

}  // namespace clearway::links
