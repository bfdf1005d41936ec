#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "campaign/equip.hpp"
#include "campaign/names.hpp"
#include "campaign/programs.hpp"
#include "campaign/stored_folder.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/verb.hpp"
#include "core/counted.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "core/machine_failure.hpp"
#include "core/process.hpp"
#include "core/progress.hpp"
#include "core/temporary_folder.hpp"
#include "report/figure_files.hpp"
#include "report/read_facts.hpp"
#include "results/store.hpp"

namespace clearway::cli {
namespace {

enum class Formats { all, svg };

struct FiguresArguments {
    std::filesystem::path folder;
    std::filesystem::path output;
    std::string against;  ///< Empty: the baselines.
    double least_relevant_s = report::usual_least_relevant_s;
    Formats formats = Formats::all;
    report::FigureChoice choice;
    std::string condition;  ///< That maps and trips show; empty: as in the report.
};

constexpr const char* rasteriser = "rsvg-convert";
constexpr const char* scale = "3";  // 1200 pixels across: enough for a column of print at 300 dpi

/// Converts SVG files to files beside them. Throws core::EnvironmentError when the program is missing or
/// fails.
void convert(const std::vector<std::filesystem::path>& drawings, const std::string& format) {
    const core::TemporaryFolder folder;
    core::Progress progress(format + " files", drawings.size(), core::Progress::style_for_stderr());
    std::size_t done = 0;
    for (const std::filesystem::path& drawing : drawings) {
        progress.update(done++, 0);
        const std::filesystem::path source =
            std::filesystem::absolute(drawing);  // no option, as `-x/` may be
        std::filesystem::path picture = source;
        picture.replace_extension("." + format);
        const std::filesystem::path log = folder.path() / "log";
        const core::Exit exit =
            core::run({.program = rasteriser,
                       .arguments = {"--format", format, "--zoom", format == "png" ? scale : "1", "--output",
                                     picture.string(), source.string()},
                       .output = log});
        if (exit.ok()) continue;
        if (exit.code == campaign::program_not_started)
            throw core::EnvironmentError(fmt::format(
                "{} cannot be started; it makes PDF and PNG files. {}. The SVG, CSV and LaTeX "
                "files and index.html are written",
                rasteriser, core::cure_of_no_start("Install the package librsvg2-bin, or give --svg-only")));
        throw core::EnvironmentError(fmt::format("{}: {} ended with {}: {}", drawing.string(), rasteriser,
                                                 exit.describe(), core::tail(log, 3)));
    }
    progress.finish();
}

/// Of a folder of clearway equip, which is no run folder.
core::ExitCode write_equipment(const FiguresArguments& arguments) {
    campaign::require_equip_file(arguments.folder, "equip.json");
    if (!arguments.against.empty())
        throw core::InputError({"--against", "is given for a folder of clearway equip",
                                "a folder of run or study", "Leave it out"});
    if (!arguments.choice.only.empty())
        throw core::InputError({"--only", "is given for a folder of clearway equip",
                                "a folder of run or study", "Leave it out"});
    std::vector<std::filesystem::path> drawings;
    core::claim(arguments.output, report::figure_folder());
    for (const char* const name : {"curve.svg", "map.svg"}) {
        const std::string drawing = core::read_file(arguments.folder / name);
        if (drawing.empty()) continue;
        drawings.push_back(arguments.output / name);
        core::write_output(drawings.back(), drawing);
    }
    const bool all = arguments.formats == Formats::all;
    for (const char* const format : {"pdf", "png"})
        if (all) convert(drawings, format);
    fmt::print(stderr, "clearway: written to {}: {} as SVG{}\n", arguments.output.string(),
               core::counted(drawings.size(), "figure"), all ? ", PDF and PNG" : "");
    return core::ExitCode::ok;
}

core::ExitCode write(const FiguresArguments& arguments) {
    if (campaign::is_equip_folder(arguments.folder)) return write_equipment(arguments);
    if (std::filesystem::exists(arguments.folder / "evaluation.tex"))
        throw core::InputError(
            {arguments.folder.string(), "is of clearway links evaluate", "a folder of run, study or equip",
             "Its tables are evaluation.tex and evaluation.csv, its figures are on links.html"});
    const bool all = arguments.formats == Formats::all;
    const results::Store store = results::Store::open(arguments.folder);
    const results::Manifest& manifest = store.manifest();
    const report::StudyFacts facts =
        report::read_facts(arguments.folder, arguments.least_relevant_s,
                           campaign::reference_from(arguments.against, manifest.conditions, arguments.folder),
                           campaign::condition_called(arguments.condition, store));
    const report::FigureFiles files = report::write_figures(facts, arguments.output, arguments.choice);
    report::write_index(files, arguments.output);
    if (all) {
        for (const char* const format : {"pdf", "png"})
            convert(files.drawings, format);
        report::write_index(files, arguments.output);
    }
    fmt::print(stderr,
               "clearway: written to {}: {} as SVG{}, {} as CSV, {} as LaTeX; all are on index.html\n",
               arguments.output.string(), core::counted(files.drawings.size(), "figure"),
               all ? ", PDF and PNG" : "", core::counted(files.tables.size(), "table"), files.typeset.size());
    for (const auto& [seeds, names] : files.of_other_seeds)
        fmt::print(stderr, "clearway: left as they were, from {}: {}\n",
                   seeds.empty() ? "an unknown number of seeds" : seeds, fmt::join(names, ", "));
    const std::size_t ended = store.complete_runs().size() + store.failed_runs().size();
    return campaign::tell_missing(manifest.run_count() - std::min(ended, manifest.run_count()),
                                  manifest.run_count());
}

}  // namespace

Action configure_figures(App& app) {
    const auto arguments = std::make_shared<FiguresArguments>();
    app.add_option("folder", arguments->folder, "Folder of run, study or equip")
        .required()
        .option_text("DIR (required)");
    app.add_option("--out", arguments->output, "Folder for the files; made if it does not exist")
        .required()
        .option_text("DIR (required)");
    app.add_option("--against", arguments->against,
                   "Condition that stands for the baseline; or levels of factors: each condition is compared "
                   "with the one that is the same but for these; or best: with the best other one")
        .option_text("NAME|FACTOR=LEVEL,...|best [the baselines]");
    add_shown_condition_option(app, arguments->condition);
    app.add_option("--least-difference", arguments->least_relevant_s,
                   "Smallest difference of an EV's time that counts as an effect, s; 0: any")
        .range(0.0, 1e6)
        .option_text(fmt::format("SECONDS, 0 to 1e6 [{}]", arguments->least_relevant_s));
    app.add_flag_callback(
           "--svg-only", [arguments] { arguments->formats = Formats::svg; },
           "Write no PDF and no PNG files, which need the program rsvg-convert")
        .option_text("[off]");
    app.add_option("--only", arguments->choice.only,
                   "Figure or table by name, or by what its name begins with: tradeoff, factors, "
                   "differences, travel-time, map, ...; another word lists those of the folder; may be "
                   "repeated. Others that DIR holds stay; those of another number of seeds are named")
        .allow_extra_args(false)
        .option_text("NAME [all]");
    app.add_flag_callback(
           "--bare", [arguments] { arguments->choice.words = report::FigureChoice::Words::bare; },
           "Leave title, seeds and note out of the drawings, for a text that has them in its captions; what "
           "explains a mark stays")
        .option_text("[off]");
    return [arguments](const Invocation&) { return write(*arguments); };
}

}  // namespace clearway::cli
