#include "links/link_benchmark.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/files.hpp"
#include "core/strict_table.hpp"

namespace clearway::links {
namespace {

using Problems = std::vector<core::Problem>;

constexpr std::uint32_t most_seeds = 100000;

SeedRange read_range(core::StrictTable& seeds, const std::string& key) {
    SeedRange range;
    auto reader = seeds.below(key);
    if (!reader) return range;
    reader->integer<std::uint32_t>("first", 0, std::numeric_limits<std::int32_t>::max(), range.first);
    reader->integer<std::uint32_t>("count", 1, most_seeds, range.count);
    reader->finish();
    return range;
}

void read_scenario(const toml::table& table, core::TomlReading& reading, LinkBenchmark& benchmark) {
    core::StrictTable reader(table, "scenario", reading);
    std::string name;
    std::string configuration;
    scenario::Options options;
    reader.text("name", name);
    reader.word<scenario::Variant>("variant", options.variant);
    reader.text("configuration", configuration);
    reader.finish();
    try {
        scenario::ScenarioConfig config = scenario::load(name, options);
        const std::string hash = scenario::configuration_hash(config);
        if (hash != configuration) {
            reader.problem("configuration",
                           fmt::format("scenario {} has changed since the benchmark was frozen: its "
                                       "configuration has the hash {}",
                                       name, hash),
                           configuration, "Restore the scenario, or give the benchmark a new name");
        }
        benchmark.scenarios.push_back(std::move(config));
    } catch (const core::InputError& error) {
        reading.problems.insert(reading.problems.end(), error.problems().begin(), error.problems().end());
    }
}

}  // namespace

std::vector<core::Problem> problems_of(const SeedRange& test, const SeedRange& validation,
                                       const std::string& where) {
    Problems problems;
    if (test.count == 0)
        problems.push_back({where, "no seeds to test on", "at least one", "Give a number of test seeds"});
    if (validation.count == 0) {
        problems.push_back({where, "no seeds to validate on", "at least one",
                            "Give a number of validation seeds: the F1 threshold is chosen on them"});
    }
    const std::uint64_t test_end = std::uint64_t{test.first} + test.count;
    const std::uint64_t validation_end = std::uint64_t{validation.first} + validation.count;
    const bool apart = validation.first >= test_end || test.first >= validation_end;
    if (test.count > 0 && validation.count > 0 && !apart) {
        problems.push_back(
            {where,
             fmt::format("test seeds {} to {} and validation seeds {} to {} overlap", test.first,
                         test_end - 1, validation.first, validation_end - 1),
             "disjoint seeds",
             fmt::format("Start validation at {} or above", std::max<std::uint64_t>(test_end, 100))});
    }
    return problems;
}

LinkBenchmark read_link_benchmark(const std::filesystem::path& file) {
    core::TomlReading reading{file.string(), {}, {}};
    const toml::table table = core::parse_toml(core::read_file(file), reading.file);
    core::StrictTable root(table, "", reading);
    LinkBenchmark benchmark;
    benchmark.name = file.stem().string();
    root.text("name", benchmark.name);
    root.texts("failures", benchmark.failures);
    root.words<Exits>("exits", benchmark.exits);
    if (auto reader = root.below("seeds")) {
        reader->integer<std::uint64_t>("study_seed", 0, std::numeric_limits<std::int64_t>::max(),
                                       benchmark.study_seed);
        benchmark.test = read_range(*reader, "test");
        benchmark.validation = read_range(*reader, "validation");
        reader->finish();
    }
    const Problems of_seeds = problems_of(benchmark.test, benchmark.validation, root.where("seeds"));
    reading.problems.insert(reading.problems.end(), of_seeds.begin(), of_seeds.end());
    for (const toml::table* const one : root.tables("scenario"))
        read_scenario(*one, reading, benchmark);
    if (benchmark.scenarios.empty())
        root.problem("scenario", "the benchmark has no scenario", "[[scenario]]", "");
    if (benchmark.failures.empty())
        root.problem("failures", "the benchmark has no failure", "names of `clearway list`", "");
    if (benchmark.exits.empty()) root.problem("exits", "is missing", "known, unknown", "");
    root.finish();
    if (!reading.problems.empty()) throw core::InputError(std::move(reading.problems));
    return benchmark;
}

const std::vector<std::string>& benchmark_predictors() {
    static const std::vector<std::string> names = {
        "none",       "last_seen",         "dead_reckoning", "dead_reckoning_heading", "kalman",
        "route_rule", "common_neighbours", "logistic",       "graphsage_as_published", "graphsage_corrected",
        "graphsage"};
    return names;
}

}  // namespace clearway::links
