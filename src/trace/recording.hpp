#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/fields.hpp"
#include "core/units.hpp"
#include "experiment/condition.hpp"
#include "experiment/loop_config.hpp"
#include "experiment/run_key.hpp"
#include "traffic/belief.hpp"
#include "traffic/command.hpp"
#include "traffic/incident.hpp"
#include "traffic/lease.hpp"
#include "traffic/observation.hpp"

// A file that reads the truth of a recording includes it; one that only names recordings does not see it.
namespace clearway::truth {
struct Events;
struct Snapshot;
}  // namespace clearway::truth

namespace clearway::trace {

/// The settings of a run that are needed to read and replay its recording.
struct RecordingSettings {
    double step_length_s = 0.0;
    double policy_period_s = 0.0;
    double link_radius_m = 0.0;
    std::string network_hash;

    bool operator==(const RecordingSettings&) const = default;

    static constexpr void fields(const auto& table) {
        using S = RecordingSettings;
        using core::Field;
        table(
            Field{"step_length_s", "s", &S::step_length_s, 0.01, 1.0, "Step of the simulation", ""},
            Field{"policy_period_s", "s", &S::policy_period_s, 0.1, 10.0, "Time between two decisions", ""},
            Field{"link_radius_m", "m", &S::link_radius_m, 1.0, 1000.0,
                  "Vehicles nearer than this are linked", ""},
            Field{
                "network_hash", "", &S::network_hash, 0, 0,
                "core::content_hash of the network file, to whose lanes, edges and signals the indices refer",
                ""});
    }
};

/// What was recorded: run, condition, provenance and settings.
struct RecordingInfo {
    experiment::RunKey key;
    experiment::ConditionSpec condition;
    experiment::Provenance provenance;  ///< Without the trace hash, which is only known at the end.
    RecordingSettings settings;
    std::string incidents = {};  ///< Text of `incidents_text`; empty: none.

    bool operator==(const RecordingInfo&) const = default;
};

/// Incidents as JSON, and back. Throws core::InputError naming `where` for text that is none.
std::string incidents_text(std::span<const traffic::Incident> incidents);
std::vector<traffic::Incident> incidents_from(const std::string& text, const std::string& where);

/// The closed loop of the run: what its condition sets, with the recorded period and radius.
experiment::LoopConfig loop_of(const RecordingInfo& info);

/// The state at the end of a step.
struct RecordedStep {
    core::Seconds time() const;  ///< Of the snapshot.

    const truth::Snapshot* snapshot = nullptr;  ///< Never null.
    const traffic::Roster* roster = nullptr;    ///< The true one; never null.
    const truth::Events* events = nullptr;      ///< Never null.
    /// Null unless a report arrived or a decision was made. Its roster is `roster`, or the sensor's own.
    const traffic::Observation* observation = nullptr;
    const traffic::BelievedGraph* belief = nullptr;  ///< Null unless a decision was made.
    std::span<const traffic::Lease> leases = {};
    std::span<const traffic::Command> commands = {};  ///< What the leases in force led to; not recorded.
};

/// Writes a recording (docs/reference/recording.md) step by step. Memory grows only by one entry per vehicle
/// and route. Reading returns every member bit for bit. The file appears, complete, after `finish`; without
/// it nothing is left. Throws core::EnvironmentError; std::invalid_argument for a step that breaks the rules
/// of RecordedStep and for rows that are not ordered by key.
class RecordingWriter {
  public:
    RecordingWriter(const std::filesystem::path& file, const RecordingInfo& info);
    ~RecordingWriter();
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    void write(const RecordedStep& step);
    void finish();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Reads a recording step by step. Throws core::InputError for a file that is missing, is not a recording,
/// has another version, or is cut short or damaged; steps returned before that are intact.
class RecordingReader {
  public:
    explicit RecordingReader(const std::filesystem::path& file);
    ~RecordingReader();
    RecordingReader(const RecordingReader&) = delete;
    RecordingReader& operator=(const RecordingReader&) = delete;

    const RecordingInfo& info() const;
    /// The next step, valid until the next call (texts of leases: as long as the reader). Empty at the end,
    /// after the hash of the whole has been checked.
    std::optional<RecordedStep> next();
    /// Hash of everything recorded; known once `next` has returned empty. Equal runs have equal hashes.
    const std::string& content_hash() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Throws core::InputError for a file that is missing, not a recording, of another version, cut short or
/// damaged. Reads it to its end.
void check_recording(const std::filesystem::path& file);

/// Path of a run's recording in a run folder: `recordings/SCENARIO/CONDITION/REPLICATION.h5`.
std::filesystem::path recording_file(const std::filesystem::path& run_folder, const experiment::RunKey& key);

}  // namespace clearway::trace
