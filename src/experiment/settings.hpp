#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/settings.hpp"
#include "experiment/condition.hpp"
#include "experiment/loop_config.hpp"
#include "traffic/registry.hpp"

// The settings of a condition are known by their names and texts. A file that needs the numbers of a
// part includes that part.
namespace clearway::actuation {
struct ActuatorConfig;
}
namespace clearway::drivers {
struct RequestConfig;
}
namespace clearway::traffic {
struct PrivilegeConfig;
struct SirenConfig;
}  // namespace clearway::traffic

namespace clearway::experiment {

/// Something with settings that a condition may change: a policy, a predictor, the actuation, ...
struct Component {
    std::string name;     ///< `preempt_signals`.
    std::string summary;  ///< One line.
    core::SettingsTable table;
};

/// Every component: `loop`, `failure`, the predictors, the policies, `actuation`,
/// `siren`, `requests`, `privilege`.
const std::vector<Component>& components();

/// Names of the components that a condition has, in the order of `components`; then its parts in Python.
std::vector<std::string> components_of(const ConditionSpec& condition);

/// Names of the policies that a condition consists of, those that combine others taken apart: as leases name
/// them.
std::vector<std::string> parts_of(const ConditionSpec& condition);

/// `preempt_signals.lead_s` parted at its dot; the component is empty without one.
std::pair<std::string, std::string> parted(const std::string& name);

/// Sets `component.name` to a value given as text, without checks: see `check_settings`. A setting of the
/// failure is added to the condition's `failure`, replacing an earlier value.
void set(ConditionSpec& condition, const std::string& name, const std::string& value);

/// Sets the model of a condition from a file: its absolute path and the hash of its content. Throws
/// core::InputError, naming `where`, for a file that cannot be read.
void set_model(ConditionSpec& condition, const std::string& file, const std::string& where);

/// The model file of a condition; empty for the built-in model. Throws core::InputError when the file is gone
/// or has changed since it was given.
std::string checked_model(const ConditionSpec& condition);

/// Whether a policy of the condition acts on believed links, and not on believed places alone.
bool reads_links(const ConditionSpec& condition);

/// Whether a component is part of the environment, the same in a condition and its baseline: `siren`,
/// `privilege`.
bool is_environment(const std::string& component);

/// Everything wrong with the settings and the model of a condition: an unknown name, a component that the
/// condition does not have, a value of the wrong type or out of range, a model that its predictor does not
/// take. `where` precedes the names in messages. The names of failures, predictors and policies themselves
/// are not checked, nor are settings of classes in Python: python::check_part does it.
std::vector<core::Problem> check_settings(const ConditionSpec& condition, const std::string& where);

/// Those of parts_of that have this trait.
std::vector<std::string> policies_with(const ConditionSpec& condition, traffic::Trait trait);

/// What is wrong with one setting, regardless of the condition; empty if some condition may have it. Any
/// setting of `parts`, names of parts in Python, is one.
std::vector<core::Problem> check_setting(const std::string& name, const std::string& value,
                                         const std::string& where,
                                         const std::vector<std::string>& parts = {});

/// `preempt_signals.lead_s=12 model=net.weights`; empty when a condition has neither settings nor a model.
std::string settings_text(const ConditionSpec& condition);

/// A name that describes a condition, usable for a folder: `corridor_B10_graphsage`, `corridor_lead_s_12`.
std::string described_name(const ConditionSpec& condition);

// The configurations of a condition. Each throws core::InputError for unknown settings.

/// Settings of its predictor, without their prefix.
core::Settings predictor_settings(const ConditionSpec& condition);
/// Settings of the condition applied to `usual`, which may come from a recording.
LoopConfig loop_config(const ConditionSpec& condition, const LoopConfig& usual = {});
/// Settings of the condition applied to `usual`.
actuation::ActuatorConfig actuator_config(const ConditionSpec& condition, actuation::ActuatorConfig usual);
/// Settings of the condition applied to what the scenario says.
traffic::SirenConfig siren_config(const ConditionSpec& condition, const traffic::SirenConfig& of_scenario);

/// Which human drivers do what a policy asks.
drivers::RequestConfig request_config(const ConditionSpec& condition);
/// Settings of the condition applied to what the scenario says.
traffic::PrivilegeConfig privilege_config(const ConditionSpec& condition,
                                          const traffic::PrivilegeConfig& of_scenario);

}  // namespace clearway::experiment
