#pragma once

#include <memory>

#include "core/fields.hpp"
#include "prediction/predictor.hpp"

namespace clearway::prediction {

struct CommonNeighboursConfig {
    double intercept = -1.7;
    double slope = 0.15;

    static constexpr void fields(const auto& table) {
        using C = CommonNeighboursConfig;
        table(core::Field{"intercept", "1", &C::intercept, -50.0, 50.0,
                          "Log odds of a link without a shared neighbour", "tuned on B10, dense"},
              core::Field{"slope", "1", &C::slope, 0.0, 50.0,
                          "Growth of the log odds with each shared neighbour", "tuned on B10, dense"});
    }
};

/// Common neighbours (Liben-Nowell and Kleinberg 2003, "The Link Prediction Problem for Social Networks"):
/// two vehicles are likely linked when many vehicles are near both. The graph: all pairs within the link
/// radius by last seen positions, of whatever class (links of the allowed classes alone hardly close a
/// triangle), and all detected pairs. P = 1 / (1 + exp(-(intercept + slope shared))). Vehicles stay
/// where they were last seen, as in `last_seen`.
std::unique_ptr<Predictor> make_common_neighbours(const PredictorContext& context,
                                                  const CommonNeighboursConfig& config = {});

}  // namespace clearway::prediction
