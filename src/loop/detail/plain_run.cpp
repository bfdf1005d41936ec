#include "loop/detail/plain_run.hpp"

namespace clearway::loop::detail {

std::unique_ptr<sensing::SensorModel> sensor_of(const std::string& failure, failures::Exits exits,
                                                const core::KeyedRandom& random,
                                                const sensing::SensorContext& context) {
    failures::FailureConfig config = failures::failure_from(failure);
    config.exits = exits;
    return sensing::make_sensor(config, random, context);
}

}  // namespace clearway::loop::detail
