#include "roads/program_times.hpp"

#include <algorithm>
#include <utility>

#include "traffic/signal.hpp"

namespace clearway::roads {
namespace {

void take_least(std::optional<double>& least, double value) {
    least = std::min(least.value_or(value), value);
}

char letter_of(const Phase& phase, std::size_t link) {
    return link < phase.state.size() ? phase.state[link] : 'r';
}

/// A link as time goes by.
struct Clock {
    char colour = '?';
    double since_s = 0.0;
    bool is_whole = false;  ///< The beginning of the colour was seen.
    bool clears = false;    ///< Red, and no link has opened since.
};

char colour_of(char letter) {
    return traffic::is_green(letter) ? 'g' : traffic::is_yellow(letter) ? 'y' : 'r';
}

/// Plays phases one after the other.
class Playback {
  public:
    Playback(std::size_t links, ProgramTimes& times) : times_(times), clocks_(links) {}

    void show(const Phase& phase) {
        bool any_opens = false;
        for (std::size_t link = 0; link < clocks_.size(); ++link) {
            const char colour = colour_of(letter_of(phase, link));
            Clock& clock = clocks_[link];
            if (colour == clock.colour) continue;
            if (clock.is_whole) note(link, clock);
            any_opens = any_opens || colour == 'g';
            const bool was_green = clock.colour == 'g' || clock.colour == 'y';
            clock = {colour, now_s_, clock.colour != '?', colour == 'r' && was_green};
        }
        if (any_opens) end_clearances();
        now_s_ += phase.duration_s;
    }

  private:
    void note(std::size_t link, const Clock& clock) {
        const double lasted_s = now_s_ - clock.since_s;
        if (clock.colour == 'y') take_least(times_.yellow_s[link], lasted_s);
        if (clock.colour == 'g') take_least(times_.green_s[link], lasted_s);
    }
    void end_clearances() {
        for (std::size_t link = 0; link < clocks_.size(); ++link) {
            if (!std::exchange(clocks_[link].clears, false)) continue;
            take_least(times_.red_s[link], now_s_ - clocks_[link].since_s);
        }
    }

    ProgramTimes& times_;
    std::vector<Clock> clocks_;
    double now_s_ = 0.0;
};

bool runs_side_by_side(const Signal& signal) {
    return std::ranges::any_of(signal.program,
                               [](const Phase& phase) { return phase.yellow_s > 0.0 || phase.red_s > 0.0; });
}

void take_phases(const Signal& signal, ProgramTimes& times) {
    for (const Phase& phase : signal.program) {
        for (std::size_t link = 0; link < signal.links.size(); ++link) {
            if (!traffic::is_green(letter_of(phase, link))) continue;
            if (!signal.crossings[link]) take_least(times.yellow_s[link], phase.yellow_s);
            take_least(times.red_s[link], phase.red_s);
            take_least(times.green_s[link], phase.duration_s);
        }
    }
}

/// The shortest green that is shown becomes the least that is owed.
void limit_greens(const Signal& signal, ProgramTimes& times) {
    for (std::size_t link = 0; link < signal.links.size(); ++link) {
        if (!times.green_s[link]) continue;
        std::optional<double> stated_s;
        for (const Phase& phase : signal.program)
            if (traffic::is_green(letter_of(phase, link)) && phase.least_s > 0.0)
                take_least(stated_s, phase.least_s);
        const double usual_s = signal.crossings[link] ? assumed_walk_s : assumed_least_green_s;
        take_least(times.green_s[link], stated_s.value_or(usual_s));
    }
}

}  // namespace

ProgramTimes program_times(const Signal& signal) {
    const std::vector<std::optional<double>> none(signal.links.size());
    ProgramTimes times{none, none, none};
    if (runs_side_by_side(signal)) {
        take_phases(signal, times);
    } else {
        Playback playback(signal.links.size(), times);
        for (int cycle = 0; cycle < 2; ++cycle)
            for (const Phase& phase : signal.program)
                playback.show(phase);
        if (!signal.program.empty()) playback.show(signal.program.front());
    }
    limit_greens(signal, times);
    return times;
}

}  // namespace clearway::roads
