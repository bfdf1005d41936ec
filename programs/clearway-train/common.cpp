#include "common.hpp"

#include <csignal>
#include <cstdio>

namespace clearway::training {
namespace {

volatile std::sig_atomic_t received_signal = 0;

extern "C" void remember_signal(int signal) {
    received_signal = signal;
}

}  // namespace

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

core::ExitCode exit_code_for(Outcome outcome, const std::vector<EpochLoss>& losses, bool has_model) {
    if (outcome == Outcome::diverged) {
        fmt::print(stderr,
                   "clearway-train: training diverged in epoch {}: a loss is not finite. {}. Try a smaller "
                   "--learning-rate, or "
                   "features of a smaller scale\n",
                   losses.size() - 1,
                   has_model ? "The parameters before it are kept"
                             : "No epoch had finite losses, so no model was written");
        return core::ExitCode::runs_failed;
    }
    if (outcome == Outcome::interrupted) {
        fmt::print(stderr, "clearway-train: interrupted after {} epochs; {}\n", losses.size(),
                   has_model ? "the model so far is written" : "no model was written");
        return received_signal == SIGTERM ? core::ExitCode::terminated : core::ExitCode::interrupted;
    }
    return core::ExitCode::ok;
}

int parse_and_train(CLI::App& app, int argument_count, char** argument_values,
                    const std::function<core::ExitCode()>& train) {
    try {
        app.parse(argument_count, argument_values);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : static_cast<int>(core::ExitCode::usage);
    }
    std::signal(SIGINT, remember_signal);
    std::signal(SIGTERM, remember_signal);
    const core::ExitCode code = train();
    if (std::fflush(stdout) != 0) throw core::EnvironmentError("standard output cannot be written");
    return static_cast<int>(code);
}

}  // namespace clearway::training
