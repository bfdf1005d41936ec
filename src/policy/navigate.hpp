#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "core/fields.hpp"
#include "core/spellings.hpp"
#include "policy/configured_policy.hpp"
#include "policy/detail/believed_ways.hpp"
#include "policy/detail/view.hpp"

namespace clearway::policy {

/// What is assumed of an edge before anything is seen there.
enum class Prior : std::uint8_t {
    free_flow,   ///< The limit, and the waits of the signals' programs.
    mean_times,  ///< The mean of other days (PolicyContext::mean_times_s); free_flow where none is known.
};
constexpr core::Spellings<Prior, 2> spellings(Prior) {
    return {{{Prior::free_flow, "free_flow"}, {Prior::mean_times, "mean_times"}}};
}

/// What is assumed of signals.
enum class Waits : std::uint8_t {
    program,    ///< Their programs run.
    requested,  ///< Another policy asks them for green.
};
constexpr core::Spellings<Waits, 2> spellings(Waits) {
    return {{{Waits::program, "program"}, {Waits::requested, "requested"}}};
}

/// Settings of Navigate.
struct NavigateConfig {
    double replan_s = 5.0;
    double gain_s = 10.0;
    double gain_share = 0.07;
    double fade_s = 120.0;
    double prior_s = 10.0;
    double signal_share = 1.0;
    Waits waits = Waits::program;
    int observes = 1;
    int heeds_incidents = 1;
    Prior prior = Prior::free_flow;

    static constexpr void fields(const auto& table) {
        using C = NavigateConfig;
        using core::Field;
        table(
            Field{
                "replan_s", "s", &C::replan_s, 0.1, 86400.0,
                "Time between two searches for an emergency vehicle; a new incident is looked at at once. A "
                "day: at departure alone",
                "assumed: a few hundred metres in between"},
            Field{"gain_s", "s", &C::gain_s, 0.0, 1e6,
                  "A way is changed only for a believed gain above this and above gain_share",
                  "assumed: below it, beliefs decide and not roads"},
            Field{"gain_share", "1", &C::gain_share, 0.0, 1.0, "Share of the rest of the present way",
                  "assumed, as gain_s"},
            Field{"fade_s", "s", &C::fade_s, 1.0, 86400.0,
                  "What was seen on an edge fades with this time constant, both since it was seen and until "
                  "the emergency vehicle would get there",
                  "assumed: one or two cycles of a signal"},
            Field{
                "prior_s", "s", &C::prior_s, 0.1, 1e5,
                "Weight of what is assumed of an edge before anything is seen there, as time of vehicles on "
                "it",
                "trials in a blocked city: of 10, 30 and 100 s the best for the emergency vehicle"},
            Field{"signal_share", "1", &C::signal_share, 0.0, 1.0,
                  "Share of the usual delay on an edge before a signal that the emergency vehicle has, too",
                  "1: no priority at signals"},
            Field{"waits", "", &C::waits, 0, 0,
                  "What is waited for at signals: program, as they run by themselves, or requested, where "
                  "another policy asks for green: until a signal asked now has changed (10 s) and the "
                  "vehicles before it have left (2 s each)",
                  "program: in trials beside corridor better in a grid, level in a city"},
            Field{"observes", "1", &C::observes, 0, 2,
                  "0: traffic is not looked at, ways follow free flow and the signals' programs; 2: what is "
                  "seen on a road is taken for another road's",
                  "1; 0 and 2 are controls"},
            Field{"heeds_incidents", "1", &C::heeds_incidents, 0, 1,
                  "0: what is known of incidents is not heard", "1; 0 is the control"},
            Field{"prior", "", &C::prior, 0, 0,
                  "What is assumed of an edge before anything is seen there: free_flow, with the signals' "
                  "programs, or mean_times, those of other days that the scenario names "
                  "(network.mean_times)",
                  "free_flow: needs no other days"});
    }
};

/// Chooses the emergency vehicle's way by the times that are believed now: of vehicles seen on the roads, of
/// signals by their programs, of incidents that are known. It changes the way where that pays, and asks for
/// the new one until the vehicle drives it. Of a way that pays too little it says so.
class Navigate : public ConfiguredPolicy<NavigateConfig> {
  public:
    explicit Navigate(const PolicyContext& context, const NavigateConfig& config = {});

    std::string_view name() const override { return "navigate"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    void plan(const detail::View& view, const traffic::BelievedVehicle& emergency,
              detail::LeaseWriter& write);

    detail::BelievedWays ways_;
    std::map<core::VehicleKey, double> planned_at_;  ///< s, by emergency vehicle.
    std::vector<core::EdgeIndex> way_;               ///< Reused.
};

}  // namespace clearway::policy
