#include "experiment/unit.hpp"

#include "core/files.hpp"
#include "core/json.hpp"
#include "experiment/condition_json.hpp"

namespace clearway::experiment {
namespace {

std::string_view text_of(StepRecording recording) {
    return recording == StepRecording::on ? "on" : "off";
}

std::optional<StepRecording> recording_from(std::string_view word) {
    if (word == "on") return StepRecording::on;
    if (word == "off") return StepRecording::off;
    return std::nullopt;
}

core::Json to_json(const WindowSpec& window) {
    core::Json object;
    object["delay_s"] = window.delay_s;
    object["settings_file"] = window.settings_file.string();
    object["program"] = window.program;
    return object;
}

WindowSpec window_from(const core::Json& object, const std::string& where,
                       std::vector<core::Problem>& problems) {
    WindowSpec window;
    std::string settings_file;
    core::ObjectReader reader(object, where + ": window", problems);
    reader.read("delay_s", window.delay_s);
    reader.read("settings_file", settings_file);
    reader.read("program", window.program);
    window.settings_file = settings_file;
    return window;
}

}  // namespace

std::string_view name(Engine engine) {
    switch (engine) {
        case Engine::standard:
            return "standard";
        case Engine::sublane:
            return "sublane";
        case Engine::solo:
            return "solo";
    }
    return "";
}

std::optional<Engine> engine_from(std::string_view word) {
    for (const Engine engine : {Engine::standard, Engine::sublane, Engine::solo}) {
        if (name(engine) == word) return engine;
    }
    return std::nullopt;
}

std::string_view name(traffic::SafetyChecks checks) {
    return checks == traffic::SafetyChecks::on ? "on" : "off";
}

core::Json to_json(const ConditionSpec& condition) {
    core::Json object;
    object["name"] = condition.name;
    object["failure"] = condition.failure;
    object["predictor"] = condition.predictor;
    object["parts"] = condition.parts;
    object["engine"] = experiment::name(condition.engine);
    object["safety_checks"] = experiment::name(condition.safety_checks);
    if (!condition.loop_settings.empty()) object["loop_settings"] = condition.loop_settings;
    if (condition.bluelight == traffic::BlueLight::on) object["bluelight"] = "on";
    if (!condition.factors.empty()) object["factors"] = condition.factors;
    return object;
}

ConditionSpec condition_from(const core::Json& object, const std::string& where,
                             std::vector<core::Problem>& problems) {
    ConditionSpec condition;
    core::ObjectReader reader(object, where, problems);
    reader.read("name", condition.name);
    reader.read("failure", condition.failure);
    reader.read("predictor", condition.predictor);
    reader.read("parts", condition.parts);
    reader.read_name("engine", condition.engine, engine_from);
    reader.read_name("safety_checks", condition.safety_checks, switch_from<traffic::SafetyChecks>);
    reader.read_if_there("loop_settings", condition.loop_settings);
    if (object.contains("bluelight"))
        reader.read_name("bluelight", condition.bluelight, switch_from<traffic::BlueLight>);
    reader.read_if_there("factors", condition.factors);
    return condition;
}

std::string to_json(const UnitSpec& unit) {
    core::Json object;
    object["scenario"] = unit.scenario;
    object["scenario_file"] = unit.scenario_file.string();
    object["network_folder"] = unit.network_folder.string();
    object["study_seed"] = unit.study_seed;
    object["replication"] = unit.replication;
    object["engine"] = name(unit.engine);
    object["recording"] = text_of(unit.recording);
    object["conditions"] = core::Json::array();
    for (const ConditionSpec& condition : unit.conditions)
        object["conditions"].push_back(to_json(condition));
    object["wall_limit_s"] = unit.limits.wall_s;
    object["memory_limit_mib"] = unit.limits.memory_mib;
    object["output"] = unit.output.string();
    if (unit.window) object["window"] = to_json(*unit.window);
    return core::to_text(object);
}

UnitSpec read_unit(const std::filesystem::path& file) {
    const std::string where = file.string();
    const core::Json object = core::parse_object(core::read_file(file), where);
    UnitSpec unit;
    std::vector<core::Problem> problems;
    core::ObjectReader reader(object, where, problems);
    std::string scenario_file;
    std::string network_folder;
    std::string output;
    reader.read("scenario", unit.scenario);
    reader.read("scenario_file", scenario_file);
    reader.read("network_folder", network_folder);
    reader.read("study_seed", unit.study_seed);
    reader.read("replication", unit.replication);
    reader.read_name("engine", unit.engine, engine_from);
    reader.read_name("recording", unit.recording, recording_from);
    for (const core::Json& condition : reader.child("conditions", core::Json::value_t::array))
        unit.conditions.push_back(condition_from(condition, where + ": conditions", problems));
    reader.read("wall_limit_s", unit.limits.wall_s);
    reader.read("memory_limit_mib", unit.limits.memory_mib);
    reader.read("output", output);
    if (object.contains("window"))
        unit.window = window_from(reader.child("window", core::Json::value_t::object), where, problems);
    if (!problems.empty()) throw core::InputError(problems);
    unit.scenario_file = scenario_file;
    unit.network_folder = network_folder;
    unit.output = output;
    return unit;
}

}  // namespace clearway::experiment
