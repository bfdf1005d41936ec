#include "campaign/link_evaluation.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "campaign/names.hpp"
#include "campaign/programs.hpp"
#include "campaign/worker_jobs.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "core/own_output.hpp"
#include "core/shipped_files.hpp"
#include "experiment/link_job.hpp"
#include "prediction/predictor.hpp"
#include "prediction/python_predictor.hpp"
#include "python/part_process.hpp"
#include "report/links.hpp"
#include "study/plan.hpp"

namespace clearway::campaign {
namespace {

namespace fs = std::filesystem;

std::string number_text(const std::string& option, const std::string& text) {
    if (!core::number_from(text))
        throw core::InputError({option, fmt::format("`{}` is not a number", text), "NAME=NUMBER", ""});
    return core::setting_text(text);
}

bool is_predictor(const std::string& name) {
    const std::vector<std::string> names = links::judged_predictors();
    return core::contains(names, name);
}

links::LinkPredictor& predictor_named(const std::string& option, const std::string& name,
                                      std::vector<links::LinkPredictor>& predictors) {
    const auto found = std::ranges::find(predictors, name, &links::LinkPredictor::name);
    if (found != predictors.end()) return *found;
    const std::vector<std::string> names = core::texts_of(predictors, &links::LinkPredictor::name);
    if (is_predictor(name))
        throw core::InputError({option, fmt::format("`{}` is not among the predictors to evaluate", name),
                                core::listed(names), "Name it after --predictor"});
    throw core::InputError(unknown_name(option, name, names));
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
std::vector<std::string> usual_predictors(const LinkRequest& request, const links::LinkBenchmark& benchmark) {
    if (!request.predictors.empty()) return {};
    if (request.benchmark.empty()) return predictors_for(benchmark.links.link_radius_m);
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

std::vector<links::LinkPredictor> predictors_of(const LinkRequest& request,
                                                const links::LinkBenchmark& benchmark) {
    std::vector<links::LinkPredictor> predictors;
    const std::vector<std::string> usual = usual_predictors(request, benchmark);
    const std::vector<std::string>& names = request.predictors.empty() ? usual : request.predictors;
    for (const std::string& name : names)
        append(predictor_from(name), predictors);
    for (const auto& [target, text] : request.settings) {
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
    for (const auto& [name, file] : request.models) {
        std::string& model = predictor_named("--model", name, predictors).model_file;
        if (!model.empty())
            throw core::InputError(
                {"--model " + name, fmt::format("{} and {}", model, file), "one file", ""});
        model = file;
    }
    return predictors;
}

/// The file of a benchmark that comes with Clearway.
std::optional<fs::path> shipped_benchmark(const std::string& name) {
    return core::shipped(fs::path("studies") / "links" / (name + ".toml"));
}

fs::path benchmark_file(const std::string& name) {
    if (fs::is_regular_file(name)) return name;
    const auto found = shipped_benchmark(name);
    if (found) return *found;
    throw core::InputError({"--benchmark", fmt::format("`{}` is neither a benchmark nor a file", name),
                            "eval_v1, eval_v2, or a TOML file",
                            "docs/reference/link-prediction.md describes both"});
}

/// Keeps the benchmark's scenarios with these labels; all of them if `names` is empty.
void keep_scenarios(const std::vector<std::string>& names, links::LinkBenchmark& benchmark) {
    if (names.empty()) return;
    const std::vector<std::string> known =
        core::texts_of(benchmark.scenarios, &links::BenchmarkScenario::label);
    for (const std::string& name : names) {
        if (!core::contains(known, name))
            throw core::InputError(unknown_name("scenario of " + benchmark.name, name, known));
    }
    std::erase_if(benchmark.scenarios,
                  [&](const links::BenchmarkScenario& entry) { return !core::contains(names, entry.label); });
}

links::LinkBenchmark named_benchmark(const LinkRequest& request) {
    links::LinkBenchmark benchmark = links::read_link_benchmark(benchmark_file(request.benchmark));
    const std::size_t all = benchmark.scenarios.size();
    keep_scenarios(request.scenarios, benchmark);
    const bool part = benchmark.scenarios.size() < all || request.quick || !request.failures.empty() ||
                      !request.predictors.empty() || request.exits != "both";
    if (part) benchmark.name += " (a part of it)";
    return benchmark;
}

links::LinkBenchmark own_benchmark(const LinkRequest& request) {
    links::LinkBenchmark benchmark;
    std::vector<core::Problem> problems =
        links::problems_of(request.test, request.validation, "--seeds, --validation-seeds");
    if (request.scenarios.empty())
        problems.push_back(
            {"SCENARIO", "is missing", "names, folders or files", "Or give --benchmark eval_v2"});
    for (const std::string& name : request.scenarios) {
        if (shipped_benchmark(name)) {
            problems.push_back({name, "is a benchmark and not a scenario",
                                "names, folders or files of scenarios",
                                fmt::format("Say --benchmark {}", name)});
            continue;
        }
        try {
            scenario::ScenarioConfig config = scenario::load(name, request.options);
            const std::string label = config.name;
            benchmark.scenarios.push_back({label, "", std::move(config)});
        } catch (const core::InputError& error) {
            problems.insert(problems.end(), error.problems().begin(), error.problems().end());
        }
    }
    std::vector<std::string> names;
    for (const links::BenchmarkScenario& entry : benchmark.scenarios) {
        if (core::contains(names, entry.label))
            problems.push_back(
                {"SCENARIO", fmt::format("`{}` is given twice", entry.label), "each once", ""});
        names.push_back(entry.label);
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    benchmark.name = core::listed(names);
    benchmark.study_seed = request.study_seed;
    benchmark.test = request.test;
    benchmark.validation = request.validation;
    benchmark.failures = failure_names();
    benchmark.exits = {links::Exits::known, links::Exits::unknown};
    benchmark.links = request.links;
    return benchmark;
}

/// Checks names and settings. Throws core::InputError with all problems.
void check(const links::LinkPlan& plan) {
    std::vector<core::Problem> problems;
    const auto check_name = [&](const std::string& where, const std::string& name,
                                const std::vector<std::string>& known) {
        if (!core::contains(known, name)) problems.push_back(unknown_name(where, name, known));
    };
    for (const std::string& failure : plan.benchmark.failures)
        check_failure("--failure", failure, problems);
    std::vector<std::string> present;
    for (const links::LinkPredictor& predictor : plan.predictors) {
        if (prediction::knows_truth(predictor.name))
            problems.push_back({"--predictor " + predictor.name,
                                "knows the truth: its links are as good as its settings say",
                                core::listed(links::judged_predictors()), "Evaluate another predictor"});
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
                                "a .weights file of clearway links train", ""});
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

links::LinkPlan plan_of(const LinkRequest& request) {
    links::LinkPlan plan;
    plan.benchmark = request.benchmark.empty() ? own_benchmark(request) : named_benchmark(request);
    if (request.quick) {
        const links::QuickBenchmark quick = plan.benchmark.quick;
        plan.benchmark.test.count = std::min(plan.benchmark.test.count, quick.test);
        plan.benchmark.validation.count = std::min(plan.benchmark.validation.count, quick.validation);
        if (!quick.failures.empty()) plan.benchmark.failures = quick.failures;
        if (!quick.exits.empty()) plan.benchmark.exits = quick.exits;
    }
    if (!request.failures.empty()) plan.benchmark.failures = request.failures;
    if (const auto exits = core::value_from<links::Exits>(request.exits)) plan.benchmark.exits = {*exits};
    plan.predictors = predictors_of(request, plan.benchmark);
    plan.split = request.split;
    plan.against = request.against;
    const std::string name =
        request.benchmark.empty() ? "links" : fs::path(request.benchmark).stem().string();
    plan.folder = request.folder.empty() ? fs::path("runs") / name : fs::path(request.folder);
    check(plan);
    return plan;
}

std::string range_text(const links::SeedRange& range) {
    return fmt::format("{} to {}", range.first, range.first + range.count - 1);
}

/// Whether the comparisons that the benchmark names are made as it says: all of them, on all of it, with the
/// predictors as they are shipped. Further predictors do not matter.
bool are_confirmatory(const links::LinkPlan& plan, const LinkRequest& request) {
    return !plan.benchmark.comparisons.empty() && plan.comparisons() == plan.benchmark.comparisons &&
           request.scenarios.empty() && request.failures.empty() && request.exits == "both" &&
           !request.quick && request.settings.empty() && request.models.empty() &&
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
    facts.runs = facts.scenarios.size() * plan.own_seeds().count;
    const study::Versions versions = installed_versions();
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
    const std::string program = sister_program("clearway-run");
    if (!fs::exists(program))
        throw core::EnvironmentError(
            fmt::format("{} is missing. `clearway doctor` shows what else is missing", program));
    return core::content_hash(core::read_file(program));
}

/// Makes the runs that are missing in the plan's folder.
core::ExitCode complete_runs(const links::LinkPlan& plan, const links::LinkRunFiles& files, unsigned jobs) {
    core::remove_abandoned_parts(plan.folder / "work");
    std::vector<WorkerJob> work;
    for (const experiment::LinkJob& job : links::missing_runs(plan, files)) {
        const fs::path file =
            plan.folder / "jobs" / fmt::format("{}-{}-{}", job.scenario, job.replication, ::getpid());
        work.push_back({.label = fmt::format("{} replication {}", job.scenario, job.replication),
                        .job = job,
                        .file = file.string() + ".json",
                        .log = file.string() + ".log",
                        .work = {job.work_folder}});
    }
    return work.empty() ? core::ExitCode::ok : work_on(work, jobs, "runs").exit_code;
}

}  // namespace

core::ExitCode evaluate_links(const LinkRequest& request) {
    const links::LinkPlan plan = plan_of(request);
    core::claim(plan.folder, {"clearway links evaluate", {".clearway-links"}});
    const links::LinkRunFiles files(plan, worker_hash());
    const core::ExitCode code = complete_runs(plan, files, request.workers);
    if (code != core::ExitCode::ok) {
        fmt::print(stderr, "clearway: incomplete; complete runs are kept in {}. To continue:\n  {}\n",
                   plan.folder.string(), request.command);
        return code;
    }
    report::LinkFacts facts = described(plan);
    links::LinkVerdict verdict = links::judge(plan, files);
    facts.results = std::move(verdict.results);
    facts.gains = std::move(verdict.gains);
    facts.comparisons = std::move(verdict.comparisons);
    facts.confirmatory = are_confirmatory(plan, request);
    facts.exploratory_gains = !plan.benchmark.comparisons.empty();
    facts.command = request.command;
    const std::string json = report::links_json(facts);
    core::write_output(plan.folder / "evaluation.json", json);
    core::write_output(plan.folder / "evaluation.csv", report::links_csv(facts));
    core::write_output(plan.folder / "evaluation.tex", report::links_latex(facts));
    std::ostringstream page;
    report::write_links_page(facts, page);
    core::write_output(plan.folder / "links.html", page.str());
    fmt::print(stderr, "{}\n", (plan.folder / "links.html").string());
    fmt::print("{}", request.printing == Printing::json ? json : report::links_console(facts));
    if (!request.publication.file.empty()) publish_links(request.publication, facts);
    return core::ExitCode::ok;
}

}  // namespace clearway::campaign
