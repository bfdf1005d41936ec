#include "loop/detail/plain_run.hpp"

namespace clearway::loop::detail {

std::unique_ptr<sensing::SensorModel> sensor_of(const std::string& failure, sensing::Exits exits,
                                                const core::KeyedRandom& random,
                                                const sensing::SensorContext& context) {
    sensing::FailureConfig config = sensing::failure_from(failure);
    config.exits = exits;
    return sensing::make_sensor(config, random, context);
}

}  // namespace clearway::loop::detail
