#include "core/interruption.hpp"

#include <unistd.h>

namespace clearway::core {
namespace {

constexpr std::array watched = {SIGINT, SIGTERM};
volatile std::sig_atomic_t noted = 0;
std::string notice;  // as long as a handler may write it, it does not change

extern "C" void note_interruption(int signal) {
    if (noted == 0) noted = signal;
}

extern "C" void tell_interruption(int signal) {
    // What cannot be written cannot be told either.
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, notice.data(), notice.size());
    ::raise(signal);  // by now as before (SA_RESETHAND), once this has returned
}

void handle(void (*handler)(int), int flags) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = flags;
    sigemptyset(&action.sa_mask);
    for (const int signal : watched)
        sigaction(signal, &action, nullptr);
}

}  // namespace

InterruptionNotice::InterruptionNotice(const std::string& text) {
    notice = text;
    handle(tell_interruption, static_cast<int>(SA_RESETHAND));
}

InterruptionNotice::~InterruptionNotice() {
    handle(SIG_DFL, 0);
}

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
