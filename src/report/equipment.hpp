#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "analysis/equipment.hpp"
#include "report/map.hpp"
#include "results/store.hpp"

namespace clearway::report {

/// A signal that was chosen. Gains are of fresh seeds, which had no part in the choice.
struct EquippedSignal {
    std::size_t number = 0;  ///< As `clearway scenario signals` counts, from 1.
    std::string signal;      ///< Its id; text from a file.
    std::string
        streets;  ///< Names of those that lead to it, with ` / ` between; text from a file. May be empty.
    /// Over those of better rank, s of EV time. The intervals of all ranks hold together (Bonferroni).
    analysis::MaybeEstimate gain;
    /// Over no signal equipped, with an interval that holds alone.
    analysis::MaybeEstimate so_far;
    analysis::MaybeEstimate others;          ///< Time loss of the others over no signal equipped, s each.
    analysis::MaybeEstimate chosen_by = {};  ///< `gain` in the runs that decided; too high by the choice.
};

/// A signal that could gain, by itself, in the runs that decided on the first one.
struct EquipCandidateFacts {
    std::size_t number = 0;
    std::string signal;
    std::string streets;           ///< As EquippedSignal has them.
    double trips = 0.0;            ///< Share of the emergency vehicles that pass it.
    analysis::MaybeEstimate gain;  ///< As analysis::EquipCandidate has it.
    bool left_race = false;
    std::optional<std::size_t> rank;      ///< From 1; nothing if it was not chosen.
    analysis::EquipLaterGain later = {};  ///< As analysis::EquipCandidate has it.
};

/// Two candidates that follow each other on the ways of emergency vehicles, tried together as the candidates
/// were alone.
struct EquipPairFacts {
    std::array<std::size_t, 2> numbers{};
    analysis::MaybeEstimate gain;  ///< A signal: half of what both gain.
    bool left_race = false;
    bool chosen = false;
    analysis::MaybeEstimate both_gain = {};  ///< Fresh: of both over the ranks before. Nothing if not chosen.
};

/// The signals on the ways of emergency vehicles: what no trip passes cannot gain.
struct SignalsMet {
    std::size_t trips = 0;
    std::size_t trips_with_signals = 0;
    std::size_t signals = 0;  ///< Sum over the trips of the different signals of each.

    void add(std::size_t signals_of_trip);
    /// Of the trips that pass a signal; nothing without trips.
    std::optional<double> share() const;
    /// Of signals over all trips; nothing without trips.
    std::optional<double> mean() const;
    std::string words() const;
};

/// Why a map leaves little to choose for that many signals of those that are passed; empty where it does not.
std::string small_map_words(std::size_t equipped, std::size_t passed, const SignalsMet& met);

/// An event of the fresh runs, number a run.
struct EquipEventFacts {
    std::string title;
    analysis::MaybeEstimate none;    ///< With no signal equipped.
    analysis::MaybeEstimate chosen;  ///< With all that were chosen.
    analysis::MaybeEstimate more;    ///< `chosen` less `none`, paired.
};

/// Runs whose times say more of the simulation than of signals.
struct UnsoundRuns {
    std::size_t runs = 0;           ///< All in traffic.
    std::size_t locked = 0;         ///< Of them, vehicles locked each other in them.
    std::size_t held_up = 0;        ///< Of these, locks held up an EV or one vehicle in a hundred.
    std::size_t lost_vehicles = 0;  ///< Emergency vehicles that did not arrive, in all.
    std::uint64_t collisions = 0, vehicles = 0;  ///< In all.

    bool say_little() const { return held_up + lost_vehicles > 0; }
    /// `vehicles locked each other in 4 of 30 runs, 2 held up by it, and 1 EV did not arrive`, or empty.
    std::string words() const;
};

/// Which signals to equip first, and what that is worth. Gains are restricted mean travel times of emergency
/// vehicles, paired by replication.
struct EquipmentFacts {
    std::string scenario;
    std::string title;
    std::string attribution;  ///< Credit that the map requires; may be empty.
    std::string assumptions;  ///< As simulated_sentence says.
    std::string condition;
    std::string command;
    std::vector<std::string> study = {};  ///< Words of a command that runs a study, but for what is equipped.
    std::vector<std::string> more_seeds = {};  ///< Words of the command, but for the number of seeds.
    std::uint64_t seed = 0;                    ///< Of the runs that decide.
    std::uint64_t fresh_seed = 0;              ///< Of those that estimate.
    std::uint32_t replications = 0;
    double step_length_s = 0.0;  ///< Of the simulation.
    double density = 1.0;        ///< `--density` of the command.
    /// What works where no signal is equipped: policies that ask vehicles alone.
    std::vector<std::string> other_parts = {};
    std::size_t budget = 0;
    SignalsMet met = {};
    double red_s = 0.0;          ///< Of a trip at red where nobody queues, by the programs.
    std::string outlook = {};    ///< What to expect of preemption before any run; text from a file.
    std::size_t signals = 0;     ///< Of the network.
    std::size_t not_passed = 0;  ///< Of them, no emergency vehicle passes in these replications.
    std::vector<std::string> equipped_today = {};  ///< Ids; texts from a file. Gains count from there.
    std::size_t equipped_and_passed = 0;           ///< Of them, emergency vehicles pass.
    std::size_t switched_off = 0;  ///< Passed, but `enabled` is 0 in the scenario's preemption parameters.
    std::size_t less_red = 0;      ///< Left out: emergency vehicles wait longer at red at the candidates.
    std::size_t runs = 0;          ///< Those that decide and those that estimate.
    std::vector<EquipCandidateFacts> candidates;  ///< By number.
    std::vector<EquipPairFacts> pairs;            ///< Empty where only one signal was wanted.
    // Of the fresh seeds.
    UnsoundRuns unsound = {};
    analysis::MaybeEstimate baseline_s;  ///< Time without the policy.
    analysis::MaybeEstimate none_s;      ///< With the policy, no signal equipped.
    analysis::MaybeEstimate all_s;       ///< With every signal equipped.
    analysis::MaybeEstimate alone_s;     ///< Of emergency vehicles alone on the road.
    analysis::MaybeEstimate all_gain;    ///< Every signal over none.
    analysis::MaybeEstimate all_others;
    std::vector<EquippedSignal> ranked;
    analysis::GainSplit split = {};            ///< With all that were chosen over none.
    std::vector<EquipEventFacts> events = {};  ///< Empty where none was chosen.
    analysis::EquipEnd end = analysis::EquipEnd::budget;
    std::optional<RoadMap> roads;  ///< Nothing where there is no map to draw.
};

/// The roads of a scenario of a run folder; nothing if the folder has none. Throws core::InputError for a
/// damaged file.
std::optional<RoadMap> road_map(const results::Store& store, const std::string& scenario);

/// Whether a gain above 0 is shown: an interval of at least `fewest_for_interval` pairs lies above it.
bool is_shown(const analysis::MaybeEstimate& gain);

/// Share of the gain of every signal that a signal and those before it bring. Nothing where that gain is not
/// shown.
std::optional<double> share_of_all(const EquipmentFacts& facts, const EquippedSignal& signal);
/// Rank with which that share reaches `share`; nothing if none does.
std::optional<std::size_t> rank_with_share(const EquipmentFacts& facts, double share);

/// Candidates and ranks for a terminal of 80 columns, and last the answer.
std::string equipment_text(const EquipmentFacts& facts);
/// All of it as one JSON object; null for missing values.
std::string equipment_json(const EquipmentFacts& facts);
/// The curve as CSV: one row for each number of equipped signals, 0 included, and one for all of them.
std::string equipment_csv(const EquipmentFacts& facts);
/// The candidates as CSV, the greatest gain first.
std::string candidates_csv(const EquipmentFacts& facts);
/// The pairs as CSV, the greatest gain first; only the names of the columns without pairs.
std::string pairs_csv(const EquipmentFacts& facts);
/// The curve of gain against number equipped with its intervals, and the gain of all: a stand-alone SVG.
std::string equipment_curve(const EquipmentFacts& facts);
/// The roads with the numbers of the chosen signals, the other candidates and those left out, as a
/// stand-alone SVG; empty without roads.
std::string equipment_map(const EquipmentFacts& facts);

/// One self-contained page with the answer, map, tables and curves.
void write_equipment_page(const EquipmentFacts& facts, std::ostream& page);

}  // namespace clearway::report
