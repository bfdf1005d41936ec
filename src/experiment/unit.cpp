#include "experiment/unit.hpp"

#include <fmt/format.h>

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

/// Settings of the loop have had a key of their own since before there were others.
constexpr const char* loop_component = "loop";
constexpr const char* loop_key = "loop_settings";

void write_settings(const core::Settings& settings, core::Json& object) {
    const core::Settings loop = core::settings_of(settings, loop_component);
    if (!loop.empty()) object[loop_key] = loop;
    core::Settings others;
    for (const auto& [name, value] : settings) {
        if (!name.starts_with(std::string(loop_component) + ".")) others.emplace(name, value);
    }
    if (!others.empty()) object["settings"] = others;
}

void read_settings(core::ObjectReader& reader, core::Settings& settings) {
    core::Settings loop;
    reader.read_if_there("settings", settings);
    reader.read_if_there(loop_key, loop);
    for (const auto& [name, value] : loop)
        settings.insert_or_assign(fmt::format("{}.{}", loop_component, name), value);
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
    object["parts"] = condition.policies;
    object["engine"] = experiment::name(condition.engine);
    object["safety_checks"] = experiment::name(condition.safety_checks);
    write_settings(condition.settings, object);
    if (!condition.model_file.empty())
        object["model"] = {{"file", condition.model_file}, {"hash", condition.model_hash}};
    if (condition.bluelight == traffic::BlueLight::on) object["bluelight"] = "on";
    return object;
}

ConditionSpec condition_from(const core::Json& object, const std::string& where,
                             std::vector<core::Problem>& problems) {
    ConditionSpec condition;
    core::ObjectReader reader(object, where, problems);
    reader.read("name", condition.name);
    reader.read("failure", condition.failure);
    reader.read("predictor", condition.predictor);
    reader.read("parts", condition.policies);
    reader.read_name("engine", condition.engine, engine_from);
    reader.read_name("safety_checks", condition.safety_checks, switch_from<traffic::SafetyChecks>);
    read_settings(reader, condition.settings);
    if (object.contains("model")) {
        core::ObjectReader model(reader.child("model", core::Json::value_t::object), where + ": model",
                                 problems);
        model.read("file", condition.model_file);
        model.read("hash", condition.model_hash);
    }
    if (object.contains("bluelight"))
        reader.read_name("bluelight", condition.bluelight, switch_from<traffic::BlueLight>);
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
