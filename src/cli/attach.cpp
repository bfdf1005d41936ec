#include <memory>
#include <string>

#include <fmt/format.h>

#include "campaign/names.hpp"
#include "campaign/study_run.hpp"
#include "campaign/worker_jobs.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/verb.hpp"
#include "core/number.hpp"
#include "experiment/attach_job.hpp"
#include "results/store.hpp"

namespace clearway::cli {
namespace {

struct AttachArguments {
    std::string place;
    std::string folder;
    experiment::AttachJob job;
    DescribedCondition described;
    campaign::PublishOptions publish;
};

/// Sets host and port of `HOST:PORT`, `:PORT` or `PORT`.
void read_place(const std::string& place, experiment::AttachJob& job) {
    const std::size_t colon = place.rfind(':');
    job.host = colon == std::string::npos ? "" : place.substr(0, colon);
    if (job.host.empty()) job.host = "localhost";
    const std::string digits = colon == std::string::npos ? place : place.substr(colon + 1);
    job.port = core::number_from<int>(digits).value_or(0);
    constexpr int last_port = 65535;
    if (job.port < 1 || job.port > last_port)
        throw core::InputError({"HOST:PORT", fmt::format("`{}` is not the address of a SUMO", place),
                                "a host and a port from 1 to 65535, as localhost:8813",
                                "Give the port that SUMO was started with (--remote-port)"});
}

core::ExitCode attach(const AttachArguments& arguments) {
    experiment::AttachJob job = arguments.job;
    read_place(arguments.place, job);
    const std::filesystem::path folder =
        arguments.folder.empty() ? fmt::format("runs/attached-{}", job.port) : arguments.folder;
    if (std::filesystem::exists(folder))
        throw core::InputError(
            {folder.string(), "exists already", "a new folder",
             "Give another with --out, or remove it; an attached simulation cannot be resumed"});
    job.output = std::filesystem::absolute(folder);
    if (!job.network.empty()) job.network = std::filesystem::absolute(job.network);
    job.condition = condition_of(arguments.described);
    campaign::check_names({job.condition});
    const std::filesystem::path jobs = job.output.string() + ".job";
    if (std::filesystem::exists(jobs))
        throw core::InputError({jobs.string(), "exists already", "a new name: the job's files go there",
                                "Give another with --out, or remove it"});
    const campaign::WorkerResult result =
        campaign::work_on({{.label = fmt::format("SUMO at {}:{}", job.host, job.port),
                            .job = job,
                            .file = jobs / "attach.json",
                            .log = jobs / "attach.log",
                            .work = {job.output, jobs}}},
                          1, "simulations");
    if (result.exit_code != core::ExitCode::ok) {
        std::error_code not_empty;
        if (arguments.folder.empty()) std::filesystem::remove("runs", not_empty);
        return result.exit_code;
    }
    std::filesystem::remove_all(jobs);
    return campaign::publish(results::Store::open(job.output), arguments.publish);
}

}  // namespace

Action configure_attach(App& app) {
    const auto arguments = std::make_shared<AttachArguments>();
    arguments->described.condition.name = "attached";
    experiment::AttachJob& job = arguments->job;
    app.add_option("place", arguments->place, "Where SUMO waits for a client (its --remote-port)")
        .required()
        .option_text("HOST:PORT (required)");
    {
        const OptionGroup group(app, "Condition (names: clearway list)");
        add_condition_options(app, arguments->described, "none");
    }
    app.add_option("--automated", job.automated,
                   "Vehicle types that are automated, besides those that declare it (clearway.class)")
        .option_text("TYPE ... [none]");
    app.add_option("--emergency", job.emergency,
                   "Vehicle types that are emergency vehicles, besides those of vClass emergency")
        .option_text("TYPE ... [none]");
    app.add_option("--network", job.network, "Its network file, if it is not at the path that SUMO reports")
        .option_text("FILE [as SUMO says]");
    add_seed_option(app, job.study_seed);
    app.add_option("--out", arguments->folder, "Run folder").option_text("DIR [runs/attached-PORT]");
    add_json_option(app, arguments->publish.printing, "the tables");
    add_tables_option(app, arguments->publish.tables);
    return [arguments](const Invocation&) { return attach(*arguments); };
}

}  // namespace clearway::cli
