#pragma once

#include <memory>

#include "prediction/car_following_config.hpp"
#include "prediction/predictor.hpp"

namespace clearway::prediction {

/// Spread of a pair's link by the ages of both reports, m:
/// older_growth_m (age of the older / 1 s)^growth_power + younger_growth_m (of the younger)^growth_power.
float twin_spread_m(float one_age_s, float other_age_s, const CarFollowingConfig& config);
/// The power of an age that it contains, and the spread from two of these.
float twin_growth(float age_s, const CarFollowingConfig& config);
float twin_spread_of(float one_growth, float other_growth, const CarFollowingConfig& config);

/// Logit of the link of a pair whose distance is `room_m` below the radius:
/// tail_power asinh(room / spread); infinite without any spread. The tails are those of a power, because a
/// twin is mostly right to a metre and sometimes wrong by a whole queue; with room / spread itself, expected
/// calibration error was .067 (B10) and .087 (B20) instead of .007 and .010. Where sensors state errors
/// (`sensor_spread_m`, in spreads of the logistic distribution), 1 / logit^2 is the sum of both.
float twin_link_logit(float room_m, float sensor_spread_m, float twin_spread_m,
                      const CarFollowingConfig& config);

/// Standard deviation of the logistic distribution of spread 1: pi / sqrt(3).
inline constexpr float deviation_of_spread = 1.8138F;

/// The car-following twin: each vehicle that is not heard drives on by the Intelligent Driver Model along its
/// route (TwinTraffic); links by the distance of the places that come out. A vehicle whose route is not
/// known, or that reports from beside it, keeps its speed and heading. Where exits are not known, a twin at
/// the end of its route has left. Nothing is learned but the five numbers of twin_link_probability.
/// Neighbours that still detect a dark vehicle do not move its twin.
std::unique_ptr<Predictor> make_car_following(const PredictorContext& context,
                                              const CarFollowingConfig& config = {});

}  // namespace clearway::prediction
