#include "trace/recording.hpp"

#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/json.hpp"
#include "experiment/condition_json.hpp"
#include "trace/detail/block_file.hpp"
#include "trace/detail/number_stream.hpp"
#include "trace/detail/step_codec.hpp"

namespace clearway::trace {
namespace {

using detail::NumberReader;
using detail::NumberWriter;

/// Of what is inside the blocks: raised when a struct, its coding or what is foreseen changes.
constexpr int recording_format = 2;
/// A block is closed at the end of the step that makes it this long, bytes.
constexpr std::size_t block_length = std::size_t{256} << 10U;

std::string info_to_json(const RecordingInfo& info) {
    core::Json object;
    object["format"] = recording_format;
    object["scenario"] = info.key.scenario;
    object["condition"] = info.key.condition;
    object["replication"] = info.key.replication;
    object["condition_spec"] = experiment::to_json(info.condition);
    core::write_fields(object["provenance"], info.provenance);
    core::write_fields(object["settings"], info.settings);
    return core::to_text(object);
}

RecordingInfo info_from_json(const std::string& text, const std::string& where) {
    const core::Json object = core::parse_object(text, where);
    RecordingInfo info;
    int format = 0;
    std::vector<core::Problem> problems;
    core::ObjectReader reader(object, where, problems);
    reader.read("format", format);
    if (problems.empty() && format != recording_format)
        throw core::InputError(
            {where, fmt::format("is a recording of content format {}", format),
             fmt::format("{}", recording_format),
             "Read it with the version of Clearway that wrote it, or record the run again"});
    using Type = core::Json::value_t;
    reader.read("scenario", info.key.scenario);
    reader.read("condition", info.key.condition);
    reader.read("replication", info.key.replication);
    info.condition =
        experiment::condition_from(reader.child("condition_spec", Type::object), where, problems);
    core::ObjectReader(reader.child("provenance", Type::object), where + ": provenance", problems)
        .read_fields(info.provenance);
    core::ObjectReader(reader.child("settings", Type::object), where + ": settings", problems)
        .read_fields(info.settings);
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return info;
}

/// The fields of each action, in both directions.
template <class Stream>
struct ActionFields {
    Stream& stream;

    template <class Action>
    void operator()(Action& action) const {
        using Plain = std::remove_const_t<Action>;
        if constexpr (std::is_same_v<Plain, traffic::DriveAt>) {
            stream.real(action.speed.value);
        } else if constexpr (std::is_same_v<Plain, traffic::ChangeLane>) {
            stream.number(action.lane_number);
        } else if constexpr (std::is_same_v<Plain, traffic::PullAside>) {
            stream.choice(action.side, traffic::Side::right, 2);
        } else if constexpr (std::is_same_v<Plain, traffic::HoldGreen>) {
            links(action.links);
            links(action.own_links);
        } else if constexpr (std::is_same_v<Plain, traffic::FavourLinks>) {
            links(action.links);
        } else {
            static_assert(std::is_empty_v<Plain>, "a new action must be coded here");
        }
    }

    template <class Links>
    void links(Links& numbers) const {
        std::uint16_t expected = 0;
        detail::list(stream, numbers, [&](auto& link) {
            stream.number(link, expected);
            expected = link;
        });
    }
};

template <std::size_t... Kind>
traffic::Action empty_action(std::size_t kind, std::index_sequence<Kind...>) {
    traffic::Action action;
    ((kind == Kind ? (void)action.emplace<Kind>() : void()), ...);
    return action;
}

template <class Stream, class Action>
void code_action(Stream& stream, Action& action) {
    constexpr std::size_t kinds = std::variant_size_v<traffic::Action>;
    std::size_t kind = action.index();
    stream.choice(kind, 0, kinds);
    if constexpr (Stream::reading) action = empty_action(kind, std::make_index_sequence<kinds>());
    std::visit(ActionFields<Stream>{stream}, action);
}

template <class Stream, class Target>
void code_target(Stream& stream, Target& target) {
    bool is_signal = target.index() == 1;
    stream.number(is_signal);
    if constexpr (Stream::reading) {
        if (is_signal) target.template emplace<core::SignalIndex>();
    }
    if (is_signal) {
        stream.number(std::get<core::SignalIndex>(target), core::SignalIndex{0});
    } else {
        stream.key(std::get<core::VehicleKey>(target));
    }
}

void code_text(NumberWriter& stream, const char* text) {
    stream.text(text);
}
void code_text(NumberReader& stream, const char*& text) {
    text = stream.text().c_str();
}

template <class Stream, class Leases>
void code_leases(Stream& stream, Leases& leases, core::Seconds now) {
    core::Seconds expected = now;
    detail::list(stream, leases, [&](auto& lease) {
        code_target(stream, lease.target);
        code_action(stream, lease.action);
        stream.real(lease.expiry.value, expected.value);
        expected = lease.expiry;
        stream.number(lease.priority);
        code_text(stream, lease.policy);
        code_text(stream, lease.reason);
        stream.key(lease.beneficiary);
    });
}

/// What both sides remember from step to step.
struct Codecs {
    detail::RosterCodec roster{detail::RosterCodec::Keys::registered};
    detail::SnapshotCodec snapshot;
    detail::ObservationCodec observation;
    detail::BeliefCodec belief;
};

}  // namespace

struct RecordingWriter::State {
    explicit State(const std::filesystem::path& file) : blocks(file) {}

    detail::BlockWriter blocks;
    NumberWriter stream;
    Codecs codecs;
};

RecordingWriter::RecordingWriter(const std::filesystem::path& file, const RecordingInfo& info)
    : state_(std::make_unique<State>(file)) {
    state_->blocks.write(info_to_json(info));
}
RecordingWriter::~RecordingWriter() = default;

void RecordingWriter::write(const RecordedStep& step) {
    if (step.belief != nullptr && step.observation == nullptr)
        throw std::invalid_argument("a belief is recorded without its observation");
    if (step.observation != nullptr && step.observation->roster == nullptr)
        throw std::invalid_argument("an observation is recorded without a roster");
    NumberWriter& stream = state_->stream;
    Codecs& codecs = state_->codecs;
    codecs.roster.code(stream, *step.roster);
    codecs.snapshot.code(stream, *step.snapshot);
    code_events(stream, *step.events, step.snapshot->time);
    stream.number(step.observation != nullptr);
    if (step.observation != nullptr)
        codecs.observation.code(stream, *step.observation, *step.snapshot, *step.roster,
                                *step.observation->roster);
    stream.number(step.belief != nullptr);
    if (step.belief != nullptr)
        codecs.belief.code(stream, *step.belief, *step.observation, *step.snapshot, codecs.observation);
    code_leases(stream, step.leases, step.snapshot->time);
    if (stream.bytes().size() < block_length) return;
    state_->blocks.write(stream.bytes());
    stream.clear();
}

void RecordingWriter::finish() {
    if (!state_->stream.bytes().empty()) state_->blocks.write(state_->stream.bytes());
    state_->blocks.finish();
}

struct RecordingReader::State {
    explicit State(const std::filesystem::path& file) : blocks(file) {}

    detail::BlockReader blocks;
    RecordingInfo info;
    NumberReader stream;
    Codecs codecs;
    truth::Snapshot snapshot;
    traffic::Roster roster, own_roster;
    truth::Events events;
    traffic::Observation observation;
    traffic::BelievedGraph belief;
    std::vector<traffic::Lease> leases;

    RecordedStep read_step() {
        RecordedStep step{&snapshot, &roster, &events, nullptr, nullptr, {}};
        codecs.roster.code(stream, roster);
        codecs.snapshot.code(stream, snapshot);
        code_events(stream, events, snapshot.time);
        bool is_there = false;
        stream.number(is_there);
        if (is_there) {
            codecs.observation.code(stream, observation, snapshot, roster, own_roster);
            step.observation = &observation;
        }
        stream.number(is_there);
        if (is_there) {
            if (step.observation == nullptr) throw std::runtime_error("a belief has no observation");
            codecs.belief.code(stream, belief, observation, snapshot, codecs.observation);
            step.belief = &belief;
        }
        code_leases(stream, leases, snapshot.time);
        step.leases = leases;
        return step;
    }
};

RecordingReader::RecordingReader(const std::filesystem::path& file) : state_(std::make_unique<State>(file)) {
    const auto head = state_->blocks.next();
    if (!head) throw core::InputError({file.string(), "is damaged: it holds nothing", "", ""});
    state_->info = info_from_json(std::string(*head), file.string());
}
RecordingReader::~RecordingReader() = default;

const RecordingInfo& RecordingReader::info() const {
    return state_->info;
}

std::optional<RecordedStep> RecordingReader::next() {
    State& state = *state_;
    if (state.stream.at_end()) {
        const auto block = state.blocks.next();
        if (!block) return std::nullopt;
        state.stream.open(*block);
    }
    try {
        return state.read_step();
    } catch (const core::Error&) {
        throw;
    } catch (const std::exception& error) {
        throw core::InputError(
            {state.blocks.file().string(),
             fmt::format("is damaged after {} s: {}", state.snapshot.time.value, error.what()), "",
             "Record the run again"});
    }
}

const std::string& RecordingReader::content_hash() const {
    return state_->blocks.content_hash();
}

std::filesystem::path recording_file(const std::filesystem::path& run_folder, const experiment::RunKey& key) {
    return run_folder / "recordings" / key.scenario / key.condition /
           fmt::format("{:05}.recording", key.replication);
}

}  // namespace clearway::trace
