#include "report/links.hpp"

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "campaign/names.hpp"
#include "campaign/programs.hpp"
#include "campaign/worker_jobs.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/detail/scenario_options.hpp"
#include "cli/verb.hpp"
#include "core/files.hpp"
#include "core/shipped_files.hpp"
#include "experiment/link_job.hpp"
#include "links/link_plan.hpp"
#include "prediction/predictor.hpp"
#include "prediction/python_predictor.hpp"
#include "python/part_process.hpp"

namespace clearway::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
    std::vector<std::string> scenarios;
    std::string benchmark;
    std::vector<std::string> failures;
    std::vector<std::string> predictors;
    std::vector<std::string> settings;  ///< `link_threshold=0.4`, `kalman.link_threshold=0.4`.
    std::vector<std::string> models;    ///< `graphsage=FILE`.
    std::string exits = "both";
    std::uint64_t study_seed = 1;
    links::SeedRange test{0, 10};
    links::SeedRange validation{1000, 5};
    bool quick = false;
    links::LinkSplit split = links::LinkSplit::test;
    std::string against;
    std::string folder;
    unsigned jobs = 0;
    Printing printing = Printing::text;
    experiment::LinkSettings links;
    scenario::Options options;
};

std::string number_text(const std::string& option, const std::string& text) {
    if (!core::number_from(text))
        throw core::InputError({option, fmt::format("`{}` is not a number", text), "NAME=NUMBER", ""});
    return core::setting_text(text);
}

bool is_predictor(const std::string& name) {
    const std::vector<std::string> names = links::judged_predictors();
    return std::ranges::find(names, name) != names.end();
}

links::LinkPredictor& predictor_named(const std::string& option, const std::string& name,
                                      std::vector<links::LinkPredictor>& predictors) {
    const auto found = std::ranges::find(predictors, name, &links::LinkPredictor::name);
    if (found != predictors.end()) return *found;
    std::vector<std::string> names;
    for (const links::LinkPredictor& predictor : predictors)
        names.push_back(predictor.name);
    if (is_predictor(name))
        throw core::InputError({option, fmt::format("`{}` is not among the predictors to be judged", name),
                                core::listed(names), "Name it after --predictor"});
    throw core::InputError(campaign::unknown_name(option, name, names));
}

/// All predictors but those whose models were trained for other links, which are named on standard error.
std::vector<std::string> predictors_for(double link_radius_m) {
    std::vector<std::string> names, left_out;
    for (const std::string& name : links::judged_predictors()) {
        std::vector<core::Problem> problems;
        prediction::check_link_radius(name, "", link_radius_m, "", problems);
        (problems.empty() ? names : left_out).push_back(name);
    }
    if (!left_out.empty())
        fmt::print(stderr, "clearway: left out, not trained for links below {} m: {}\n", link_radius_m,
                   fmt::join(left_out, ", "));
    return names;
}

/// Those that are judged where the user names none.
std::vector<std::string> usual_predictors(const Arguments& arguments, const links::LinkBenchmark& benchmark) {
    if (!arguments.predictors.empty()) return {};
    if (arguments.benchmark.empty()) return predictors_for(benchmark.links.link_radius_m);
    if (!benchmark.predictors.empty()) return benchmark.predictors;
    std::vector<std::string> names = links::benchmark_predictors();
    for (const links::ComparedPair& pair : benchmark.comparisons)
        names.insert(names.end(), {pair.predictor, pair.against});
    return names;
}

/// A predictor of Clearway, or one in Python, which tables know by its class.
links::LinkPredictor predictor_from(const std::string& word) {
    const std::string part = python::resolved(word, {}, "--predictor");
    if (!python::part_name_from(part)) return {.name = word, .model_file = {}, .settings = {}};
    return {.name = python::short_name(part), .model_file = {}, .settings = {}, .part = part};
}

void append(links::LinkPredictor predictor, std::vector<links::LinkPredictor>& predictors) {
    const auto same = std::ranges::find(predictors, predictor.name, &links::LinkPredictor::name);
    if (same != predictors.end() && same->part == predictor.part) return;
    if (same != predictors.end() || (!predictor.part.empty() && is_predictor(predictor.name)))
        throw core::InputError({"--predictor", fmt::format("two are called `{}`", predictor.name),
                                "a name of its own for each", "Rename the class"});
    predictors.push_back(std::move(predictor));
}

std::vector<links::LinkPredictor> predictors_of(const Arguments& arguments,
                                                const links::LinkBenchmark& benchmark) {
    std::vector<links::LinkPredictor> predictors;
    const std::vector<std::string> usual = usual_predictors(arguments, benchmark);
    const std::vector<std::string>& names = arguments.predictors.empty() ? usual : arguments.predictors;
    for (const std::string& name : names)
        append(predictor_from(name), predictors);
    for (const std::string& words : arguments.settings) {
        const auto [target, text] = assignment("--set", words);
        const std::string value = number_text("--set " + target, text);
        const std::size_t dot = target.find('.');
        if (dot == std::string::npos) {
            for (links::LinkPredictor& predictor : predictors)
                predictor.settings[target] = value;
        } else {
            predictor_named("--set", target.substr(0, dot), predictors).settings[target.substr(dot + 1)] =
                value;
        }
    }
    for (const std::string& words : arguments.models) {
        const auto [name, file] = assignment("--model", words, "PREDICTOR=FILE");
        std::string& model = predictor_named("--model", name, predictors).model_file;
        if (!model.empty())
            throw core::InputError(
                {"--model " + name, fmt::format("{} and {}", model, file), "one file", ""});
        model = file;
    }
    return predictors;
}

fs::path benchmark_file(const std::string& name) {
    if (fs::is_regular_file(name)) return name;
    const auto found = core::shipped(fs::path("studies") / "links" / (name + ".toml"));
    if (found) return *found;
    throw core::InputError({"--benchmark", fmt::format("`{}` is neither a benchmark nor a file", name),
                            "eval_v1, eval_v2, or a TOML file",
                            "docs/reference/link-prediction.md describes both"});
}

/// Keeps the benchmark's scenarios with these labels; all of them if `names` is empty.
void keep_scenarios(const std::vector<std::string>& names, links::LinkBenchmark& benchmark) {
    if (names.empty()) return;
    std::vector<std::string> known;
    for (const links::BenchmarkScenario& entry : benchmark.scenarios)
        known.push_back(entry.label);
    for (const std::string& name : names) {
        if (std::ranges::find(known, name) == known.end())
            throw core::InputError(campaign::unknown_name("scenario of " + benchmark.name, name, known));
    }
    std::erase_if(benchmark.scenarios, [&](const links::BenchmarkScenario& entry) {
        return std::ranges::find(names, entry.label) == names.end();
    });
}

links::LinkBenchmark named_benchmark(const Arguments& arguments) {
    links::LinkBenchmark benchmark = links::read_link_benchmark(benchmark_file(arguments.benchmark));
    const std::size_t all = benchmark.scenarios.size();
    keep_scenarios(arguments.scenarios, benchmark);
    const bool part = benchmark.scenarios.size() < all || arguments.quick || !arguments.failures.empty() ||
                      !arguments.predictors.empty() || arguments.exits != "both";
    if (part) benchmark.name += " (a part of it)";
    return benchmark;
}

links::LinkBenchmark own_benchmark(const Arguments& arguments) {
    links::LinkBenchmark benchmark;
    std::vector<core::Problem> problems =
        links::problems_of(arguments.test, arguments.validation, "--seeds, --validation-seeds");
    if (arguments.scenarios.empty())
        problems.push_back(
            {"SCENARIO", "is missing", "names, folders or files", "Or give --benchmark eval_v2"});
    for (const std::string& name : arguments.scenarios) {
        try {
            scenario::ScenarioConfig config = scenario::load(name, arguments.options);
            const std::string label = config.name;
            benchmark.scenarios.push_back({label, "", std::move(config)});
        } catch (const core::InputError& error) {
            problems.insert(problems.end(), error.problems().begin(), error.problems().end());
        }
    }
    std::vector<std::string> names;
    for (const links::BenchmarkScenario& entry : benchmark.scenarios) {
        if (std::ranges::find(names, entry.label) != names.end())
            problems.push_back(
                {"SCENARIO", fmt::format("`{}` is given twice", entry.label), "each once", ""});
        names.push_back(entry.label);
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    benchmark.name = core::listed(names);
    benchmark.study_seed = arguments.study_seed;
    benchmark.test = arguments.test;
    benchmark.validation = arguments.validation;
    benchmark.failures = campaign::failure_names();
    benchmark.exits = {links::Exits::known, links::Exits::unknown};
    benchmark.links = arguments.links;
    return benchmark;
}

/// Checks names and settings. Throws core::InputError with all problems.
void check(const links::LinkPlan& plan) {
    std::vector<core::Problem> problems;
    const auto check_name = [&](const std::string& where, const std::string& name,
                                const std::vector<std::string>& known) {
        if (std::ranges::find(known, name) == known.end())
            problems.push_back(campaign::unknown_name(where, name, known));
    };
    for (const std::string& failure : plan.benchmark.failures)
        campaign::check_failure("--failure", failure, problems);
    std::vector<std::string> present;
    for (const links::LinkPredictor& predictor : plan.predictors) {
        if (prediction::knows_truth(predictor.name))
            problems.push_back({"--predictor " + predictor.name,
                                "knows the truth: its links are as good as its settings say",
                                core::listed(links::judged_predictors()), "Judge a repair"});
        else if (predictor.part.empty())
            check_name("--predictor", predictor.name, links::judged_predictors());
        present.push_back(predictor.name);
        prediction::check_settings(predictor.part.empty() ? predictor.name : predictor.part,
                                   predictor.settings, "--set " + predictor.name, problems);
        if (!predictor.part.empty() && !predictor.model_file.empty()) {
            problems.push_back({"--model " + predictor.name, "is a predictor in Python, which takes none",
                                core::listed(prediction::predictors().names(traffic::Trait::learned)),
                                "Its class loads what it needs"});
        } else if (!predictor.model_file.empty() && !fs::is_regular_file(predictor.model_file)) {
            problems.push_back({"--model " + predictor.name,
                                fmt::format("{} is not a file", predictor.model_file),
                                "a .weights file of clearway train", ""});
        } else if (!predictor.model_file.empty()) {
            prediction::check_model(predictor.name, predictor.model_file);
        }
    }
    if (!plan.against.empty()) check_name("--against", plan.against, present);
    const bool can_be_read = problems.empty();
    for (const links::LinkPredictor& predictor : plan.predictors) {
        if (can_be_read)
            prediction::check_link_radius(predictor.name, predictor.model_file,
                                          plan.benchmark.links.link_radius_m, "--link-radius", problems);
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    for (const links::LinkPredictor& predictor : plan.predictors) {
        if (!predictor.part.empty())
            python::check_part(*python::part_name_from(predictor.part), python::PartKind::predictor,
                               prediction::parted_settings(predictor.settings).own, "--predictor");
    }
}

links::LinkPlan plan_of(const Arguments& arguments) {
    links::LinkPlan plan;
    plan.benchmark = arguments.benchmark.empty() ? own_benchmark(arguments) : named_benchmark(arguments);
    if (arguments.quick) {
        const links::QuickBenchmark quick = plan.benchmark.quick;
        plan.benchmark.test.count = std::min(plan.benchmark.test.count, quick.test);
        plan.benchmark.validation.count = std::min(plan.benchmark.validation.count, quick.validation);
        if (!quick.failures.empty()) plan.benchmark.failures = quick.failures;
        if (!quick.exits.empty()) plan.benchmark.exits = quick.exits;
    }
    if (!arguments.failures.empty()) plan.benchmark.failures = arguments.failures;
    if (const auto exits = core::value_from<links::Exits>(arguments.exits)) plan.benchmark.exits = {*exits};
    plan.predictors = predictors_of(arguments, plan.benchmark);
    plan.split = arguments.split;
    plan.against = arguments.against;
    const std::string name =
        arguments.benchmark.empty() ? "links" : fs::path(arguments.benchmark).stem().string();
    plan.folder = arguments.folder.empty() ? fs::path("runs") / name : fs::path(arguments.folder);
    check(plan);
    return plan;
}

std::string range_text(const links::SeedRange& range) {
    return fmt::format("{} to {}", range.first, range.first + range.count - 1);
}

/// Whether the comparisons that the benchmark names are made as it says: all of them, on all of it, with the
/// predictors as they are shipped. Further predictors do not matter.
bool are_confirmatory(const links::LinkPlan& plan, const Arguments& arguments) {
    return !plan.benchmark.comparisons.empty() && plan.comparisons() == plan.benchmark.comparisons &&
           arguments.scenarios.empty() && arguments.failures.empty() && arguments.exits == "both" &&
           !arguments.quick && arguments.settings.empty() && arguments.models.empty() &&
           plan.split == links::LinkSplit::test;
}

report::LinkFacts described(const links::LinkPlan& plan) {
    const links::LinkBenchmark& benchmark = plan.benchmark;
    report::LinkFacts facts;
    facts.title = benchmark.name;
    facts.split = plan.split == links::LinkSplit::test ? "test" : "validation";
    facts.study_seed = benchmark.study_seed;
    facts.seeds =
        fmt::format("study seed {}, replications {}; F1 thresholds chosen on {}", benchmark.study_seed,
                    range_text(plan.own_seeds()), range_text(benchmark.validation));
    facts.failures = benchmark.failures;
    facts.exits = benchmark.exits;
    facts.against = plan.opponent();
    for (const links::BenchmarkScenario& entry : benchmark.scenarios)
        facts.scenarios.push_back(entry.label);
    const study::Versions versions = campaign::installed_versions();
    facts.provenance = {{"Clearway", versions.clearway}, {"SUMO", versions.sumo}};
    for (const links::BenchmarkScenario& entry : benchmark.scenarios) {
        facts.provenance.emplace_back("Configuration of " + entry.label,
                                      scenario::configuration_hash(entry.config));
        if (!entry.policy.empty())
            facts.provenance.emplace_back("Policy in the traffic of " + entry.label, entry.policy);
    }
    for (const links::LinkPredictor& predictor : plan.predictors) {
        facts.predictors.push_back(predictor.name);
        if (!predictor.part.empty())
            facts.provenance.emplace_back("Predictor " + predictor.name, predictor.part);
        const std::string settings = links::settings_text(predictor);
        if (!settings.empty()) facts.provenance.emplace_back("Settings of " + predictor.name, settings);
        if (!predictor.model_file.empty())
            facts.provenance.emplace_back("Model of " + predictor.name, predictor.model_file);
    }
    return facts;
}

/// Hash of the worker program, which makes the runs.
std::string worker_hash() {
    const std::string program = campaign::sister_program("clearway-run");
    if (!fs::exists(program))
        throw core::EnvironmentError(
            fmt::format("{} is missing. `clearway doctor` shows what else is missing", program));
    return core::content_hash(core::read_file(program));
}

/// Makes the runs that are missing in the plan's folder.
core::ExitCode complete_runs(const links::LinkPlan& plan, const links::LinkRunFiles& files, unsigned jobs) {
    std::vector<campaign::WorkerJob> work;
    for (const experiment::LinkJob& job : links::missing_runs(plan, files)) {
        const fs::path file = plan.folder / "jobs" / job.work_folder.filename();
        work.push_back({.label = fmt::format("{} replication {}", job.scenario, job.replication),
                        .job = job,
                        .file = file.string() + ".json",
                        .log = file.string() + ".log",
                        .work = job.work_folder});
    }
    return work.empty() ? core::ExitCode::ok : campaign::work_on(work, jobs, "runs").exit_code;
}

core::ExitCode evaluate(const Arguments& arguments, const Invocation& invocation) {
    const links::LinkPlan plan = plan_of(arguments);
    core::make_folder(plan.folder);
    const links::LinkRunFiles files(plan, worker_hash());
    const core::ExitCode code = complete_runs(plan, files, arguments.jobs);
    if (code != core::ExitCode::ok) {
        fmt::print(stderr, "clearway: incomplete; complete runs are kept in {}. To continue:\n  {}\n",
                   plan.folder.string(), invocation.command);
        return code;
    }
    report::LinkFacts facts = described(plan);
    links::LinkVerdict verdict = links::judge(plan, files);
    facts.results = std::move(verdict.results);
    facts.gains = std::move(verdict.gains);
    facts.comparisons = std::move(verdict.comparisons);
    facts.confirmatory = are_confirmatory(plan, arguments);
    facts.exploratory_gains = !plan.benchmark.comparisons.empty();
    facts.command = invocation.command;
    const std::string json = report::links_json(facts);
    core::write_atomically(plan.folder / "evaluation.json", json);
    core::write_atomically(plan.folder / "evaluation.csv", report::links_csv(facts));
    std::ostringstream page;
    report::write_links_page(facts, page);
    core::write_atomically(plan.folder / "links.html", page.str());
    fmt::print(stderr, "{}\n", (plan.folder / "links.html").string());
    fmt::print("{}", arguments.printing == Printing::json ? json : report::links_console(facts));
    return core::ExitCode::ok;
}

void add_what(CLI::App& app, Arguments& arguments) {
    app.add_option("scenario", arguments.scenarios,
                   "Names (clearway list), folders or TOML files; with --benchmark, names of its scenarios")
        ->option_text("SCENARIO ... [those of the benchmark]");
    app.add_option("--benchmark", arguments.benchmark,
                   "Scenarios, seeds and failures of a benchmark: eval_v1, eval_v2 or a TOML file")
        ->option_text("NAME|FILE [none]");
    app.add_option("--failure", arguments.failures, "Sensor failures (clearway list)")
        ->option_text("NAME ... [all]");
    app.add_option("--exits", arguments.exits, "Whether it is known that a vehicle has left the network")
        ->check(CLI::IsMember({"known", "unknown", "both"}))
        ->option_text("known|unknown|both [both]");
    app.add_option("--predictor", arguments.predictors, "Predictors (clearway list, FILE.py:CLASS, FILE.pt)")
        ->option_text("NAME ... [all, or the benchmark's]");
    app.add_option("--model", arguments.models, "Model file of a learned predictor")
        ->option_text("PREDICTOR=FILE ... [as shipped]");
    app.add_option("--set", arguments.settings, "A setting of all predictors, or of one")
        ->option_text("[PREDICTOR.]NAME=NUMBER ... [defaults]");
    app.add_option("--against", arguments.against,
                   "Predictor to compare errors with; by default the best kinematic one present")
        ->option_text("PREDICTOR [route_rule, kalman, ...]");
}

void add_seeds(CLI::App& app, Arguments& arguments) {
    const char* const group = "Seeds (a benchmark has its own)";
    const auto declare = [&](const char* name, std::uint32_t& value, const char* doc, std::uint32_t least) {
        app.add_option(name, value, doc)
            ->check(CLI::Range(least, 4000000000U))
            ->option_text(fmt::format("N, from {} [{}]", least, value))
            ->excludes("--benchmark")
            ->group(group);
    };
    add_seed_option(app, arguments.study_seed)->excludes("--benchmark")->group(group);
    declare("--seeds", arguments.test.count, "Replications to test on", 0U);
    declare("--first-seed", arguments.test.first, "Number of the first of them", 0U);
    declare("--validation-seeds", arguments.validation.count,
            "Replications on which F1 thresholds are chosen", 0U);
    declare("--first-validation-seed", arguments.validation.first, "Number of the first of them", 0U);
    app.add_flag("--quick", arguments.quick,
                 fmt::format("At most {} test and {} validation seeds, or what the benchmark says [all]",
                             links::QuickBenchmark{}.test, links::QuickBenchmark{}.validation))
        ->group(group);
    app.add_option_function<std::string>(
           "--split",
           [&arguments](const std::string& name) {
               arguments.split = name == "test" ? links::LinkSplit::test : links::LinkSplit::validation;
           },
           "Seeds whose results are printed; tune settings only on `validation`")
        ->check(CLI::IsMember({"test", "validation"}))
        ->option_text("test|validation [test]")
        ->group(group);
}

Action configure_evaluate(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    add_what(app, *arguments);
    app.add_option("--out", arguments->folder,
                   "Folder of runs and results; runs that it already holds are not repeated")
        ->option_text("DIR [runs/BENCHMARK, or runs/links]");
    add_jobs_option(app, arguments->jobs);
    add_json_option(app, arguments->printing, "all figures");
    add_seeds(app, *arguments);
    const std::size_t own_options = app.get_options().size();
    add_link_options(app, arguments->links, "Links");
    add_scenario_options(app, arguments->options);
    const std::vector<CLI::Option*> options = app.get_options();
    for (std::size_t i = own_options; i < options.size(); ++i)
        options[i]->excludes("--benchmark");
    app.footer(
        "Examples:\n  clearway links evaluate --benchmark eval_v1\n"
        "  clearway links evaluate city --dense --failure B10 B20 --predictor dead_reckoning last_seen "
        "--json\n"
        "  clearway links evaluate --benchmark eval_v1 --split validation --failure B10 --set "
        "link_threshold=0.4");
    return [arguments](const Invocation& invocation) { return evaluate(*arguments, invocation); };
}

}  // namespace

Action configure_links(CLI::App& app) {
    app.require_subcommand(1);
    CLI::App* const command =
        app.add_subcommand("evaluate", "Evaluate predictors by their links, on seeds kept for this purpose");
    return configure_evaluate(*command);
}

}  // namespace clearway::cli
