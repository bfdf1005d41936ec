#include "links/link_benchmark.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/files.hpp"
#include "core/strict_table.hpp"
#include "policy/policy.hpp"
#include "prediction/predictor.hpp"
#include "python/part_name.hpp"
#include "scenario/overrides.hpp"

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

void check_name(core::StrictTable& reader, const std::string& key, const std::string& what,
                const std::string& name, const std::vector<std::string>& known) {
    if (core::contains(known, name)) return;
    reader.problem(key, fmt::format("`{}` is not a {}", name, what), core::listed(known),
                   core::did_you_mean(name, known));
}

/// The label names a folder, and tells the entry from all others.
void check_label(core::StrictTable& reader, const std::string& label, const LinkBenchmark& benchmark) {
    const char* const key = reader.has("label") ? "label" : "name";
    const bool plain =
        label.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
        std::string::npos;
    if (!plain && reader.has("label"))
        reader.problem(key, fmt::format("`{}` cannot name a folder", label), "letters, digits, _ and -", "");
    if (core::contains(benchmark.scenarios, label, &BenchmarkScenario::label))
        reader.problem(key, fmt::format("`{}` is used twice", label), "each once",
                       "Give the second one a `label` of its own");
}

void read_scenario(const toml::table& table, core::TomlReading& reading, LinkBenchmark& benchmark) {
    core::StrictTable reader(table, "scenario", reading);
    std::string name;
    std::string configuration;
    BenchmarkScenario entry;
    reader.text("name", name);
    reader.text("label", entry.label);
    reader.text_or_empty("policy", entry.policy);
    scenario::Options options;
    scenario::read_overrides(reader, options);
    reader.text_or_empty("configuration", configuration);
    reader.finish();
    if (!entry.policy.empty())
        check_name(reader, "policy", "policy", entry.policy, policy::policies().names());
    try {
        scenario::ScenarioConfig config = scenario::load(name, options);
        if (entry.label.empty()) entry.label = config.name;
        check_label(reader, entry.label, benchmark);
        const std::string hash = scenario::configuration_hash(config);
        if (configuration.empty()) {
            reader.problem("configuration", "is not given: it freezes the scenario",
                           fmt::format("the hash of its configuration as it is now, {}", hash),
                           fmt::format("Add configuration = \"{}\"", hash));
        } else if (hash != configuration) {
            reader.problem("configuration",
                           fmt::format("scenario {} has changed since the benchmark was frozen: its "
                                       "configuration has the hash {}",
                                       name, hash),
                           configuration, "Restore the scenario, or give the benchmark a new name");
        }
        entry.config = std::move(config);
        benchmark.scenarios.push_back(std::move(entry));
    } catch (const core::InputError& error) {
        reading.problems.insert(reading.problems.end(), error.problems().begin(), error.problems().end());
    }
}

void read_quick(core::StrictTable& root, QuickBenchmark& quick) {
    if (!root.has("quick")) return;
    auto reader = root.below("quick");
    if (!reader) return;
    reader->integer<std::uint32_t>("test", 1, most_seeds, quick.test);
    reader->integer<std::uint32_t>("validation", 1, most_seeds, quick.validation);
    reader->texts("failures", quick.failures);
    reader->words<Exits>("exits", quick.exits);
    reader->finish();
}

/// A predictor that a benchmark names: one of Clearway, or code of the user, whose file is below `folder` and
/// is made absolute.
void read_predictor(core::StrictTable& root, const std::string& key, const std::filesystem::path& folder,
                    std::string& name) {
    if (!python::part_name_from(name)) return check_name(root, key, "predictor", name, judged_predictors());
    try {
        name = python::resolved(name, folder, root.where(key));
    } catch (const core::InputError& error) {
        for (const core::Problem& problem : error.problems())
            root.problem(key, problem.what, problem.allowed, problem.cure);
    }
}

void read_comparisons(core::StrictTable& root, const std::filesystem::path& folder,
                      LinkBenchmark& benchmark) {
    const std::string key = "comparisons";
    std::vector<std::vector<std::string>> pairs;
    root.text_lists(key, pairs);
    for (std::vector<std::string>& pair : pairs) {
        if (pair.size() != 2) {
            root.problem(key, fmt::format("a comparison names {} predictors", pair.size()), "two", "");
            continue;
        }
        for (std::string& name : pair)
            read_predictor(root, key, folder, name);
        if (pair[0] == pair[1])
            root.problem(key, fmt::format("`{}` is compared with itself", pair[0]), "two predictors", "");
        const auto same = [&](const ComparedPair& other) {
            return (other.predictor == pair[0] && other.against == pair[1]) ||
                   (other.predictor == pair[1] && other.against == pair[0]);
        };
        if (std::ranges::any_of(benchmark.comparisons, same))
            root.problem(key, fmt::format("{} and {} are compared twice", pair[0], pair[1]), "each pair once",
                         "");
        benchmark.comparisons.push_back({pair[0], pair[1]});
    }
}

/// Each failure once, and those of `--quick` among them.
void check_failures(core::StrictTable& root, const LinkBenchmark& benchmark) {
    const std::vector<std::string>& all = benchmark.failures;
    for (auto failure = all.begin(); failure != all.end(); ++failure) {
        if (std::find(all.begin(), failure, *failure) != failure)
            root.problem("failures", fmt::format("`{}` is listed twice", *failure), "each failure once", "");
    }
    for (const std::string& failure : benchmark.quick.failures) {
        if (!all.empty() && !core::contains(all, failure))
            root.problem("quick", fmt::format("`{}` is not among the benchmark's failures", failure),
                         core::listed(all), "Name it in `failures`");
    }
}

void read_predictors(core::StrictTable& root, const std::filesystem::path& folder, LinkBenchmark& benchmark) {
    const std::string key = "predictors";
    root.texts(key, benchmark.predictors);
    if (root.has(key) && benchmark.predictors.empty())
        root.problem(key, "is empty", "one predictor or more", "Or leave `predictors` out");
    for (std::string& name : benchmark.predictors)
        read_predictor(root, key, folder, name);
}

/// Code of the user is judged only where `predictors` names it; comparisons know it by its class.
void check_compared(core::StrictTable& root, LinkBenchmark& benchmark) {
    for (ComparedPair& pair : benchmark.comparisons) {
        for (std::string* const name : {&pair.predictor, &pair.against}) {
            const bool is_own = python::part_name_from(*name).has_value();
            const std::string said = is_own ? python::short_name(*name) : *name;
            if ((is_own || !benchmark.predictors.empty()) && !core::contains(benchmark.predictors, *name))
                root.problem("comparisons", fmt::format("`{}` is not among the benchmark's predictors", said),
                             core::listed(benchmark.predictors), "Name it in `predictors`");
            *name = said;
        }
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
    read_quick(root, benchmark.quick);
    benchmark.candidates = prediction::CandidateReach::reported;
    root.word<prediction::CandidateReach>("candidates", benchmark.candidates);
    if (root.has("links")) {
        auto reader = root.below("links");
        if (reader) {
            reader->read(benchmark.links);
            reader->finish();
        }
    }
    check_failures(root, benchmark);
    const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
    read_comparisons(root, folder, benchmark);
    read_predictors(root, folder, benchmark);
    check_compared(root, benchmark);
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

std::vector<std::string> judged_predictors() {
    std::vector<std::string> names = prediction::predictors().names();
    std::erase_if(names, prediction::knows_truth);
    return names;
}

const std::vector<std::string>& benchmark_predictors() {
    static const std::vector<std::string> names = {
        "none",       "last_seen",         "dead_reckoning", "dead_reckoning_heading", "kalman",
        "route_rule", "common_neighbours", "logistic",       "graphsage_as_published", "graphsage_corrected",
        "graphsage"};
    return names;
}

}  // namespace clearway::links
