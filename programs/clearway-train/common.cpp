#include "common.hpp"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/usage.hpp"
#include "samples/graph_sample.hpp"

namespace clearway::training {
namespace {

volatile std::sig_atomic_t received_signal = 0;

extern "C" void remember_signal(int signal) {
    received_signal = signal;
}

}  // namespace

void add_folder_options(CLI::App& app, CommonArguments& arguments, const char* data_doc,
                        const char* out_doc) {
    app.add_option("--data", arguments.data, data_doc)->required()->option_text("DIR (required)");
    app.add_option("--out", arguments.out, out_doc)->required()->option_text("DIR (required)");
}

void add_printing_options(CLI::App& app, Printing& printing) {
    app.add_flag_callback(
        "--quiet", [&] { printing = Printing::closing_only; }, "Do not print the losses of each epoch");
    app.add_flag_callback(
        "--json", [&] { printing = Printing::json; }, "Print the summary as JSON, and nothing else");
}

RepairData read_repair_data(const std::filesystem::path& folder) {
    auto [files, hashes] = read_distinct(samples::find_graph_samples(folder), samples::read_repair_samples);
    return {std::move(files), core::content_hash(fmt::format("{}", fmt::join(hashes, "")))};
}

std::string figure(const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : "undefined";
}

bool stop_requested() {
    return received_signal != 0;
}

void print_quality(const std::string& label, const metrics::LinkQuality& quality) {
    fmt::print("{}: {} pairs, {} linked; AUC {}, AP {}, F1 {} (from {:.3f}), log loss {} nat, ECE {}\n",
               label, quality.pairs, quality.true_links, figure(quality.auc), figure(quality.ap),
               figure(quality.f1), quality.threshold, figure(quality.log_loss), figure(quality.ece));
}

TrainingHooks hooks_with_lines(Printing printing, std::uint32_t rounds, const char* round) {
    TrainingHooks hooks;
    hooks.should_stop = stop_requested;
    if (printing != Printing::epochs) return hooks;
    const auto started = std::chrono::steady_clock::now();
    hooks.on_epoch = [started, rounds, round](std::uint32_t epoch, const EpochLoss& loss) {
        const double passed_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
        fmt::print("{} {} of {}: training loss {:.5f}, validation loss {:.5f} nat, {:.0f} s\n", round,
                   epoch + 1, rounds, loss.train, loss.held_out, passed_s);
        std::fflush(stdout);
    };
    return hooks;
}

void print_json(const nlohmann::ordered_json& summary) {
    fmt::print("{}\n", summary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void print_result(Printing printing, const RepairTraining& result, const nlohmann::ordered_json& summary,
                  const std::string& kept) {
    if (printing == Printing::json) print_json(summary);
    if (printing == Printing::json || result.groups.empty()) return;
    fmt::print("{}; seeds: {} training, {} validation, {} test\n", kept, result.seeds.train.size(),
               result.seeds.validation.size(), result.seeds.test.size());
    for (const RepairGroup& group : result.groups) {
        std::string label = group.failure.empty() ? "all test seeds" : group.failure;
        if (!group.scenario.empty()) label += ", " + group.scenario;
        print_quality(label, group.model);
        print_quality("  route rule", group.rule);
    }
}

core::ExitCode exit_code_for(const OutputFolder& folder, Outcome outcome, std::size_t rounds, bool has_model,
                             const char* round) {
    if (outcome == Outcome::diverged) {
        fmt::print(stderr,
                   "clearway-train: training diverged after {} good {}{}: a loss is not finite. {}. Try a "
                   "smaller --learning-rate, or features of a smaller scale\n",
                   rounds - 1, round, rounds == 2 ? "" : "s",
                   has_model ? "The parameters before it are kept"
                             : "None had finite losses, so no model was written");
        return core::ExitCode::runs_failed;
    }
    if (outcome == Outcome::interrupted) {
        const char* const kept = folder.is_whole() ? "the whole training that was there stays"
                                 : has_model       ? "the model so far is written"
                                                   : "no model was written";
        fmt::print(stderr, "clearway-train: interrupted after {} {}{}; {}\n", rounds, round,
                   rounds == 1 ? "" : "s", kept);
        return received_signal == SIGTERM ? core::ExitCode::terminated : core::ExitCode::interrupted;
    }
    return core::ExitCode::ok;
}

int parse_and_train(CLI::App& app, int argument_count, char** argument_values,
                    const std::function<core::ExitCode()>& train) {
    app.formatter(std::make_shared<core::HelpFormatter>());
    try {
        app.parse(argument_count, argument_values);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        fmt::print(stderr, "{}",
                   core::usage_message(app, app.get_name(), error, {graphsage_word, gradient_boosting_word}));
        return static_cast<int>(core::ExitCode::usage);
    }
    std::signal(SIGINT, remember_signal);
    std::signal(SIGTERM, remember_signal);
    const core::ExitCode code = train();
    if (std::fflush(stdout) != 0) throw core::EnvironmentError("standard output cannot be written");
    return static_cast<int>(code);
}

}  // namespace clearway::training
