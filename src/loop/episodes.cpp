#include "loop/episodes.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/files.hpp"
#include "core/json.hpp"
#include "core/read_failure.hpp"
#include "experiment/job.hpp"
#include "loop/unit_run.hpp"
#include "loop/watch.hpp"
#include "policy/agent.hpp"

namespace clearway::loop {
namespace {

using python::Bell;

/// Exit codes of a child: the episode is over, or the environment wants the next one.
constexpr int episode_over = 0;
constexpr int reset_wanted = 100;

/// Works out what the agent is told from the truth (policy::AgentScore): against the speed that the road and
/// the vehicle allow, each second on the road loses 1 - speed / allowed speed.
class ScoreListener : public trace::StepListener {
  public:
    ScoreListener(const roads::Network& network, std::size_t emergency_count, policy::AgentScore& score)
        : network_(network), emergency_count_(emergency_count), score_(score) {}

    void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) override {
        const double passed_s = last_s_ < 0.0 ? 0.0 : snapshot.time.value - last_s_;
        last_s_ = snapshot.time.value;
        bool on_the_road = false;
        for (core::VehicleIndex row = 0; row < snapshot.size(); ++row) {
            const bool is_emergency = snapshot.vehicle_class[row] == traffic::VehicleClass::emergency;
            const double lost_s = passed_s * lost_share(snapshot, roster, row);
            (is_emergency ? score_.emergency_delay_s : score_.others_delay_s) += lost_s;
            if (is_emergency) note(snapshot.key[row]);
            on_the_road = on_the_road || is_emergency;
        }
        score_.any_departed = !seen_.empty();
        score_.all_arrived = seen_.size() == emergency_count_ && !on_the_road;
    }

  private:
    double lost_share(const truth::Snapshot& snapshot, const traffic::Roster& roster,
                      core::VehicleIndex row) const {
        const traffic::VehicleInfo* const info = roster.find(snapshot.key[row]);
        const core::LaneIndex lane = snapshot.lane[row];
        if (info == nullptr || !lane.exists()) return 0.0;
        const double allowed_mps = std::min<double>(network_.lane(lane).speed_limit_mps * info->speed_factor,
                                                    info->maximum_speed_mps);
        if (allowed_mps <= 0.0) return 0.0;
        return std::clamp(1.0 - snapshot.speed_mps[row] / allowed_mps, 0.0, 1.0);
    }
    void note(core::VehicleKey key) {
        const auto place = std::ranges::lower_bound(seen_, key);
        if (place == seen_.end() || *place != key) seen_.insert(place, key);
    }

    const roads::Network& network_;
    std::size_t emergency_count_;
    policy::AgentScore& score_;
    double last_s_ = -1.0;
    std::vector<core::VehicleKey> seen_;  ///< Emergency vehicles that have entered; ordered.
};

/// What the environment is told at the end of a run, JSON.
std::string end_text(const results::RunRecord& record, const policy::AgentScore& score, double horizon_s) {
    core::Json metrics = core::Json::object();
    core::write_fields(metrics, record.metrics);
    return core::to_text({{"emergency_delay_s", score.emergency_delay_s},
                          {"others_delay_s", score.others_delay_s},
                          {"truncated", record.metrics.simulated_s >= horizon_s - core::clock_tolerance_s},
                          {"trace_hash", record.provenance.trace_hash},
                          {"metrics", metrics}});
}

/// Everything that the child of an episode does.
[[noreturn]] void be_episode(UnitRun& run, const experiment::ConditionSpec& condition,
                             const python::Channel& channel, const std::filesystem::path& folder,
                             std::uint32_t ways) {
    const auto leave = [&](Bell bell) {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
        _exit(bell == Bell::reset ? reset_wanted : episode_over);
    };
    try {
        core::make_folder(folder);
        run.session().continue_in(folder);
        policy::AgentScore score;
        run.invite([&](const policy::PolicyContext& context) {
            return std::make_unique<policy::Agent>(context, channel, score, leave, ways);
        });
        ScoreListener listener(run.network(), run.emergency_count(), score);
        results::RunTiming timing;
        const results::RunRecord record = run.finish_here(condition, timing, &listener);
        channel.write_text(end_text(record, score, run.horizon().value));
        channel.ring(Bell::ended);
    } catch (const std::exception& error) {
        channel.write_text(error.what());
        channel.ring(Bell::failed);
    }
    leave(Bell::ended);
    std::abort();
}

/// Runs an episode in its own child. Returns whether the environment already wants the next one.
bool fork_episode(UnitRun& run, const experiment::RunJob& job, const python::Channel& channel,
                  const std::filesystem::path& folder, std::uint32_t ways) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0)
        throw core::EnvironmentError(
            fmt::format("cannot fork for an episode: {}. {}", std::strerror(errno), core::cure_of(errno)));
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        be_episode(run, job.conditions.front(), channel, folder, ways);
    }
    const WatchedEnd end = watch(child, job.limits);
    if (WIFEXITED(end.status) && WEXITSTATUS(end.status) == reset_wanted) return true;
    if (WIFEXITED(end.status) && WEXITSTATUS(end.status) == episode_over) return false;
    const std::string why = WIFSIGNALED(end.status) ? core::Exit{.signal = WTERMSIG(end.status)}.describe()
                                                    : core::Exit{.code = WEXITSTATUS(end.status)}.describe();
    channel.write_text(fmt::format("the episode's process ended: {}; SUMO's log: {}", why,
                                   core::tail(folder / "sumo.log", 10)));
    channel.ring(Bell::failed);
    return false;
}

}  // namespace

core::ExitCode serve_episodes(const std::filesystem::path& job_file, const python::Descriptors& descriptors,
                              std::uint32_t ways) {
    const python::Channel channel(descriptors);
    try {
        const auto job = std::get<experiment::RunJob>(experiment::read_job(job_file));
        const std::filesystem::path work = job_file.parent_path();
        UnitRun run(job, work / "demand", work / "sumo");
        const ChildSignals signals;
        channel.write_text(policy::agent_greeting(run.network(), ways));
        channel.ring(Bell::hello);
        Bell bell{};
        bool wanted = false;
        for (std::uint64_t episode = 0; wanted || (channel.wait(bell) && bell == Bell::reset); ++episode)
            wanted = fork_episode(run, job, channel, work / fmt::format("episode-{}", episode), ways);
    } catch (const core::Error& error) {
        channel.write_text(error.what());
        channel.ring(Bell::failed);
        return error.exit_code();
    }
    return core::ExitCode::ok;
}

}  // namespace clearway::loop
