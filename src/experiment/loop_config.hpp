#pragma once

#include "core/fields.hpp"
#include "graph/proximity.hpp"

namespace clearway::experiment {

/// Which vehicles count as linked; members of whatever has link rules. Link rules beyond these are fixed.
struct LinkSettings {
    double link_radius_m = 50.0;
    int automated_links = 0;

    graph::LinkRules rules() const {
        using Pairs = graph::LinkRules::Pairs;
        return {.radius_m = link_radius_m,
                .automated_automated = automated_links != 0 ? Pairs::included : Pairs::excluded,
                .emergency_emergency = Pairs::excluded};
    }
    bool operator==(const LinkSettings&) const = default;

    static constexpr void fields(const auto& table) {
        table(core::Field{"link_radius_m", "m", &LinkSettings::link_radius_m, 1.0, 1000.0,
                          "Vehicles nearer than this are linked",
                          "assumed 50 m: the dissertation states no value"},
              core::Field{"automated_links", "1", &LinkSettings::automated_links, 0, 1,
                          "1: two automated vehicles may be linked, too",
                          "off: the dissertation links AV-HV, EV-HV and AV-EV"});
    }
};

/// Period of decisions and link rules in the closed loop. A condition may set the members by name.
struct LoopConfig : LinkSettings {
    double policy_period_s = 0.5;  ///< Time between two decisions of the policy.
    int ways_tried = 0;
    double ways_every_s = 120.0;
    int best_way_taken = 0;
    int holds_tried = 0;
    double holds_every_s = 0.0;
    int best_hold_taken = 0;
    double others_price = 0.0;
    int units_tried = 0;

    static constexpr void fields(const auto& table) {
        table(
            core::Field{"policy_period_s", "s", &LoopConfig::policy_period_s, 0.1, 10.0,
                        "Time between two decisions of the policy", "assumed: half a report interval"},
            core::Field{"ways_tried", "1", &LoopConfig::ways_tried, 0, 16,
                        "Ways of each EV that are driven to the end in copies of the run, "
                        "which gives the regret of the chosen one; 0: none",
                        "0: each costs the rest of a run"},
            core::Field{"ways_every_s", "s", &LoopConfig::ways_every_s, 1.0, 86400.0,
                        "Time between two such moments of an EV, from its departure on", "assumed"},
            core::Field{"best_way_taken", "1", &LoopConfig::best_way_taken, 0, 1,
                        "1: an EV takes the best of these ways where it beats its own, as one who knows the "
                        "future",
                        "0; 1 is the bound of every choice"},
            core::Field{"holds_tried", "1", &LoopConfig::holds_tried, 0, 16,
                        "Times of a hold, the last of them never, that are tried in copies of the run when "
                        "an EV comes near a signal, which gives the regret of the condition's rule; 0: none",
                        "0: each costs the rest of a run"},
            core::Field{"holds_every_s", "s", &LoopConfig::holds_every_s, 0.0, 86400.0,
                        "Least time between two such signals of an EV", "0: at every signal"},
            core::Field{"best_hold_taken", "1", &LoopConfig::best_hold_taken, 0, 1,
                        "1: the signal is held from the best of these times where that beats the rule, as "
                        "by one who knows the future",
                        "0; 1 shows what other times would gain at least"},
            core::Field{"others_price", "1", &LoopConfig::others_price, 0.0, 10.0,
                        "Then best means: EV seconds, plus this times those of the others in four minutes",
                        "0: the EV alone"},
            core::Field{"units_tried", "1", &LoopConfig::units_tried, 0, 16,
                        "Stations, the nearest first, whose unit is driven to each call in a copy of the "
                        "run, which gives the regret of the one that was sent; 0: none",
                        "0: each costs the rest of a run"});
        LinkSettings::fields(table);
    }
};

}  // namespace clearway::experiment
