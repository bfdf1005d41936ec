#include "loop/detail/plain_run.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/spellings.hpp"
#include "sensing/failure_config.hpp"

namespace clearway::loop::detail {
namespace {

sensing::Exits exits_from(const std::string& word) {
    if (const auto exits = core::value_from<sensing::Exits>(word)) return *exits;
    throw core::InputError(
        {"exits", fmt::format("'{}' is not known", word), core::spelling_list<sensing::Exits>(), ""});
}

}  // namespace

std::unique_ptr<sensing::SensorModel> sensor_of(const std::string& failure, const std::string& exits,
                                                const core::KeyedRandom& random,
                                                const sensing::SensorContext& context) {
    sensing::FailureConfig config = sensing::failure_from(failure);
    config.exits = exits_from(exits);
    return sensing::make_sensor(config, random, context);
}

}  // namespace clearway::loop::detail
