#pragma once

#include <cstdint>

#include "core/fields.hpp"
#include "core/spellings.hpp"
#include "policy/configured_policy.hpp"
#include "policy/detail/cooperation.hpp"

namespace clearway::policy {

/// The lane that a geocast clears.
enum class ClearedLane : std::uint8_t {
    left,   ///< The innermost that the emergency vehicle may use.
    right,  ///< The outermost that it may use.
    own,    ///< The one it is on.
};
constexpr core::Spellings<ClearedLane, 3> spellings(ClearedLane) {
    return {{{ClearedLane::left, "left"}, {ClearedLane::right, "right"}, {ClearedLane::own, "own"}}};
}

/// Settings of Geocast.
struct GeocastConfig {
    double reach_m = 300.0;
    ClearedLane lane = ClearedLane::left;
    double aside_m = 120.0;
    double slow_share = 0.6;
    double interval_s = 1.0;
    double lease_s = 10.0;
    int ask_humans = 0;

    static constexpr void fields(const auto& table) {
        using C = GeocastConfig;
        using core::Field;
        table(
            Field{"reach_m", "m", &C::reach_m, 10.0, 2000.0,
                  "The lane is cleared this far ahead on the emergency vehicle's route", "as vacate_lane"},
            Field{
                "lane", "", &C::lane, 0, 0,
                "Lane that is cleared: left and right are the innermost and the outermost that the emergency "
                "vehicle may use where it is",
                "left: the lane for overtaking"},
            Field{"aside_m", "m", &C::aside_m, 0.0, 2000.0,
                  "Slow vehicles on that lane pull aside this far ahead; 0: none", "as pull_aside"},
            Field{"slow_share", "1", &C::slow_share, 0.01, 2.0,
                  "Slow: below this share of the emergency vehicle's allowed speed",
                  "assumed: faster vehicles can change lanes"},
            Field{"interval_s", "s", &C::interval_s, 0.1, 60.0,
                  "Time between two messages, at least that between two decisions",
                  "assumed: 1 Hz, as reports"},
            Field{"lease_s", "s", &C::lease_s, 1.0, 60.0,
                  "A vehicle follows a message for this long; below interval_s, the lane is not cleared all "
                  "the time",
                  "trials on the arterial: the best of 2, 5, 10 and 20 s for the emergency vehicle"},
            Field{"ask_humans", "1", &C::ask_humans, 0, 1,
                  "1: human drivers are asked, too; those who comply (requests.compliance) do it",
                  "0: automated vehicles alone"});
    }
};

/// "Clear the left lane for 300 m": one message to whoever is on that stretch and hears it, by geocast. It
/// needs the emergency vehicle's own place and route, the map, and nothing of any other vehicle: no link, no
/// report, no repair. Vehicles on the lane leave it, or pull aside where they are slow; those on the lanes
/// beside it stay there. The emergency vehicle moves to the lane and otherwise chooses lanes itself.
class Geocast : public ConfiguredPolicy<GeocastConfig> {
  public:
    using ConfiguredPolicy::ConfiguredPolicy;

    std::string_view name() const override { return "geocast"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    /// Whether a message goes out at the decision of this time. A function of time alone, so that messages
    /// come at the same moments in every condition.
    bool is_due(core::Seconds now) const;
};

}  // namespace clearway::policy
