#include "roads/program_times.hpp"

#include <algorithm>
#include <cassert>
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
    bool is_whole = false;      ///< The beginning of the colour was seen.
    bool clears = false;        ///< Red, and no link has opened since.
    bool is_joined = false;     ///< Yellow, and a link has opened since.
    double went_until_s = 0.0;  ///< End of its last green.
    std::optional<double> red_s =
        std::nullopt;  ///< Red clearance, until it is known whether it was for a foe.
};

char colour_of(char letter) {
    return traffic::is_green(letter) ? 'g' : traffic::is_yellow(letter) ? 'y' : 'r';
}

/// Plays phases one after the other.
class Playback {
  public:
    Playback(const Signal& signal, ProgramTimes& times)
        : signal_(signal), times_(times), clocks_(signal.links.size()) {}

    void show(const Phase& phase) {
        std::vector<std::size_t> opened;
        for (std::size_t link = 0; link < clocks_.size(); ++link) {
            const char colour = colour_of(letter_of(phase, link));
            Clock& clock = clocks_[link];
            if (colour == clock.colour) continue;
            if (clock.is_whole) note(link, clock);
            if (colour == 'g') opened.push_back(link);
            const bool was_green = clock.colour == 'g' || clock.colour == 'y';
            const bool clears = colour == 'r' && was_green;
            if (clears && clock.is_joined) take_least(times_.red_s[link], 0.0);
            clock = {colour,
                     now_s_,
                     clock.colour != '?',
                     clears && !clock.is_joined,
                     false,
                     clock.went_until_s,
                     std::nullopt};
        }
        if (!opened.empty()) end_clearances(opened);
        now_s_ += phase.duration_s;
        for (Clock& clock : clocks_)
            if (clock.colour == 'g') clock.went_until_s = now_s_;
    }

  private:
    void note(std::size_t link, const Clock& clock) {
        const double lasted_s = now_s_ - clock.since_s;
        assert(lasted_s >= 0.0);
        if (clock.colour == 'y') take_least(times_.yellow_s[link], lasted_s);
        if (clock.colour == 'g') take_least(times_.green_s[link], lasted_s);
    }
    /// Since when those that opened waited for no other vehicles.
    double free_since_s(const std::vector<std::size_t>& opened, std::size_t leaving) const {
        double since_s = 0.0;
        if (signal_.crossings[leaving]) return since_s;  // people on foot clear while vehicles still go
        for (std::size_t link = 0; link < clocks_.size(); ++link) {
            const bool was_waited_for =
                std::ranges::any_of(opened, [&](std::size_t other) { return signal_.foes[link][other]; });
            if (link != leaving && was_waited_for && !signal_.crossings[link])
                since_s = std::max(since_s, clocks_[link].went_until_s);
        }
        return since_s;
    }
    void end_clearances(const std::vector<std::size_t>& opened) {
        for (std::size_t link = 0; link < clocks_.size(); ++link) {
            Clock& clock = clocks_[link];
            if (std::exchange(clock.clears, false))
                clock.red_s = now_s_ - std::max(clock.since_s, free_since_s(opened, link));
            clock.is_joined = clock.is_joined || clock.colour == 'y';
            const bool foe_opens =
                std::ranges::any_of(opened, [&](std::size_t other) { return signal_.foes[link][other]; });
            if (!clock.red_s || !foe_opens) continue;
            take_least(times_.red_s[link], *clock.red_s);
            clock.red_s.reset();
        }
    }

    const Signal& signal_;
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
    assert(signal.crossings.size() == signal.links.size());
    const std::vector<std::optional<double>> none(signal.links.size());
    ProgramTimes times{none, none, none};
    if (runs_side_by_side(signal)) {
        take_phases(signal, times);
    } else {
        Playback playback(signal, times);
        for (int cycle = 0; cycle < 2; ++cycle)
            for (const Phase& phase : signal.program)
                playback.show(phase);
        if (!signal.program.empty()) playback.show(signal.program.front());
    }
    limit_greens(signal, times);
    return times;
}

}  // namespace clearway::roads
