#include "roads/own_clearance.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <utility>

#include "roads/link_green.hpp"
#include "traffic/signal.hpp"

namespace clearway::roads {
namespace {

bool is_yellow_in(const Phase& phase, std::size_t link) {
    return link < phase.state.size() && traffic::is_yellow(phase.state[link]);
}

/// Whether vehicles go in `phase` for whom links must wait that open in `later`.
bool keeps_waiting(const Signal& signal, const Phase& phase, const Phase& later) {
    for (std::size_t link = 0; link < signal.links.size(); ++link) {
        if (!gives_green(phase, link) || signal.crossings[link]) continue;
        for (std::size_t other = 0; other < signal.links.size(); ++other) {
            const bool opens = gives_green(later, other) && !gives_green(phase, other);
            if (opens && signal.foes[link][other]) return true;
        }
    }
    return false;
}

/// A program, read round and round from one of its phases.
class Cycle {
  public:
    Cycle(const std::vector<Phase>& program, std::size_t start) : program_(program), at_(start) {
        assert(!program.empty());
    }
    const Phase& phase() const { return program_[at_ % program_.size()]; }
    double advance() { return program_[at_++ % program_.size()].duration_s; }

  private:
    const std::vector<Phase>& program_;
    std::size_t at_;
};

/// Which links get green on the way from `before` to `later`.
enum class Opening : std::uint8_t { none, others, foe };

Opening opening(const Signal& signal, std::size_t link, const Phase& before, const Phase& later) {
    Opening found = Opening::none;
    for (std::size_t other = 0; other < signal.links.size(); ++other) {
        if (!gives_green(later, other) || gives_green(before, other)) continue;
        if (signal.foes[link][other]) return Opening::foe;
        found = Opening::others;
    }
    return found;
}

struct AfterGreen {
    OwnClearance own;
    bool foe_opens = false;
};

/// What follows the green of `link` in phase `row`. People on foot clear while vehicles beside them still go.
/// A phase in which others go is no clearance, however long it keeps those waiting that conflict with the
/// link.
AfterGreen after_green(const Signal& signal, std::size_t link, std::size_t row) {
    const Phase& green = signal.program[row];
    Cycle cycle(signal.program, row + 1);
    OwnClearance own{green.yellow_s, green.red_s};
    std::size_t left = signal.program.size();
    for (; left > 0 && is_yellow_in(cycle.phase(), link); --left)
        own.yellow_s += cycle.advance();
    bool clears = true;
    double cleared_s = green.red_s;
    std::vector<std::pair<const Phase*, double>> since;
    for (; left > 0 && !gives_green(cycle.phase(), link); --left) {
        const Phase& phase = cycle.phase();
        const Opening now = opening(signal, link, green, phase);
        if (now != Opening::none && clears) {
            for (const auto& [earlier, lasting_s] : since) {
                const bool waits = !signal.crossings[link] && keeps_waiting(signal, *earlier, phase);
                cleared_s = waits ? green.red_s : cleared_s + lasting_s;
            }
        }
        if (now == Opening::foe) return {{own.yellow_s, cleared_s}, true};
        clears = clears && now == Opening::none;
        since.emplace_back(&phase, cycle.advance());
    }
    return {own, false};
}

}  // namespace

std::vector<OwnClearance> own_clearances(const Signal& signal) {
    assert(signal.crossings.size() == signal.links.size());
    std::vector<OwnClearance> all(signal.links.size());
    const std::size_t rows = signal.program.size();
    for (std::size_t link = 0; link < signal.links.size(); ++link) {
        bool has_red = false;
        for (std::size_t row = 0; row < rows; ++row) {
            const bool ends = gives_green(signal.program[row], link) &&
                              !gives_green(signal.program[(row + 1) % rows], link);
            if (!ends) continue;
            const AfterGreen after = after_green(signal, link, row);
            all[link].yellow_s = std::max(all[link].yellow_s, after.own.yellow_s);
            if (has_red && !after.foe_opens) continue;
            all[link].red_s = has_red ? std::min(all[link].red_s, after.own.red_s) : after.own.red_s;
            has_red = after.foe_opens;
        }
    }
    return all;
}

}  // namespace clearway::roads
