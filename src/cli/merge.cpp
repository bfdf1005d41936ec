#include "study/merge.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "campaign/printout.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/verb.hpp"
#include "core/counted.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"

namespace clearway::cli {
namespace {

struct MergeArguments {
    std::vector<std::string> sources;
    std::string out;
    Printing printing = Printing::text;
};

std::string text_of(const study::MergeResult& result, const std::string& out) {
    const results::RunCounts& counts = result.counts;
    std::string text = fmt::format("{}: {} complete, {} failed, {} missing; {} new, {} seen before\n", out,
                                   core::counted(counts.complete, "run"), counts.failed, counts.missing,
                                   result.adopted, result.duplicates);
    for (const std::string& lost : result.lost)
        text += fmt::format(
            "lost: {}: no folder has it whole. Continue the study in one of them, then merge again\n", lost);
    if (!result.absent_shards.empty())
        text += fmt::format("not there: shard {}\n", core::listed(result.absent_shards));
    for (const experiment::RunKey& key : result.missing)
        text += fmt::format("missing: {}\n", experiment::to_text(key));
    if (result.missing.size() < counts.missing)
        text += fmt::format("and {} more, in {}\n", counts.missing - result.missing.size(),
                            (std::filesystem::path(out) / "runs.csv").string());
    return text;
}

campaign::Printout printout_of(const study::MergeResult& result, const std::string& out) {
    const std::vector<std::string> missing = core::texts_of(
        result.missing, [](const experiment::RunKey& key) { return experiment::to_text(key); });
    return {{{"folder", out},
             {"complete_runs", result.counts.complete},
             {"failed_runs", result.counts.failed},
             {"missing_runs", result.counts.missing},
             {"new_runs", result.adopted},
             {"runs_seen_before", result.duplicates},
             {"damaged", result.damaged},
             {"lost", result.lost},
             {"absent_shards", result.absent_shards},
             {"first_missing", missing}},
            {},
            text_of(result, out)};
}

core::ExitCode merge(const MergeArguments& arguments) {
    const std::vector<std::filesystem::path> sources(arguments.sources.begin(), arguments.sources.end());
    std::size_t folders = 0;
    for (const std::filesystem::path& source : sources)
        folders += study::run_folders(source).size();
    core::Progress progress("folders", folders, core::Progress::style_for_stderr());
    const study::MergeResult result =
        study::merge(sources, arguments.out, [&](std::size_t done) { progress.update(done, 0); });
    progress.update(folders, 0);
    progress.finish();
    for (const std::string& damaged : result.damaged)
        fmt::print(stderr, "clearway: {}\n", damaged);
    campaign::print(printout_of(result, arguments.out), arguments.printing);
    if (result.counts.missing > 0 || !result.lost.empty()) return core::ExitCode::incomplete;
    return result.counts.failed > 0 ? core::ExitCode::runs_failed : core::ExitCode::ok;
}

}  // namespace

Action configure_merge(App& app) {
    const auto arguments = std::make_shared<MergeArguments>();
    app.add_option("folders", arguments->sources,
                   "Run folders of the shards, or folders that hold them in shards/")
        .required()
        .option_text("DIR ... (required)");
    app.add_option("--out", arguments->out, "Run folder of the whole study; may hold some runs already")
        .required()
        .option_text("DIR (required)");
    add_json_option(app, arguments->printing, "what was merged");
    return [arguments](const Invocation&) { return merge(*arguments); };
}

}  // namespace clearway::cli
