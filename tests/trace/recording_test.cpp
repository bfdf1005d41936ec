// A recording gives back what was written to the bit, and says what is wrong with a file that does not.
#include "trace/recording.hpp"

#include <csignal>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "support/message_of.hpp"
#include "support/temporary_folder.hpp"
#include "trace/detail/seal.hpp"
#include "trace/difference.hpp"
#include "trace/random_run.hpp"
#include "truth/events.hpp"

namespace clearway::results {
namespace {

using test::RandomRun;
using testing::HasSubstr;

bool same(const truth::Events& one, const truth::Events& other) {
    const auto collision = [](const truth::Collision& left, const truth::Collision& right) {
        return left.collider == right.collider && left.victim == right.victim && left.place == right.place &&
               left.lane == right.lane && left.with_emergency_vehicle == right.with_emergency_vehicle;
    };
    const auto braking = [](const truth::EmergencyBraking& left, const truth::EmergencyBraking& right) {
        return left.vehicle == right.vehicle && std::bit_cast<std::uint32_t>(left.deceleration_mps2) ==
                                                    std::bit_cast<std::uint32_t>(right.deceleration_mps2);
    };
    return one.time == other.time && one.departed == other.departed && one.arrived == other.arrived &&
           one.teleported == other.teleported && one.removed == other.removed &&
           std::ranges::equal(one.collisions, other.collisions, collision) &&
           std::ranges::equal(one.emergency_brakings, other.emergency_brakings, braking);
}

void expect_same_roster(const traffic::Roster& one, const traffic::Roster& other) {
    ASSERT_EQ(one.vehicles().size(), other.vehicles().size());
    ASSERT_EQ(one.route_count(), other.route_count());
    for (std::size_t row = 0; row < one.vehicles().size(); ++row) {
        EXPECT_EQ(one.vehicles()[row].id, other.vehicles()[row].id);
        EXPECT_EQ(one.vehicles()[row].route, other.vehicles()[row].route);
    }
    for (std::uint32_t route = 0; route < one.route_count(); ++route)
        EXPECT_EQ(one.route(core::RouteIndex{route}), other.route(core::RouteIndex{route}));
}

TEST(Difference, SeesAnotherStretchOfRoad) {
    std::vector<traffic::Lease> one(1);
    one.front().target = traffic::Stretch{core::LaneIndex{3}, 10.0F, 200.0F};
    std::vector<traffic::Lease> other = one;
    EXPECT_EQ(trace::difference(one, other), std::nullopt);
    std::get<traffic::Stretch>(other.front().target).to_m = 201.0F;
    EXPECT_THAT(trace::difference(one, other).value_or(""), testing::HasSubstr("target.to_m: 200, then 201"));
    other.front().target = core::SignalIndex{3};
    EXPECT_THAT(trace::difference(one, other).value_or(""), testing::HasSubstr("vehicle, signal or stretch"));
}

TEST(Difference, SeesTheLinksThatAnEmergencyVehicleItselfTakes) {
    std::vector<traffic::Lease> one(1);
    one.front().target = core::SignalIndex{0};
    one.front().action = traffic::HoldGreen{{2, 3}, {3}};
    std::vector<traffic::Lease> other = one;
    other.front().action = traffic::HoldGreen{{2, 3}, {2}};
    EXPECT_EQ(trace::difference(one, one), std::nullopt);
    EXPECT_THAT(trace::difference(one, other).value_or(""), testing::HasSubstr("own_links"));
}

TEST(Difference, SeesAnotherWayTakenOrConsidered) {
    const std::vector<core::EdgeIndex> way = {core::EdgeIndex{1}, core::EdgeIndex{2}};
    const std::vector<core::EdgeIndex> beside = {core::EdgeIndex{1}, core::EdgeIndex{3}};
    std::vector<traffic::Lease> one(2);
    one[0].action = traffic::TakeRoute{way};
    one[1].action = traffic::StandBack{way};
    std::vector<traffic::Lease> other = one;
    EXPECT_EQ(trace::difference(one, other), std::nullopt);
    other[1].action = traffic::StandBack{beside};
    EXPECT_THAT(trace::difference(one, other).value_or(""), testing::HasSubstr("[1].action.way"));
    other[0].action = traffic::TakeRoute{beside};
    EXPECT_THAT(trace::difference(one, other).value_or(""), testing::HasSubstr("[0].action.edges"));
}

void expect_same(const trace::RecordedStep& one, const trace::RecordedStep& other) {
    EXPECT_EQ(trace::difference(*one.snapshot, *other.snapshot), std::nullopt);
    EXPECT_TRUE(same(*one.events, *other.events));
    expect_same_roster(*one.roster, *other.roster);
    EXPECT_EQ(trace::difference(one.leases, other.leases), std::nullopt);
    ASSERT_EQ(one.observation != nullptr, other.observation != nullptr);
    ASSERT_EQ(one.belief != nullptr, other.belief != nullptr);
    if (one.observation != nullptr) {
        EXPECT_EQ(trace::difference(*one.observation, *other.observation), std::nullopt);
        EXPECT_EQ(one.observation->roster == one.roster, other.observation->roster == other.roster);
        expect_same_roster(*one.observation->roster, *other.observation->roster);
    }
    if (one.belief != nullptr) {
        EXPECT_EQ(trace::difference(*one.belief, *other.belief), std::nullopt);
        EXPECT_EQ(other.belief->roster, other.observation->roster);
    }
}

class Recording : public testing::Test {
  protected:
    std::filesystem::path record(const std::string& name, int steps, unsigned seed = 1,
                                 const trace::RecordingInfo& info = RandomRun::info()) const {
        const std::filesystem::path file = folder_.path() / name;
        trace::RecordingWriter writer(file, info);
        RandomRun run(seed);
        for (int step = 0; step < steps; ++step)
            writer.write(run.next());
        writer.finish();
        return file;
    }
    /// Reads to the end; the message of what is wrong, or nothing.
    static std::string problem_of(const std::filesystem::path& file) {
        try {
            trace::RecordingReader reader(file);
            while (reader.next()) {
            }
        } catch (const core::InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr(file.string()));
            return error.what();
        }
        return "";
    }
    support::TemporaryFolder folder_;
};

TEST_F(Recording, GivesBackEveryBitOfEveryStep) {
    for (const bool own_roster : {false, true}) {
        const std::filesystem::path file = folder_.path() / "any.h5";
        trace::RecordingWriter writer(file, RandomRun::info());
        RandomRun run(5, own_roster);
        for (int step = 0; step < 400; ++step)
            writer.write(run.next());
        writer.finish();

        trace::RecordingReader reader(file);
        EXPECT_EQ(reader.info(), RandomRun::info());
        RandomRun again(5, own_roster);
        for (int step = 0; step < 400; ++step) {
            const auto read = reader.next();
            ASSERT_TRUE(read);
            expect_same(again.next(), *read);
            if (HasFailure()) FAIL() << "step " << step;
        }
        EXPECT_FALSE(reader.next());
    }
}

TEST_F(Recording, HasTheSameHashForTheSameRunAndAnotherForAnother) {
    const auto hash_of = [](const std::filesystem::path& file) {
        trace::RecordingReader reader(file);
        while (reader.next()) {
        }
        return reader.content_hash();
    };
    const std::string hash = hash_of(record("one", 60));
    EXPECT_EQ(hash.size(), 32U);
    EXPECT_EQ(hash_of(record("two", 60)), hash);
    EXPECT_NE(hash_of(record("three", 60, 2)), hash);
}

TEST_F(Recording, OfNoStepIsRead) {
    trace::RecordingReader reader(record("empty", 0));
    EXPECT_FALSE(reader.next());
}

TEST_F(Recording, IsThereAsAWholeOrNotAtAll) {
    const std::filesystem::path file = folder_.path() / "half";
    {
        trace::RecordingWriter writer(file, RandomRun::info());
        RandomRun run(1);
        for (int step = 0; step < 200; ++step)
            writer.write(run.next());
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(Recording, SaysThatAFileIsMissingOrSomethingElse) {
    EXPECT_THAT(problem_of(folder_.path() / "none"), HasSubstr("cannot be read"));
    EXPECT_THAT(problem_of(folder_.path()), HasSubstr("cannot be read"));
    EXPECT_THAT(problem_of(folder_.write("notes.txt", "dear diary, today")), HasSubstr("is not a recording"));
    EXPECT_THAT(problem_of(folder_.write("nothing", "")), HasSubstr("is not a recording"));
}

TEST_F(Recording, RefusesAnotherVersion) {
    const std::filesystem::path file = record("later", 3);
    std::string bytes = core::read_file(file);
    bytes[bytes.find("format 6") + 7] = '9';
    core::write_atomically(file, bytes);
    EXPECT_THAT(problem_of(file), testing::AllOf(HasSubstr("of format 9"), HasSubstr("allowed: 6")));
}

TEST_F(Recording, RefusesHdf5ThatItDidNotSeal) {
    const std::string bytes = core::read_file(record("whole", 3));
    EXPECT_THAT(problem_of(folder_.write("rewritten", bytes.substr(512))), HasSubstr("is not a recording"));
}

TEST_F(Recording, NoticesWhereverItIsCutShort) {
    const std::filesystem::path file = record("cut", 40);
    const std::string bytes = core::read_file(file);
    for (std::size_t length = 40; length < bytes.size(); length += length < 600 ? 97 : 997) {
        core::write_atomically(file, std::string_view(bytes).substr(0, length));
        EXPECT_THAT(problem_of(file), HasSubstr("is cut short")) << length;
    }
    core::write_atomically(file, bytes + "x");
    EXPECT_THAT(problem_of(file), HasSubstr("something follows its end"));
}

TEST_F(Recording, NoticesEveryFlippedBit) {
    const std::filesystem::path file = record("flipped", 20);
    const std::string bytes = core::read_file(file);
    for (std::size_t at = 0; at < bytes.size(); at += at < 512 ? 3 : 509) {
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
        core::write_atomically(file, damaged);
        EXPECT_NE(problem_of(file), "") << at;
    }
}

TEST_F(Recording, NoticesWhatAnotherToolChangedAndSealed) {
    const std::filesystem::path file = record("changed", 20);
    {
        const hid_t open = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        const hid_t set = H5Dopen2(open, "steps/time_s", H5P_DEFAULT);
        std::vector<double> times(20);
        ASSERT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, times.data()), 0);
        times[7] += 1.0;
        ASSERT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, times.data()), 0);
        H5Dclose(set);
        H5Fclose(open);
    }
    EXPECT_THAT(problem_of(file), HasSubstr("does not fit its hash"));
    const std::string sealed = trace::detail::seal_of(file) + core::read_file(file).substr(512);
    core::write_atomically(file, sealed);
    EXPECT_THAT(problem_of(file),
                testing::AllOf(HasSubstr("is damaged"), HasSubstr("does not fit its hash")));
}

/// Puts another attribute in the place of one of a recording, and seals it anew.
void replace_attribute(const std::filesystem::path& file, const char* name, hid_t type, hsize_t count,
                       const void* values) {
    const hid_t open = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(H5Adelete(open, name), 0);
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t attribute = H5Acreate2(open, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    ASSERT_GE(H5Awrite(attribute, type, values), 0);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Fclose(open);
    core::write_atomically(file, trace::detail::seal_of(file) + core::read_file(file).substr(512));
}

TEST_F(Recording, FollowsNoReferencesOfAttributesAndReadsOnlySingleValues) {
    const std::filesystem::path referring = record("referring", 3);
    const hid_t variable = H5Tcopy(H5T_C_S1);
    ASSERT_GE(H5Tset_size(variable, H5T_VARIABLE), 0);
    const char* const text = "city";
    replace_attribute(referring, "scenario", variable, 1, &text);
    H5Tclose(variable);
    EXPECT_THAT(problem_of(referring), HasSubstr("no text of fixed length"));
    const std::filesystem::path many = record("many", 3);
    replace_attribute(many, "replication", H5T_NATIVE_UINT64, 1000,
                      std::vector<std::uint64_t>(1000, 7).data());
    EXPECT_THAT(problem_of(many), HasSubstr("no single value"));
}

TEST_F(Recording, KeepsTextsOfAnyLength) {
    const std::filesystem::path file = folder_.path() / "long.h5";
    trace::RecordingInfo info = RandomRun::info();
    info.incidents = "[" + std::string(200'000, ' ') + "]";  // HDF5 keeps attributes above 64 KiB elsewhere
    info.provenance.demand_hash = "";
    {
        trace::RecordingWriter writer(file, info);
        writer.finish();
    }
    const trace::RecordingReader reader(file);
    EXPECT_EQ(reader.info(), info);
}

/// The descriptor by which this process has the file open.
int descriptor_of(const std::filesystem::path& file) {
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        std::error_code gone;
        if (std::filesystem::read_symlink(entry.path(), gone) == std::filesystem::canonical(file))
            return std::stoi(entry.path().filename());
    }
    return -1;
}

TEST_F(Recording, IsNotBlamedWhereTheMachineCannotReadIt) {
    const std::filesystem::path file = record("unread", 20);
    trace::RecordingReader reader(file);
    const int read_by = descriptor_of(file);
    ASSERT_GE(read_by, 0);
    const int not_readable = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ASSERT_EQ(::dup2(not_readable, read_by), read_by);
    ::close(not_readable);
    EXPECT_THAT(support::message_of<core::EnvironmentError>([&] { reader.next(); }),
                testing::AllOf(HasSubstr(file.string()), HasSubstr("Bad file descriptor"),
                               HasSubstr("not the file's content: give the same command again")));
}

TEST_F(Recording, OfAKilledProcessIsNone) {
    const std::filesystem::path file = folder_.path() / "killed";
    const pid_t child = fork();
    if (child == 0) {
        trace::RecordingWriter writer(file, RandomRun::info());
        RandomRun run(1);
        for (int step = 0; step < 300; ++step)
            writer.write(run.next());
        std::raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_FALSE(std::filesystem::exists(file));
    const std::filesystem::path part = file.string() + "." + std::to_string(child) + ".clearway-part";
    ASSERT_TRUE(std::filesystem::exists(part));
    EXPECT_THAT(problem_of(part), HasSubstr("is not a recording"));
    core::remove_abandoned_parts(folder_.path());
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(Recording, OfTheSameRunIsTheSameFile) {
    EXPECT_EQ(core::read_file(record("one", 60)), core::read_file(record("two", 60)));
}

TEST_F(Recording, RefusesStepsThatItCouldNotGiveBack) {
    trace::RecordingWriter writer(folder_.path() / "odd", RandomRun::info());
    RandomRun run(3);
    trace::RecordedStep step = run.next();
    step.belief = run.next().belief;
    step.observation = nullptr;
    EXPECT_THROW(writer.write(step), std::invalid_argument);
    truth::Snapshot unordered = *step.snapshot;
    unordered.key = {core::VehicleKey{9}, core::VehicleKey{3}};
    unordered.resize(2);
    step = {&unordered, step.roster, step.events, nullptr, nullptr, {}};
    EXPECT_THROW(writer.write(step), std::invalid_argument);
}

TEST_F(Recording, ThatDoesNotFitOnTheDiskLeavesNothing) {
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit tight{20'000, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &tight);
    EXPECT_THROW(record("large", 400), core::EnvironmentError);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(Recording, is_refused_when_a_name_leads_out_of_a_folder) {
    trace::RecordingInfo info = RandomRun::info();
    info.key.scenario = "../../escaped";
    EXPECT_THAT(problem_of(record("scenario.h5", 1, 1, info)),
                HasSubstr("scenario: \"../../escaped\" cannot be the name of a folder"));
    info = RandomRun::info();
    info.key.condition = "a/b";
    EXPECT_THAT(problem_of(record("condition.h5", 1, 1, info)),
                HasSubstr("condition: \"a/b\" cannot be the name of a folder"));
}

}  // namespace
}  // namespace clearway::results
