#include "analysis/equipment.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace clearway::analysis {
namespace {

/// A signal that is not chosen yet, or two that are chosen together.
struct Candidate {
    SignalSet signals;
    std::size_t measured_in = 0;  ///< Place of `gain`, from 1; 0: never.
    bool left_race = false;       ///< Of that place.
    Values values = {};  ///< Of a pair, with half of what it gains, so that it races by its gain a signal.
    MaybeEstimate gain = std::nullopt;  ///< A signal.

    /// What it may gain at `place`, s.
    double promise(std::size_t place) const {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        if (measured_in == 0) return infinite;
        if (measured_in == place && left_race) return -infinite;
        return gain ? gain->mean : -infinite;
    }
};

class Greedy {
  public:
    Greedy(const EquipConfig& config, const MeasureSets& measure) : config_(config), measure_(measure) {
        for (std::size_t number = 0; number < config.candidates; ++number)
            open_.push_back({.signals = {number}});
        for (const auto& pair : config.pairs)
            open_.push_back({.signals = {pair.begin(), pair.end()}});
        close_what_cannot_be();
    }

    EquipPlan run() {
        while (plan_.steps.size() < config_.budget) {
            if (open_.empty()) {
                plan_.end = EquipEnd::exhausted;
                return plan_;
            }
            const Candidate& best = open_[next()];
            if (!best.gain || best.gain->mean <= 0.0) {
                plan_.end = EquipEnd::no_gain;
                plan_.next = EquipStep{best.signals.front(), best.gain};
                return plan_;
            }
            choose(best.signals, best.gain);
        }
        plan_.end = EquipEnd::budget;
        return plan_;
    }

  private:
    std::size_t place() const { return plan_.steps.size() + 1; }

    void choose(const SignalSet& signals, const MaybeEstimate& gain) {
        for (const std::size_t signal : signals) {
            chosen_.push_back(signal);
            plan_.steps.push_back({signal, gain});
            if (signals.size() == 2) plan_.steps.back().partner = signals[signal == signals.front() ? 1 : 0];
        }
        close_what_cannot_be();
    }

    /// What has a chosen signal or more signals than places are left is no candidate any more.
    void close_what_cannot_be() {
        const std::size_t left = config_.budget - plan_.steps.size();
        std::erase_if(open_, [&](const Candidate& candidate) {
            return candidate.signals.size() > left ||
                   std::ranges::find_first_of(candidate.signals, chosen_) != candidate.signals.end();
        });
    }

    MaybeEstimate gain_of(const Values& values, double level) const {
        return estimate_paired(present_, values, MetricKind::quantity, level);
    }

    /// Index of the candidate that promises most; of equal ones the first.
    std::size_t greatest() const {
        const auto found = std::ranges::max_element(
            open_, {}, [&](const Candidate& candidate) { return candidate.promise(place()); });
        return static_cast<std::size_t>(found - open_.begin());
    }

    /// The best candidate for this place, measured for it.
    std::size_t next() {
        if (place() == 1 || config_.search == Search::thorough) race();
        if (place() == 1) describe();
        std::size_t best = greatest();
        while (open_[best].measured_in != place()) {
            measure({best}, config_.replications);
            best = greatest();
        }
        return best;
    }

    void race() {
        const std::vector<std::size_t> looks = equip_looks(config_.replications);
        std::vector<std::size_t> racing(open_.size());
        std::iota(racing.begin(), racing.end(), std::size_t{0});
        for (const std::size_t look : looks) {
            measure(racing, look);
            if (look == looks.back()) return;
            const auto tests = static_cast<double>((open_.size() - 1) * (looks.size() - 1));
            drop_shown_worse(racing, 2.0 * (1.0 - config_.level) / tests);
        }
    }

    /// `risk`: of a two-sided interval, of which one side counts.
    void drop_shown_worse(std::vector<std::size_t>& racing, double risk) {
        const std::vector<std::size_t> before = racing;
        const auto is_worse = [&](std::size_t one) {
            return std::ranges::any_of(before, [&](std::size_t other) {
                if (one == other) return false;
                const MaybeEstimate more =
                    estimate_paired(open_[one].values, open_[other].values, MetricKind::quantity, 1.0 - risk);
                return shown_interval(more) != nullptr && more->interval->low > 0.0;
            });
        };
        std::erase_if(racing, [&](std::size_t one) {
            open_[one].left_race = is_worse(one);
            return open_[one].left_race;
        });
    }

    void measure(const std::vector<std::size_t>& rows, std::size_t replications) {
        std::vector<SignalSet> sets = {chosen_};
        for (const std::size_t row : rows) {
            const SignalSet& more = open_[row].signals;
            sets.push_back(chosen_);
            sets.back().insert(sets.back().end(), more.begin(), more.end());
        }
        std::vector<Values> values = measure_(sets, replications);
        present_ = std::move(values.front());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            Candidate& candidate = open_[rows[i]];
            candidate.measured_in = place();
            candidate.left_race = false;
            candidate.values = std::move(values.at(i + 1));
            if (candidate.signals.size() > 1) halve_gain(candidate.values);
            candidate.gain = gain_of(candidate.values, config_.level);
            if (place() > 1 && candidate.signals.size() == 1)
                plan_.candidates.at(candidate.signals.front()).later = {plan_.steps.size(), candidate.gain};
        }
    }

    void halve_gain(Values& values) const {
        for (std::size_t at = 0; at < values.size(); ++at)
            if (values[at] && present_.at(at)) values[at] = 0.5 * (*values[at] + *present_[at]);
    }

    void describe() {
        const double together = 1.0 - (1.0 - config_.level) / static_cast<double>(open_.size());
        for (const Candidate& candidate : open_) {
            Values values = candidate.values;
            values.resize(present_.size());
            auto& described = candidate.signals.size() == 1 ? plan_.candidates : plan_.pairs;
            described.push_back({gain_of(values, together), candidate.left_race});
        }
    }

    const EquipConfig& config_;
    const MeasureSets& measure_;
    Values present_;               ///< With the chosen signals.
    std::vector<Candidate> open_;  ///< By number, then pairs.
    SignalSet chosen_;
    EquipPlan plan_;
};

}  // namespace

std::vector<std::size_t> equip_looks(std::size_t replications) {
    std::vector<std::size_t> looks;
    for (std::size_t look = fewest_for_interval; look < replications; look *= 2)
        looks.push_back(look);
    looks.push_back(replications);
    return looks;
}

EquipPlan equip_greedily(const EquipConfig& config, const MeasureSets& measure) {
    return Greedy(config, measure).run();
}

GainSplit split_gain(const std::vector<TripTimes>& before, const std::vector<TripTimes>& after,
                     const std::vector<std::set<std::string>>& passing) {
    struct Group {
        std::vector<double> gains_s, trips;  // by replication
    };
    GainSplit split;
    Group pass, others;
    for (std::size_t replication = 0; replication < before.size(); ++replication) {
        for (Group* const group : {&pass, &others}) {
            group->gains_s.push_back(0.0);
            group->trips.push_back(0.0);
        }
        for (const auto& [id, time_s] : before[replication]) {
            const auto same = after.at(replication).find(id);
            if (same == after[replication].end()) continue;
            const bool is_passing = passing.at(replication).contains(id);
            Group& group = is_passing ? pass : others;
            group.gains_s.back() += time_s - same->second;
            group.trips.back() += 1.0;
            ++split.trips;
            split.passing += is_passing ? 1 : 0;
        }
    }
    split.passing_gain = estimate_ratio(pass.gains_s, pass.trips);
    split.other_gain = estimate_ratio(others.gains_s, others.trips);
    return split;
}

}  // namespace clearway::analysis
