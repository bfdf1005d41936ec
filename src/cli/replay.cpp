#include "trace/replay.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "campaign/names.hpp"
#include "campaign/printout.hpp"
#include "campaign/replay_page.hpp"
#include "campaign/run_name.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/detail/condition_options.hpp"
#include "cli/detail/trust_option.hpp"
#include "cli/verb.hpp"
#include "core/json.hpp"
#include "experiment/code_parts.hpp"
#include "experiment/settings.hpp"
#include "trace/failure_log.hpp"
#include "trace/recording_tables.hpp"

namespace clearway::cli {
namespace {

using core::Json;

const char* const open_loop =
    "Nothing is simulated: sensing, prediction and policy run again over the recorded traffic, which does "
    "not\n"
    "react (open loop). It shows what would have been believed and how accurate that would have been. What\n"
    "a policy gains is measured by `clearway run`. Without --predictor, --failure, --policy, --set and\n"
    "--model the replay must reproduce the recorded beliefs and leases to the bit; else exit code 6.";

/// What the sensors missed. A replay of the sensors makes this table; the others are in the recording.
constexpr const char* failures_table = "failures";

std::vector<std::string> table_names() {
    std::vector<std::string> names = trace::recording_table_names();
    names.emplace_back(failures_table);
    return names;
}

struct ReplayArguments {
    std::vector<std::string> runs;
    bool is_viewed = false;
    std::string page;
    std::string file;  ///< The recording of the only run.
    std::string network;
    std::optional<std::string> failure;
    std::optional<std::string> predictor;
    std::optional<std::vector<std::string>> policies;
    std::vector<std::string> settings;
    std::string model;
    campaign::CodeTrust trust = campaign::CodeTrust::none;
    std::string table;
    std::optional<double> from_s;
    std::optional<double> to_s;
    Printing printing = Printing::text;
};

/// What the replay keeps of the recorded condition, with the files of the user where they are now. What the
/// command line names, the user has chosen.
experiment::ConditionSpec kept_of(const trace::RecordingInfo& info, const ReplayArguments& arguments) {
    experiment::ConditionSpec kept = info.condition;
    if (arguments.predictor) {
        kept.predictor.clear();
        kept.model_file.clear();
    }
    if (arguments.policies) kept.policies.clear();
    return campaign::with_files_found(kept, campaign::run_folder_of(arguments.file));
}

/// Drops the settings of policies and predictors that the replay replaces.
void drop_what_is_gone(const experiment::ConditionSpec& recorded, const ReplayArguments& arguments,
                       experiment::ConditionSpec& condition) {
    if (arguments.predictor && condition.predictor == recorded.predictor)
        condition.model_file = recorded.model_file;
    if (arguments.predictor && condition.predictor != recorded.predictor) {
        condition.model_file.clear();
        condition.model_hash.clear();
    }
    const std::vector<std::string> present = experiment::components_of(condition);
    std::erase_if(condition.settings, [&](const auto& setting) {
        const std::string component = setting.first.substr(0, setting.first.find('.'));
        return !core::contains(present, component);
    });
}

/// Refuses settings that act only where something is simulated. The sensors alone act on the failure log.
void refuse_idle_settings(const ReplayArguments& arguments, const experiment::ConditionSpec& condition) {
    std::vector<std::string> acting;
    for (const std::string& component : experiment::components_of(condition)) {
        const bool acts = arguments.table == failures_table
                              ? component == "failure"
                              : component != "actuation" && component != "requests" &&
                                    !experiment::is_environment(component);
        if (acts) acting.push_back(component);
    }
    std::vector<core::Problem> problems;
    for (const std::string& words : arguments.settings) {
        const std::string component = words.substr(0, words.find('.'));
        const bool is_known =
            core::contains(experiment::components(), component, &experiment::Component::name);
        if (!is_known || core::contains(acting, component)) continue;
        problems.push_back(
            {"--set " + words.substr(0, words.find('=')),
             arguments.table.empty() ? "changes nothing in a replay, where nothing is simulated"
                                     : "changes nothing in the failure log",
             "settings of " + core::listed(acting), "Remove it, or simulate with it: clearway run"});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

experiment::ConditionSpec condition_of(const trace::RecordingInfo& info, const ReplayArguments& arguments) {
    experiment::ConditionSpec condition = kept_of(info, arguments);
    if (arguments.failure) condition.failure = *arguments.failure;
    if (arguments.predictor) condition.predictor = *arguments.predictor;
    if (arguments.policies) condition.policies = *arguments.policies;
    experiment::resolve_parts(condition, {}, "--");
    drop_what_is_gone(info.condition, arguments, condition);
    refuse_idle_settings(arguments, condition);
    apply_settings(arguments.settings, arguments.model, condition);
    campaign::check_names({condition});
    return condition;
}

trace::RoadNames names_of(const roads::Network& network) {
    trace::RoadNames names;
    for (const roads::Lane& lane : network.lanes())
        names.lanes.push_back(lane.id);
    for (const roads::Signal& signal : network.signals())
        names.signals.push_back(signal.id);
    return names;
}

/// Prints the header, then what `lines` returns for each step between --from and --to.
core::ExitCode print_csv(trace::RecordingReader& recording, const ReplayArguments& arguments,
                         const std::string& header,
                         const std::function<std::string(const trace::RecordedStep&)>& lines) {
    fmt::print("{}", header);
    std::optional<double> begin_s;
    double end_s = 0.0;
    bool any = false;
    while (const auto step = recording.next()) {
        end_s = step->time().value;
        if (!begin_s) begin_s = end_s;
        const std::string text = lines(*step);
        if (arguments.from_s && end_s < *arguments.from_s) continue;
        if (arguments.to_s && end_s > *arguments.to_s) continue;
        any = true;
        fmt::print("{}", text);
    }
    if (!any)
        throw core::InputError({"--from, --to", "no recorded step lies between them",
                                begin_s ? fmt::format("{} to {} s", *begin_s, end_s) : "", ""});
    return core::ExitCode::ok;
}

core::ExitCode print_table(trace::RecordingReader& recording, const ReplayArguments& arguments) {
    const roads::Network network =
        campaign::recorded_network(recording.info(), arguments.file, arguments.network);
    if (arguments.table == failures_table) {
        trace::FailureLogger logger(recording.info(), condition_of(recording.info(), arguments).failure,
                                    network);
        return print_csv(recording, arguments, trace::failure_log_header,
                         [&](const trace::RecordedStep& step) {
                             const sensing::FailureLog* const log = logger.step(step);
                             return log == nullptr ? std::string() : trace::csv_lines(*log, *step.roster);
                         });
    }
    if (arguments.failure || !arguments.settings.empty() || !arguments.model.empty())
        throw core::InputError({arguments.failure ? "--failure" : "--set, --model",
                                fmt::format("cannot be combined with --csv {}", arguments.table),
                                "a replay, or --csv failures", "The table shows what was recorded"});
    const trace::RecordingTable table = trace::recording_table_from(arguments.table).value();
    const trace::RoadNames names = names_of(network);
    return print_csv(recording, arguments, trace::csv_header(table),
                     [&](const trace::RecordedStep& step) { return trace::csv_lines(table, step, names); });
}

Json counts_json(const metrics::LinkCounts& counts) {
    return {{"true_positive", counts.true_positive},
            {"false_positive", counts.false_positive},
            {"false_negative", counts.false_negative},
            {"precision", core::to_json_value(counts.precision())},
            {"recall", core::to_json_value(counts.recall())},
            {"f1", core::to_json_value(counts.f1())}};
}

Json score_json(const trace::LinkScore& score, const experiment::ConditionSpec& condition) {
    return {{"failure", condition.failure},          {"predictor", condition.predictor},
            {"policy", condition.policies},          {"settings", condition.settings},
            {"model", condition.model_file},         {"decisions", score.decisions},
            {"decisions_scored", score.scored},      {"links", counts_json(score.links)},
            {"dark_links", counts_json(score.dark)}, {"leases", score.leases}};
}

Json agreement_json(const trace::Agreement& agreement) {
    const std::string& difference = agreement.first_difference;
    return {{"compared", agreement.compared},
            {"same", agreement.same},
            {"first_difference", difference.empty() ? Json(nullptr) : Json(difference)}};
}

/// The run's name; without the folder if the recording is not in a run folder.
std::string run_of(const std::filesystem::path& recording, const experiment::RunKey& key) {
    const std::filesystem::path folder = campaign::run_folder_of(recording);
    if (!std::filesystem::exists(folder / "manifest.json")) return experiment::to_text(key);
    return campaign::run_name(std::filesystem::proximate(folder), key);
}

Json facts_of(const std::string& run, const trace::RecordingInfo& info,
              const experiment::ConditionSpec& condition, const trace::ReplayResult& result) {
    Json facts = {{"run", run},
                  {"clearway_version", info.provenance.clearway_version},
                  {"sumo_version", info.provenance.sumo_version},
                  {"begin_s", result.begin_s},
                  {"end_s", result.end_s},
                  {"steps", result.steps},
                  {"vehicle_steps", result.vehicle_steps},
                  {"traffic_reacts", false},
                  {"recorded", score_json(result.recorded, info.condition)},
                  {"replayed", score_json(result.replayed, condition)},
                  {"same_to_the_bit",
                   {{"observations", agreement_json(result.observations)},
                    {"beliefs", agreement_json(result.beliefs)},
                    {"leases", agreement_json(result.leases)}}}};
    core::write_fields(facts["replayed"]["candidates"], result.candidates);
    return facts;
}

/// The figures that the text shows, and where the facts of a condition hold them.
constexpr std::array<std::pair<const char*, const char*>, 18> shown = {
    {{"failure", "/failure"},
     {"predictor", "/predictor"},
     {"model", "/model"},
     {"settings", "/settings"},
     {"policy", "/policy"},
     {"decisions", "/decisions"},
     {"  at report rounds", "/decisions_scored"},
     {"links: precision", "/links/precision"},
     {"links: recall", "/links/recall"},
     {"links: F1", "/links/f1"},
     {"dark links: precision", "/dark_links/precision"},
     {"dark links: recall", "/dark_links/recall"},
     {"dark links: F1", "/dark_links/f1"},
     {"candidates: pairs", "/candidates/pairs"},
     {"candidates: AUC", "/candidates/auc"},
     {"candidates: AP", "/candidates/ap"},
     {"candidates: log loss, nat", "/candidates/log_loss"},
     {"leases", "/leases"}}};

campaign::Printout printout_of(const Json& facts) {
    campaign::Table table{"", {{"", "figure"}, {"", "recorded"}, {"", "replayed"}}, {}};
    for (const auto& [title, place] : shown) {
        const Json::json_pointer at(place);
        std::vector<Json> cells = {title};
        for (const char* const whose : {"recorded", "replayed"})
            cells.push_back(facts[whose].contains(at) ? facts[whose][at] : Json(nullptr));
        table.rows.push_back({std::move(cells)});
    }
    std::string text = fmt::format(
        "{}: {} to {} s, {} steps, {} vehicle-steps; recorded by Clearway {} with SUMO {}\n"
        "The traffic is as recorded: it does not react to what is believed in the replay.\n\n{}\n",
        facts["run"].get<std::string>(), facts["begin_s"].get<double>(), facts["end_s"].get<double>(),
        facts["steps"].dump(), facts["vehicle_steps"].dump(), facts["clearway_version"].get<std::string>(),
        facts["sumo_version"].get<std::string>(), campaign::text_of(table));
    for (const auto& [what, agreement] : facts["same_to_the_bit"].items()) {
        const Json& difference = agreement["first_difference"];
        text +=
            fmt::format("{}: {} of {} the same to the bit{}\n", what, agreement["same"].dump(),
                        agreement["compared"].dump(),
                        difference.is_null() ? "" : "; first difference " + difference.get<std::string>());
    }
    return {.facts = facts, .text = std::move(text)};
}

bool is_same(const trace::ReplayResult& result) {
    return result.observations.same == result.observations.compared &&
           result.beliefs.same == result.beliefs.compared && result.leases.same == result.leases.compared;
}

void require_order(const ReplayArguments& arguments) {
    if (!arguments.from_s || !arguments.to_s || *arguments.from_s <= *arguments.to_s) return;
    throw core::InputError({"--from",
                            fmt::format("{} s is after --to {} s", *arguments.from_s, *arguments.to_s), "",
                            "Swap them"});
}

core::ExitCode replay_file(ReplayArguments arguments) {
    require_order(arguments);
    if (arguments.is_viewed)
        return campaign::write_replay_page(
            {arguments.runs, arguments.network, arguments.page, {arguments.from_s, arguments.to_s}});
    if (arguments.runs.size() != 1)
        throw core::InputError(
            {"RUN", fmt::format("{} runs are named", arguments.runs.size()), "one run; two with --view", ""});
    const campaign::NamedRecording named = campaign::recording_named(arguments.runs.front(), "RUN");
    arguments.file = named.file;
    trace::RecordingReader& recording = *named.reader;
    if (!arguments.table.empty()) return print_table(recording, arguments);
    if (arguments.from_s || arguments.to_s)
        throw core::InputError({"--from, --to", "work only with --csv and --view", "",
                                "A replay needs the recording from its beginning"});
    const trace::RecordingInfo& info = recording.info();
    campaign::require_trust({kept_of(info, arguments)}, {}, arguments.file, arguments.trust);
    const experiment::ConditionSpec condition = condition_of(info, arguments);
    const roads::Network network = campaign::recorded_network(info, arguments.file, arguments.network);
    const trace::ReplayResult result =
        trace::replay(recording, condition, network,
                      campaign::recorded_mean_times(info, arguments.file, arguments.network));
    const std::string run = run_of(arguments.file, info.key);
    campaign::print(printout_of(facts_of(run, info, condition, result)), arguments.printing);
    if (condition != info.condition || is_same(result)) return core::ExitCode::ok;
    fmt::print(
        stderr,
        "clearway: the replay does not reproduce the recorded condition. The recording is of version {}, "
        "this is {}; a model file or the code has changed\n",
        info.provenance.clearway_version, CLEARWAY_VERSION);
    return core::ExitCode::fell_short;
}

/// Returns what cannot be combined with another replay.
Option add_view_options(App& app, const std::shared_ptr<ReplayArguments>& arguments) {
    const OptionGroup group(app, "Watch, instead of a replay");
    const Option view =
        app.add_flag("--view", arguments->is_viewed,
                     "Write a page that plays the run, or two side by side, in a browser [off]");
    app.add_option("--out", arguments->page, "The page to write")
        .option_text("FILE [SCENARIO-CONDITION-N.html]")
        .needs(view);
    return view;
}

void add_csv_options(App& app, const std::shared_ptr<ReplayArguments>& arguments,
                     const std::vector<Option>& others) {
    const OptionGroup group(app, "Export as CSV, instead of a replay");
    const Option csv = app.add_option("--csv", arguments->table, "Table to print, see below")
                           .one_of(table_names())
                           .option_text("TABLE [replay]");
    for (const Option& other : others)
        csv.excludes(other);
    constexpr double latest_s = 1e9;
    app.add_option("--from", arguments->from_s, "First simulation time of the table or page, s")
        .range(0.0, latest_s)
        .option_text("SECONDS [beginning]");
    app.add_option("--to", arguments->to_s, "Last simulation time of the table or page, s")
        .range(0.0, latest_s)
        .option_text("SECONDS [end]");
}

}  // namespace

Action configure_replay(App& app) {
    const auto arguments = std::make_shared<ReplayArguments>();
    app.footer(app.get_footer() +
               "\n  clearway replay RUN --csv belief --from 60 --to 90 > belief.csv\n"
               "  clearway replay runs/mine/city/baseline/0 runs/mine/city/mine/0 --view\n\n" +
               "Tables: " + core::listed(table_names()) + "\n\n" + open_loop);
    app.add_option(
           "run", arguments->runs,
           fmt::format("{} of a recorded run, or a recording; two with --view", campaign::run_name_form))
        .required()
        .expected(1, 2)
        .option_text("RUN (required)");
    std::vector<Option> thinking;
    thinking.push_back(app.add_option("--predictor", arguments->predictor, "How the graph is repaired")
                           .option_text("NAME [as recorded]"));
    app.add_option("--failure", arguments->failure,
                   "How sensors fail, with the draws of the recorded run; also for --csv failures")
        .option_text("NAME [as recorded]");
    thinking.push_back(app.add_option("--policy", arguments->policies, "Policies, in this order")
                           .option_text("NAME ... [as recorded]"));
    add_setting_options(app, arguments->settings, arguments->model, "as recorded");
    add_trust_option(app, arguments->trust);
    app.add_option("--network", arguments->network, "Network file on which the recording was made")
        .option_text("FILE [that of its run folder]");
    thinking.push_back(app.add_flag_callback(
        "--json", [arguments] { arguments->printing = Printing::json; },
        "Print the figures as JSON, with units in the field names [text]"));
    const Option view = add_view_options(app, arguments);
    for (const Option& other : thinking)
        view.excludes(other);
    thinking.push_back(view);
    add_csv_options(app, arguments, thinking);
    return [arguments](const Invocation&) { return replay_file(*arguments); };
}

}  // namespace clearway::cli
