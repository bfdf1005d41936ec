#include "sensing/sensor.hpp"

#include "core/error.hpp"
#include "sensing/detail/perfect_sensor.hpp"
#include "sensing/detail/report_sensor.hpp"

namespace clearway::sensing {

std::unique_ptr<SensorModel> make_sensor(const failures::FailureConfig& config,
                                         const core::KeyedRandom& random, const SensorContext& context) {
    std::vector<core::Problem> problems = failures::problems_of(config, "failure");
    if (!problems.empty()) throw core::InputError(std::move(problems));
    if (config.report_interval_s == 0.0) return std::make_unique<detail::PerfectSensor>();
    return std::make_unique<detail::ReportSensor>(config, random, context);
}

}  // namespace clearway::sensing
