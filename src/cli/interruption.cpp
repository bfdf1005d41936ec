#include "cli/interruption.hpp"

namespace clearway::cli {
namespace {

volatile std::sig_atomic_t received_signal = 0;

extern "C" void remember_signal(int signal) {
    received_signal = signal;
}

}  // namespace

InterruptionWatch::InterruptionWatch() {
    received_signal = 0;
    struct sigaction action = {};
    action.sa_handler = remember_signal;
    sigaction(SIGINT, &action, &earlier_interrupt_);
    sigaction(SIGTERM, &action, &earlier_terminate_);
}

InterruptionWatch::~InterruptionWatch() {
    sigaction(SIGINT, &earlier_interrupt_, nullptr);
    sigaction(SIGTERM, &earlier_terminate_, nullptr);
}

int InterruptionWatch::received() const {
    return received_signal;
}

}  // namespace clearway::cli
