#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>

#include "core/fields.hpp"
#include "experiment/condition.hpp"
#include "experiment/run_key.hpp"
#include "traffic/belief.hpp"
#include "traffic/command.hpp"
#include "traffic/lease.hpp"
#include "traffic/observation.hpp"
#include "truth/events.hpp"
#include "truth/snapshot.hpp"

namespace clearway::trace {

/// The numbers of a run that a recording needs to be read and thought through again.
struct RecordingSettings {
    double step_length_s = 0.0;
    double policy_period_s = 0.0;
    double link_radius_m = 0.0;
    std::string network_hash;

    bool operator==(const RecordingSettings&) const = default;

    static constexpr auto fields() {
        using S = RecordingSettings;
        using core::Field;
        return std::make_tuple(
            Field{"step_length_s", "s", &S::step_length_s, 0.01, 1.0, "Step of the simulation", ""},
            Field{"policy_period_s", "s", &S::policy_period_s, 0.1, 10.0, "Time between two decisions", ""},
            Field{"link_radius_m", "m", &S::link_radius_m, 1.0, 1000.0, "Two vehicles nearer are linked", ""},
            Field{"network_hash", "", &S::network_hash, 0, 0,
                  "core::content_hash of the network file, whose lanes, edges and signals the numbers are of",
                  ""});
    }
};

/// What a recording is of.
struct RecordingInfo {
    experiment::RunKey key;
    experiment::ConditionSpec condition;
    experiment::Provenance provenance;  ///< Without the trace hash, which only the end of a run knows.
    RecordingSettings settings;

    bool operator==(const RecordingInfo&) const = default;
};

/// A step as it was when it ended.
struct RecordedStep {
    const truth::Snapshot* snapshot = nullptr;  ///< Never null.
    const traffic::Roster* roster = nullptr;    ///< The true one; never null.
    const truth::Events* events = nullptr;      ///< Never null.
    /// Null unless a report arrived or a decision was made. Its roster is `roster`, or one of its own.
    const traffic::Observation* observation = nullptr;
    const traffic::BelievedGraph* belief = nullptr;  ///< Null unless a decision was made.
    std::span<const traffic::Lease> leases = {};
    std::span<const traffic::Command> commands = {};  ///< What came of the leases in force; not recorded.
};

/// Writes a recording (docs/reference/recording.md) step by step, in memory that does not grow with the
/// length of the run beyond one entry a vehicle and route. Every bit of every member comes back. The file is
/// there after `finish`, as a whole; without it nothing is left. Throws core::EnvironmentError;
/// std::invalid_argument for a step that breaks the rules of RecordedStep, and for rows that are not ordered
/// by key.
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

/// Reads a recording step by step. Throws core::InputError for a file that is missing, none, of another
/// version, cut short or damaged; what was read before that was intact.
class RecordingReader {
  public:
    explicit RecordingReader(const std::filesystem::path& file);
    ~RecordingReader();
    RecordingReader(const RecordingReader&) = delete;
    RecordingReader& operator=(const RecordingReader&) = delete;

    const RecordingInfo& info() const;
    /// The next step, valid until the next call (texts of leases: as long as the reader lives); nothing at
    /// the end, once the hash of the whole was found right.
    std::optional<RecordedStep> next();
    /// Hash of everything recorded, after `next` has given nothing. Equal runs have equal hashes.
    const std::string& content_hash() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Where the recording of a run lies in a run folder: `recordings/SCENARIO/CONDITION/REPLICATION.h5`.
std::filesystem::path recording_file(const std::filesystem::path& run_folder, const experiment::RunKey& key);

}  // namespace clearway::trace
