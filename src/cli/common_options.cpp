#include "cli/common_options.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clearway::cli {

void add_json_option(CLI::App& app, Printing& printing, const std::string& what) {
    app.add_flag_callback(
        "--json", [&printing] { printing = Printing::json; },
        fmt::format("Print {} as JSON, units in the names of fields [text]", what));
}

void add_record_option(CLI::App& app, results::StepRecording& recording) {
    app.add_flag_callback(
        "--record", [&recording] { recording = results::StepRecording::on; },
        "Keep every step of every run below recordings/, for clearway replay. Changes no result; runs that "
        "are "
        "complete but not recorded are made again [off]");
}

void add_jobs_option(CLI::App& app, unsigned& jobs) {
    app.add_option("--jobs", jobs, "Worker processes at one time; 0: one per core. Changes no result")
        ->check(CLI::Range(0U, 4096U))
        ->option_text(fmt::format("N, 0 to 4096 [{}]", jobs));
}

void add_seed_option(CLI::App& app, std::uint64_t& seed) {
    app.add_option("--seed", seed, "Study seed: equal seeds, equal results")
        ->option_text(fmt::format("N, 0 to 2^64-1 [{}]", seed));
}

CLI::Option* add_seeds_option(CLI::App& app, std::uint32_t& seeds) {
    return app
        .add_option(
            "--seeds", seeds,
            "Replications of each condition; the conditions of one share demand, drivers and failures")
        ->check(CLI::Range(1U, most_replications))
        ->option_text(fmt::format("N, 1 to {} [{}]", most_replications, seeds));
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
    return fmt::format("{}", fmt::join(words, separator));
}

}  // namespace clearway::cli
