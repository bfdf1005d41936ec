#include "trace/recording.hpp"

#include <cassert>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/folder_name.hpp"
#include "core/json.hpp"
#include "core/read_failure.hpp"
#include "experiment/condition_json.hpp"
#include "experiment/settings.hpp"
#include "trace/detail/seal.hpp"
#include "trace/detail/step_tables.hpp"

namespace clearway::trace {
namespace {

using detail::TableReader;
using detail::TableWriter;

constexpr const char* hash_name = "content_hash";

/// Attributes of the file. A member that is an object becomes a group with attributes, or JSON.
core::Json to_json(const RecordingInfo& info) {
    core::Json object;
    object["format"] = detail::recording_format;
    object["scenario"] = info.key.scenario;
    object["condition"] = info.key.condition;
    object["replication"] = info.key.replication;
    object["condition_spec"] = experiment::to_json(info.condition);
    core::write_fields(object["provenance"], info.provenance);
    core::write_fields(object["settings"], info.settings);
    if (!info.incidents.empty()) object["incidents"] = info.incidents;
    return object;
}

RecordingInfo info_from(const core::Json& object, const std::string& where) {
    RecordingInfo info;
    std::vector<core::Problem> problems;
    core::ObjectReader reader(object, where, problems);
    using Type = core::Json::value_t;
    reader.read("scenario", info.key.scenario);
    reader.read("condition", info.key.condition);
    core::check_folder_name(where + ": scenario", info.key.scenario, problems);
    core::check_folder_name(where + ": condition", info.key.condition, problems);
    reader.read("replication", info.key.replication);
    info.condition =
        experiment::condition_from(reader.child("condition_spec", Type::object), where, problems);
    core::ObjectReader(reader.child("provenance", Type::object), where + ": provenance", problems)
        .read_fields(info.provenance);
    core::ObjectReader(reader.child("settings", Type::object), where + ": settings", problems)
        .read_fields(info.settings);
    if (object.contains("incidents")) {
        reader.read("incidents", info.incidents);
        incidents_from(info.incidents, where);
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return info;
}

constexpr std::array info_groups = {"provenance", "settings"};

void write_info(hid_t file, const RecordingInfo& info) {
    core::Json object = to_json(info);
    for (const char* const name : info_groups) {
        const detail::Handle group = detail::create_group(file, name);
        detail::write_attributes(group.get(), object[name]);
        object.erase(name);
    }
    detail::write_attributes(file, object);
}

/// Reads back what `to_json` made.
core::Json read_info(hid_t file, const std::string& where) {
    core::Json object = detail::read_attributes(file);
    for (const char* const name : info_groups) {
        const detail::Handle group(H5Gopen2(file, name, H5P_DEFAULT), H5Gclose);
        object[name] = detail::read_attributes(group.get());
    }
    object["condition_spec"] = core::parse_object(object.at("condition_spec").get<std::string>(), where);
    return object;
}

/// Hash of everything recorded; does not depend on chunks or compression.
template <class Tables>
std::string hash_of(const RecordingInfo& info, Tables& steps) {
    core::RunningHash hash;
    hash.add(core::to_text(to_json(info)));
    for (const detail::ColumnFile* const column : steps.file.columns())
        hash.add(column->path() + " " + column->digest() + "\n");
    steps.names.add_to(hash);
    return hash.digest();
}

}  // namespace

struct RecordingWriter::State {
    State(std::filesystem::path file, RecordingInfo recorded)
        : path(std::move(file)), part(path), info(std::move(recorded)), tables(part.aside()), steps(tables) {
        write_info(tables.id(), info);
    }

    void write(const RecordedStep& step) {
        assert(step.roster != nullptr && step.snapshot != nullptr && step.events != nullptr);
        assert(step.belief == nullptr || step.observation != nullptr);
        steps.roster.code(*step.roster);
        steps.snapshot.code(*step.snapshot, steps.known);
        steps.events.code(*step.events);
        if (step.observation != nullptr)
            steps.observation.code(*step.observation, *step.snapshot, *step.roster, *step.observation->roster,
                                   steps.known);
        if (step.belief != nullptr) steps.belief.code(*step.belief, *step.observation, steps.known);
        steps.leases.code(step.leases);
        tables.end_step();
    }

    void finish() {
        tables.finish();
        steps.names.write(tables);
        detail::write_attribute(tables.id(), hash_name, hash_of(info, steps));
        tables.close();
        part.write(detail::seal_of(part.aside()));
        part.commit();
    }

    std::filesystem::path path;
    core::AtomicFile part;
    RecordingInfo info;
    TableWriter tables;
    detail::StepTables<TableWriter> steps;
};

namespace {

/// Runs `action`. What HDF5 cannot write becomes core::EnvironmentError.
template <class Action>
void writing(const std::filesystem::path& file, const Action& action) {
    try {
        action();
    } catch (const detail::Hdf5Error& error) {
        if (error.reason() != 0) throw core::write_error(file, error.reason());
        throw core::EnvironmentError(fmt::format("{}: cannot write: {}", file.string(), error.what()));
    }
}

}  // namespace

RecordingWriter::RecordingWriter(const std::filesystem::path& file, const RecordingInfo& info) {
    writing(file, [&] { state_ = std::make_unique<State>(file, info); });
}
RecordingWriter::~RecordingWriter() = default;

void RecordingWriter::write(const RecordedStep& step) {
    if (step.belief != nullptr && step.observation == nullptr)
        throw std::invalid_argument("a belief is recorded without its observation");
    if (step.observation != nullptr && step.observation->roster == nullptr)
        throw std::invalid_argument("an observation is recorded without a roster");
    writing(state_->path, [&] { state_->write(step); });
}

void RecordingWriter::finish() {
    writing(state_->path, [&] { state_->finish(); });
}

struct RecordingReader::State {
    explicit State(const std::filesystem::path& file) : path(file), tables(file), steps(tables) {
        const core::Json object = read_info(tables.id(), path.string());
        info = info_from(object, path.string());
        hash = object.at(hash_name).get<std::string>();
        steps.names.read(tables);
    }

    RecordedStep read_step() {
        tables.start_step();
        RecordedStep step{&snapshot, &roster, &events, nullptr, nullptr, {}};
        steps.roster.code(roster);
        steps.snapshot.code(snapshot, steps.known);
        steps.events.code(events);
        if (steps.observation.is_there()) {
            steps.observation.code(observation, snapshot, roster, own_roster, steps.known);
            step.observation = &observation;
        }
        if (steps.belief.is_there()) {
            if (step.observation == nullptr) throw std::runtime_error("a belief has no observation");
            steps.belief.code(belief, observation, steps.known);
            step.belief = &belief;
        }
        steps.leases.code(leases);
        step.leases = leases;
        return step;
    }

    void finish() {
        tables.finish();
        if (hash_of(info, steps) != hash) throw std::runtime_error("it does not fit its hash");
        content_hash = hash;
    }

    std::filesystem::path path;
    TableReader tables;
    detail::StepTables<TableReader> steps;
    RecordingInfo info;
    std::string hash, content_hash;
    std::size_t steps_read = 0;
    truth::Snapshot snapshot;
    traffic::Roster roster, own_roster;
    truth::Events events;
    traffic::Observation observation;
    traffic::BelievedGraph belief;
    std::vector<traffic::Lease> leases;
};

namespace {

/// Runs `action`. What HDF5 or a table finds wrong becomes core::InputError: the file is damaged. Where the
/// system failed or memory was short, says so as core::fail_to_read does.
template <class Action>
auto reading(const std::filesystem::path& file, double time_s, const Action& action) {
    const auto damage = [&](const std::exception& error, const char* cure) {
        return core::InputError(
            {file.string(), fmt::format("is damaged after {} s: {}", time_s, error.what()), "", cure});
    };
    try {
        return action();
    } catch (const core::Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const detail::Hdf5Error& error) {
        if (error.reason() != 0) core::fail_to_read(file, error.reason());
        // The seal was right a moment ago, so this is seldom the file.
        throw damage(error,
                     "Give the same command again, in case the machine failed; if that does not help, record "
                     "the run again, or take the file from a backup");
    } catch (const std::exception& error) {
        throw damage(error, "Record the run again, or take the file from a backup");
    }
}

}  // namespace

void check_recording(const std::filesystem::path& file) {
    detail::check_seal(file);
}

RecordingReader::RecordingReader(const std::filesystem::path& file) {
    check_recording(file);
    state_ = reading(file, 0.0, [&] { return std::make_unique<State>(file); });
}
RecordingReader::~RecordingReader() = default;

const RecordingInfo& RecordingReader::info() const {
    return state_->info;
}

std::optional<RecordedStep> RecordingReader::next() {
    State& state = *state_;
    return reading(state.path, state.snapshot.time.value, [&]() -> std::optional<RecordedStep> {
        if (state.steps_read < state.steps.snapshot.steps()) {
            ++state.steps_read;
            return state.read_step();
        }
        if (state.content_hash.empty()) state.finish();
        return std::nullopt;
    });
}

const std::string& RecordingReader::content_hash() const {
    return state_->content_hash;
}

std::filesystem::path recording_file(const std::filesystem::path& run_folder, const experiment::RunKey& key) {
    return run_folder / "recordings" / key.scenario / key.condition /
           fmt::format("{:05}.h5", key.replication);
}

core::Seconds RecordedStep::time() const {
    assert(snapshot != nullptr);
    return snapshot->time;
}

experiment::LoopConfig loop_of(const RecordingInfo& info) {
    experiment::LoopConfig loop = experiment::loop_config(info.condition);
    loop.policy_period_s = info.settings.policy_period_s;
    loop.link_radius_m = info.settings.link_radius_m;
    return loop;
}

}  // namespace clearway::trace
