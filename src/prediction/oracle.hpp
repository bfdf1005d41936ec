#pragma once

#include <memory>

#include "core/fields.hpp"
#include "prediction/predictor.hpp"

namespace clearway::prediction {

inline constexpr const char* oracle_name = "oracle";

/// How the truth is degraded.
struct OracleConfig {
    double links_kept = 1.0;
    double false_links = 0.0;
    double place_error_m = 0.0;
    double age_s = 0.0;

    static constexpr void fields(const auto& table) {
        using C = OracleConfig;
        using core::Field;
        table(Field{"links_kept", "1", &C::links_kept, 0.0, 1.0,
                    "Share of time that a true link is believed, drawn for each link, with gaps of 10 s",
                    "all of them"},
              Field{"false_links", "1", &C::false_links, 0.0, 0.9,
                    "Share of time that candidates too far apart for a link are believed to be linked, in "
                    "spells of 10 s",
                    "none"},
              Field{"place_error_m", "m", &C::place_error_m, 0.0, 100.0,
                    "Standard error of the places, along each axis, white at 10 Hz", "exact"},
              Field{"age_s", "s", &C::age_s, 0.0, 60.0, "Age of everything that it knows", "the present"});
    }
};

/// Not a repair: what a repair could be worth at most. Its observation must be that of sensors without
/// faults (pipeline::DecisionChain sees to it), with `place_error_m` and `age_s` as the position error and
/// the latency of their reports; the predictor itself degrades the links. Vehicles are believed where they
/// were reported. A link is believed with probability 1 or not at all.
std::unique_ptr<Predictor> make_oracle(const PredictorContext& context, const OracleConfig& config = {});

}  // namespace clearway::prediction
