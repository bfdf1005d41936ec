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

SeedRange read_range(core::StrictTable& seeds, const std::string& key, const std::string& file,
                     Problems& problems) {
    SeedRange range;
    const toml::table* const table = seeds.table(key);
    if (table == nullptr) return range;
    core::StrictTable reader(*table, "seeds." + key, file, problems);
    reader.integer<std::uint32_t>("first", 0, std::numeric_limits<std::int32_t>::max(), range.first);
    reader.integer<std::uint32_t>("count", 1, most_seeds, range.count);
    reader.finish();
    return range;
}

void read_scenario(const toml::table& table, const std::string& file, Problems& problems,
                   LinkBenchmark& benchmark) {
    core::StrictTable reader(table, "scenario", file, problems);
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
                           fmt::format("scenario {} is not the one the benchmark was frozen with: its "
                                       "configuration has the hash {}",
                                       name, hash),
                           configuration, "Take the scenario back, or give the benchmark a new name");
        }
        benchmark.scenarios.push_back(std::move(config));
    } catch (const core::InputError& error) {
        problems.insert(problems.end(), error.problems().begin(), error.problems().end());
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
                            "The threshold of F1 is chosen on them: give a number of validation seeds"});
    }
    const std::uint64_t test_end = std::uint64_t{test.first} + test.count;
    const std::uint64_t validation_end = std::uint64_t{validation.first} + validation.count;
    const bool apart = validation.first >= test_end || test.first >= validation_end;
    if (test.count > 0 && validation.count > 0 && !apart) {
        problems.push_back(
            {where,
             fmt::format("test seeds {} to {} and validation seeds {} to {} overlap", test.first,
                         test_end - 1, validation.first, validation_end - 1),
             "seeds of one kind each",
             fmt::format("Let validation begin at {} or above", std::max<std::uint64_t>(test_end, 100))});
    }
    return problems;
}

LinkBenchmark read_link_benchmark(const std::filesystem::path& file) {
    const std::string name = file.string();
    const toml::table table = core::parse_toml(core::read_file(file), name);
    Problems problems;
    core::StrictTable root(table, "", name, problems);
    LinkBenchmark benchmark;
    benchmark.name = file.stem().string();
    root.text("name", benchmark.name);
    root.texts("failures", benchmark.failures);
    root.words<Exits>("exits", benchmark.exits);
    if (const toml::table* const seeds = root.table("seeds")) {
        core::StrictTable reader(*seeds, "seeds", name, problems);
        reader.integer<std::uint64_t>("study_seed", 0, std::numeric_limits<std::int64_t>::max(),
                                      benchmark.study_seed);
        benchmark.test = read_range(reader, "test", name, problems);
        benchmark.validation = read_range(reader, "validation", name, problems);
        reader.finish();
    }
    const Problems of_seeds = problems_of(benchmark.test, benchmark.validation, root.where("seeds"));
    problems.insert(problems.end(), of_seeds.begin(), of_seeds.end());
    for (const toml::table* const one : root.tables("scenario"))
        read_scenario(*one, name, problems, benchmark);
    if (benchmark.scenarios.empty())
        root.problem("scenario", "the benchmark has no scenario", "[[scenario]]", "");
    if (benchmark.failures.empty())
        root.problem("failures", "the benchmark has no failure", "names of `clearway list`", "");
    if (benchmark.exits.empty()) root.problem("exits", "is missing", "known, unknown", "");
    root.finish();
    if (!problems.empty()) throw core::InputError(std::move(problems));
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
