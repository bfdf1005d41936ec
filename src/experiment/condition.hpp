#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "core/settings.hpp"
#include "core/spellings.hpp"
#include "traffic/command.hpp"
#include "traffic/departure.hpp"

namespace clearway::experiment {

/// SUMO options that a whole process shares. Conditions of one process may differ in everything else.
enum class TrafficModel : std::uint8_t {
    standard,
    sublane,    ///< --lateral-resolution.
    free_flow,  ///< Each emergency vehicle alone on the road with every signal open.
};

constexpr core::Spellings<TrafficModel, 3> spellings(TrafficModel) {
    return {{{TrafficModel::standard, "standard"},
             {TrafficModel::sublane, "sublane"},
             {TrafficModel::free_flow, "free_flow"}}};
}
using core::name;

/// Which station answers a call: the nearest one in a straight line, by free flow, by the times that the
/// condition's sensors and predictor let believe, or by the same of true vehicles.
enum class Dispatch : std::uint8_t { free_flow, straight_line, believed, true_times };
constexpr core::Spellings<Dispatch, 4> spellings(Dispatch) {
    return {{{Dispatch::free_flow, "free_flow"},
             {Dispatch::straight_line, "straight_line"},
             {Dispatch::believed, "believed"},
             {Dispatch::true_times, "true_times"}}};
}

/// A named combination of failure, predictor and policies, and the settings that differ from their defaults.
struct ConditionSpec {
    std::string name;
    std::string failure = "perfect";  ///< As failures::failure_from reads it: perfect, B10, ...
    std::string predictor = "none";
    std::vector<std::string> policies;  ///< Applied in this order; empty: the car-following model alone.
    TrafficModel traffic_model = TrafficModel::standard;
    traffic::SafetyChecks safety_checks = traffic::SafetyChecks::on;
    /// `preempt_signals.lead_s` -> `12`, as experiment/settings.hpp knows them.
    core::Settings settings = {};
    std::string model_file = {};  ///< Absolute path, for a learned predictor; empty: the built-in model.
    std::string model_hash = {};  ///< Hash of that file's content: a changed model makes another condition.
    /// Factors of the study from which it was made, `failure.dark_share` -> `0.3`; they repeat what other
    /// members hold.
    core::Settings factors = {};
    /// SUMO's own rescue lane model (blue light device).
    traffic::BlueLight bluelight = traffic::BlueLight::off;
    /// Period of SUMO's rerouting device on true times, s; 0: none.
    double rerouting_s = 0.0;
    /// What that device adds for signals, as share of their mean wait (SUMO's weights.tls-penalty).
    double rerouting_signal_penalty = 0.0;
    Dispatch dispatch = Dispatch::free_flow;  ///< Where the scenario has calls.

    /// Whether anything is done for emergency vehicles. Otherwise the condition can be a baseline.
    bool acts() const {
        return !policies.empty() || bluelight == traffic::BlueLight::on || rerouting_s > 0.0 ||
               dispatch != Dispatch::free_flow;
    }

    bool operator==(const ConditionSpec& other) const;  ///< Equal after `without_folders`.

    /// Keys of `[[condition]]` in study files and of `condition.` factors, and of stored conditions. `name`,
    /// `policy` (a list), `set` and `model` stand beside them.
    static constexpr void fields(const auto& table) {
        using S = ConditionSpec;
        using core::Field;
        table(
            Field{"failure", "", &S::failure, 0, 0, "How sensors fail: a preset, fields or both", "perfect"},
            Field{"predictor", "", &S::predictor, 0, 0, "How the graph is repaired", "none"},
            Field{"traffic_model", "", &S::traffic_model, 0, 0, "SUMO's lateral model", "standard"},
            Field{"safety_checks", "", &S::safety_checks, 0, 0,
                  "SUMO's own checks of commanded speeds and lane changes", "on"},
            Field{"bluelight", "", &S::bluelight, 0, 0, "SUMO's device.bluelight on every EV", "off"},
            Field{"rerouting_s", "s", &S::rerouting_s, 0.0, 3600.0,
                  "Period of SUMO's device.rerouting on every EV, which knows the true times; 0: none", "0"},
            Field{"rerouting_signal_penalty", "1", &S::rerouting_signal_penalty, 0.0, 100.0,
                  "SUMO's weights.tls-penalty for that device: of the mean wait at a signal by its program, "
                  "the share that a way through it takes at least; 0: none",
                  "0"},
            Field{"dispatch", "", &S::dispatch, 0, 0, "Which station answers a call", "free_flow"});
    }
};

/// What all conditions of a worker process share: options that SUMO reads when it starts.
struct ProcessOptions {
    TrafficModel traffic_model = TrafficModel::standard;
    double signal_penalty = 0.0;  ///< ConditionSpec::rerouting_signal_penalty.

    bool operator==(const ProcessOptions&) const = default;
};
ProcessOptions process_of(const ConditionSpec& condition);
/// `standard`, `standard-penalty-1`: for names of files.
std::string to_text(const ProcessOptions& process);

/// The condition with its model and its parts in Python named without their folders, which do not count:
/// files of the same names and contents elsewhere make the same condition.
ConditionSpec without_folders(ConditionSpec condition);

}  // namespace clearway::experiment
