#include "experiment/job.hpp"

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "core/files.hpp"
#include "core/folder_name.hpp"
#include "core/json.hpp"
#include "experiment/condition_json.hpp"

namespace clearway::experiment {
namespace {

using core::Json;
using core::ObjectReader;

/// In the order of the alternatives of Job.
constexpr std::array kind_names = {"run", "dataset", "links", "attach"};
static_assert(kind_names.size() == std::variant_size_v<Job>);

/// One JSON object of a job file, and the list for its problems.
struct Source {
    const Json& object;
    std::string where;
    std::vector<core::Problem>& problems;

    Source member(const char* key, const Json& value) const { return {value, where + ": " + key, problems}; }
};

template <class Table, class Value>
void check_ranges(const Source& source, const Value& value) {
    core::for_each_field<Table>([&](const auto& field) {
        const auto& number = value.*field.member;
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(number)>>) {
            const auto as_double = static_cast<double>(number);
            if (as_double >= field.minimum && as_double <= field.maximum) return;
            source.problems.push_back({source.where + ": " + field.name,
                                       fmt::format("{} is out of range", number),
                                       fmt::format("{} to {}", field.minimum, field.maximum), ""});
        }
    });
}

/// Reads the members of a field table, which may be that of a base class, and checks their ranges.
template <class Table, class Value>
void read_table(const Source& source, ObjectReader& reader, Value& value) {
    const std::size_t before = source.problems.size();
    reader.read_fields<Table>(value);
    if (source.problems.size() == before) check_ranges<Table>(source, value);
}

void read_simulation(const Source& source, ObjectReader& reader, Simulation& simulation) {
    read_table<Simulation>(source, reader, simulation);
    core::check_folder_name(source.where + ": scenario", simulation.scenario, source.problems);
}

/// Reads an object that holds the members of a field table and nothing else.
template <class Value>
void read_object(const Source& source, Value& value) {
    ObjectReader reader(source.object, source.where, source.problems);
    read_table<Value>(source, reader, value);
    reader.refuse_others();
}

void write(Json& object, const RunJob& job) {
    core::write_fields<Simulation>(object, job);
    object["traffic_model"] = name(job.traffic_model);
    object["recording"] = core::name(job.recording);
    object["conditions"] = Json::array();
    for (const ConditionSpec& condition : job.conditions)
        object["conditions"].push_back(to_json(condition));
    object["wall_limit_s"] = job.limits.wall_s;
    object["memory_limit_mib"] = job.limits.memory_mib;
    object["output"] = job.output.string();
    if (job.window) core::write_fields(object["window"], *job.window);
    if (job.live) core::write_fields(object["live"], *job.live);
}

void read(const Source& source, ObjectReader& reader, RunJob& job) {
    read_simulation(source, reader, job);
    reader.read_name("traffic_model", job.traffic_model, core::value_from<TrafficModel>);
    reader.read("recording", job.recording);
    for (const Json& condition : reader.child("conditions", Json::value_t::array))
        job.conditions.push_back(condition_from(condition, source.where + ": conditions", source.problems));
    for (const ConditionSpec& condition : job.conditions) {
        if (process_of(condition).signal_penalty == process_of(job.conditions.front()).signal_penalty)
            continue;
        reader.problem("conditions", fmt::format("\"{}\" and \"{}\" need other penalties for signals",
                                                 job.conditions.front().name, condition.name));
        break;
    }
    reader.read("wall_limit_s", job.limits.wall_s);
    if (!(job.limits.wall_s > 0.0)) reader.problem("wall_limit_s", "is not above 0");
    reader.read("memory_limit_mib", job.limits.memory_mib);
    reader.read("output", job.output);
    const auto read_if_there = [&](const char* key, auto& member) {
        if (!source.object.contains(key)) return;
        read_object(source.member(key, reader.child(key, Json::value_t::object)), member.emplace());
    };
    read_if_there("window", job.window);
    read_if_there("live", job.live);
}

void write(Json& object, const DatasetJob& job) {
    core::write_fields<Simulation>(object, job);
    core::write_fields(object, job);
    if (!job.policies.empty()) object["policies"] = job.policies;
    if (!job.settings.empty()) object["settings"] = job.settings;
}

void read(const Source& source, ObjectReader& reader, DatasetJob& job) {
    read_simulation(source, reader, job);
    read_table<DatasetJob>(source, reader, job);
    if (source.object.contains("policies")) reader.read("policies", job.policies);
    if (source.object.contains("settings")) reader.read("settings", job.settings);
}

void write(Json& object, const LinkJob& job) {
    core::write_fields<Simulation>(object, job);
    core::write_fields(object, job);
    object["predictors"] = Json::array();
    for (const JudgedPredictor& predictor : job.predictors)
        core::write_fields(object["predictors"].emplace_back(), predictor);
}

void read(const Source& source, ObjectReader& reader, LinkJob& job) {
    read_simulation(source, reader, job);
    read_table<LinkJob>(source, reader, job);
    for (const Json& predictor : reader.child("predictors", Json::value_t::array))
        read_object(source.member("predictors", predictor), job.predictors.emplace_back());
}

void write(Json& object, const AttachJob& job) {
    core::write_fields(object, job);
    object["condition"] = to_json(job.condition);
}

void read(const Source& source, ObjectReader& reader, AttachJob& job) {
    read_table<AttachJob>(source, reader, job);
    job.condition = condition_from(reader.child("condition", Json::value_t::object),
                                   source.where + ": condition", source.problems);
}

/// An empty job of the kind `index`; of the first kind if the index is out of range.
template <std::size_t... indices>
Job empty_job(std::size_t index, std::index_sequence<indices...>) {
    Job job;
    ((index == indices ? (void)job.emplace<indices>() : (void)0), ...);
    return job;
}

}  // namespace

std::string to_json(const Job& job) {
    Json object;
    object["kind"] = kind_names.at(job.index());
    std::visit([&](const auto& each) { write(object, each); }, job);
    return core::to_text(object);
}

Job read_job(const std::filesystem::path& file) {
    const std::string where = file.string();
    const Json object = core::parse_object(core::read_file(file), where);
    std::vector<core::Problem> problems;
    ObjectReader reader(object, where, problems);
    std::string kind;
    reader.read("kind", kind);
    const auto found = std::ranges::find(kind_names, kind);
    if (found == kind_names.end()) {
        if (problems.empty())
            problems.push_back(
                {where + ": kind", "\"" + kind + "\" is not known", "run, dataset, links or attach", ""});
        throw core::InputError(std::move(problems));
    }
    Job job = empty_job(static_cast<std::size_t>(found - kind_names.begin()),
                        std::make_index_sequence<std::variant_size_v<Job>>());
    std::visit([&](auto& each) { read({object, where, problems}, reader, each); }, job);
    reader.refuse_others();
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return job;
}

}  // namespace clearway::experiment
