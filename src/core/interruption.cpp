#include "core/interruption.hpp"

namespace clearway::core {
namespace {

constexpr std::array watched = {SIGINT, SIGTERM};
volatile std::sig_atomic_t noted = 0;

extern "C" void note_interruption(int signal) {
    if (noted == 0) noted = signal;
}

}  // namespace

InterruptionWatch::InterruptionWatch() {
    noted = 0;
    struct sigaction action {};
    action.sa_handler = note_interruption;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < watched.size(); ++i)
        sigaction(watched[i], &action, &before_[i]);
}

InterruptionWatch::~InterruptionWatch() {
    for (std::size_t i = 0; i < watched.size(); ++i)
        sigaction(watched[i], &before_[i], nullptr);
}

int InterruptionWatch::signal() const {
    return noted;
}

ExitCode InterruptionWatch::exit_code(ExitCode code) const {
    if (noted == SIGINT) return ExitCode::interrupted;
    if (noted == SIGTERM) return ExitCode::terminated;
    return code;
}

}  // namespace clearway::core
