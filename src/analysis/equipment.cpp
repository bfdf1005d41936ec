#include "analysis/equipment.hpp"

#include <algorithm>
#include <limits>

namespace clearway::analysis {
namespace {

/// A signal that is not chosen yet.
struct Candidate {
    std::size_t number = 0;
    std::size_t measured_in = 0;  ///< Round of `gain`, from 1; 0: never.
    Values values;
    MaybeEstimate gain;

    /// Without a measurement it may gain anything; measured without a pair, nothing is known in its favour.
    double last_gain() const {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        if (measured_in == 0) return infinite;
        return gain ? gain->mean : -infinite;
    }
};

bool has_effect(const MaybeEstimate& gain) {
    return gain && gain->interval && gain->interval->low > 0.0;
}

class Greedy {
  public:
    Greedy(const Values& none, const EquipConfig& config, const MeasureSets& measure)
        : none_(none), present_(none), config_(config), measure_(measure), open_(config.candidates) {
        for (std::size_t number = 0; number < open_.size(); ++number)
            open_[number].number = number;
    }

    EquipPlan run() {
        while (plan_.steps.size() < config_.budget) {
            if (open_.empty()) {
                plan_.end = EquipEnd::exhausted;
                return plan_;
            }
            const std::size_t best = next();
            const EquipStep step{open_[best].number, open_[best].gain, gain_over(none_, open_[best].values)};
            if (!has_effect(step.gain)) {
                plan_.end = EquipEnd::no_effect;
                plan_.next = step;
                return plan_;
            }
            choose(best, step);
        }
        plan_.end = EquipEnd::budget;
        return plan_;
    }

  private:
    std::size_t round() const { return plan_.steps.size() + 1; }

    MaybeEstimate gain_over(const Values& before, const Values& after) const {
        return estimate_paired(before, after, MetricKind::quantity, config_.level);
    }

    /// Place of the candidate with the greatest last gain; of equal ones the first.
    std::size_t greatest() const {
        const auto found = std::ranges::max_element(open_, {}, &Candidate::last_gain);
        return static_cast<std::size_t>(found - open_.begin());
    }

    /// The best candidate of this round, measured in this round.
    std::size_t next() {
        if (round() == 1 || config_.search == Search::thorough) {
            std::vector<std::size_t> all(open_.size());
            for (std::size_t place = 0; place < all.size(); ++place)
                all[place] = place;
            measure(all);
        }
        std::size_t best = greatest();
        while (open_[best].measured_in != round()) {
            measure({best});
            best = greatest();
        }
        return best;
    }

    void measure(const std::vector<std::size_t>& places) {
        std::vector<SignalSet> sets;
        for (const std::size_t place : places) {
            sets.push_back(chosen_);
            sets.back().push_back(open_[place].number);
        }
        std::vector<Values> values = measure_(sets);
        plan_.measured += sets.size();
        for (std::size_t i = 0; i < places.size(); ++i) {
            Candidate& candidate = open_[places[i]];
            candidate.measured_in = round();
            candidate.values = std::move(values.at(i));
            candidate.gain = gain_over(present_, candidate.values);
        }
    }

    void choose(std::size_t place, const EquipStep& step) {
        present_ = open_[place].values;
        chosen_.push_back(step.candidate);
        open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(place));
        plan_.steps.push_back(step);
    }

    const Values& none_;
    Values present_;
    const EquipConfig& config_;
    const MeasureSets& measure_;
    std::vector<Candidate> open_;  ///< By number.
    SignalSet chosen_;
    EquipPlan plan_;
};

}  // namespace

EquipPlan equip_greedily(const Values& none, const EquipConfig& config, const MeasureSets& measure) {
    return Greedy(none, config, measure).run();
}

}  // namespace clearway::analysis
