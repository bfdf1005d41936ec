#include "study/detail/interrupt.hpp"

namespace clearway::study::detail {
namespace {

constexpr std::array watched = {SIGINT, SIGTERM};
volatile std::sig_atomic_t noted = 0;

void note(int signal) {
    if (noted == 0) noted = signal;
}

}  // namespace

InterruptWatch::InterruptWatch() {
    noted = 0;
    struct sigaction action {};
    action.sa_handler = note;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < watched.size(); ++i)
        sigaction(watched[i], &action, &before_[i]);
}

InterruptWatch::~InterruptWatch() {
    for (std::size_t i = 0; i < watched.size(); ++i)
        sigaction(watched[i], &before_[i], nullptr);
}

int InterruptWatch::signal() const {
    return noted;
}

}  // namespace clearway::study::detail
