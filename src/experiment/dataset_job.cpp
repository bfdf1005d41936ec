#include "experiment/dataset_job.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "python/part_name.hpp"

namespace clearway::experiment {

std::string joined_policies(const DatasetJob& job) {
    return fmt::format("{}", fmt::join(job.policies, "+"));
}

std::string under_policies(const DatasetJob& job) {
    constexpr std::size_t digits = 8;
    std::string text;
    for (const std::string& policy : job.policies) {
        text += (text.empty() ? "-under-" : "+") + python::short_name(policy);
        if (const auto part = python::part_name_from(policy)) text += "-" + part->hash.substr(0, digits);
    }
    return text;
}

std::filesystem::path sample_file(const DatasetJob& job, const std::string& failure,
                                  std::string_view ending) {
    return job.output / fmt::format("{}-{}{}{}-{:04}{}", job.scenario, failure,
                                    job.exits == failures::Exits::unknown ? "-exits-unknown" : "",
                                    under_policies(job), job.replication, ending);
}

}  // namespace clearway::experiment
