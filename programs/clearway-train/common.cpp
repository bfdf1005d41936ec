#include "common.hpp"

#include <chrono>
#include <csignal>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace clearway::training {
namespace {

volatile std::sig_atomic_t received_signal = 0;

extern "C" void remember_signal(int signal) {
    received_signal = signal;
}

void report_early_end(const OutputFolder& folder, const TrainingResult& result) {
    const std::size_t rounds = result.losses.size();
    const bool has_model = !result.state.empty();
    if (result.outcome == Outcome::diverged) {
        fmt::print(stderr,
                   "clearway-train: training diverged after {} good {}{}: a loss is not finite. {}. Try a "
                   "smaller --learning-rate, or features of a smaller scale\n",
                   rounds - 1, result.round, rounds == 2 ? "" : "s",
                   has_model ? "The parameters before it are kept"
                             : "None had finite losses, so no model was written");
    } else if (result.outcome == Outcome::interrupted) {
        const char* const kept = folder.is_whole() ? "the whole training that was there stays"
                                 : has_model       ? "the model so far is written"
                                                   : "no model was written";
        fmt::print(stderr, "clearway-train: interrupted after {} {}{}; {}\n", rounds, result.round,
                   rounds == 1 ? "" : "s", kept);
    }
}

}  // namespace

void watch_signals() {
    std::signal(SIGINT, remember_signal);
    std::signal(SIGTERM, remember_signal);
}

std::string figure(const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : "undefined";
}

void print_quality(const std::string& label, const metrics::LinkQuality& quality) {
    fmt::print("{}: {} pairs, {} linked; AUC {}, AP {}, F1 {} (from {:.3f}), log loss {} nat, ECE {}\n",
               label, quality.pairs, quality.true_links, figure(quality.auc), figure(quality.ap),
               figure(quality.f1), quality.threshold, figure(quality.log_loss), figure(quality.ece));
}

TrainingHooks hooks_with_lines(Printing printing, std::uint32_t rounds, const char* round) {
    TrainingHooks hooks;
    hooks.should_stop = [] { return received_signal != 0; };
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

core::ExitCode conclude(const CommonArguments& arguments, const OutputFolder& folder,
                        const TrainingResult& result, const Identity& identity, const std::string& closing) {
    const nlohmann::ordered_json summary = summary_of(result, identity, arguments.data);
    if (!folder.keeps_earlier(result.outcome, result.losses.size()))
        write_outputs(folder.path(), result, summary);
    if (arguments.printing == Printing::json) {
        fmt::print("{}\n", summary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    } else if (!result.groups.empty()) {
        fmt::print("{}; seeds: {} training, {} validation, {} test\n", closing, result.seeds.train.size(),
                   result.seeds.validation.size(), result.seeds.test.size());
        for (const GroupQuality& group : result.groups) {
            std::string label = group.failure.empty() ? "all test seeds" : group.failure;
            if (!group.scenario.empty()) label += ", " + group.scenario;
            print_quality(label, group.model);
            if (group.reference) print_quality(fmt::format("  {}", result.reference), *group.reference);
        }
    }
    report_early_end(folder, result);
    if (result.outcome == Outcome::diverged) return core::ExitCode::runs_failed;
    if (result.outcome != Outcome::interrupted) return core::ExitCode::ok;
    return received_signal == SIGTERM ? core::ExitCode::terminated : core::ExitCode::interrupted;
}

}  // namespace clearway::training
