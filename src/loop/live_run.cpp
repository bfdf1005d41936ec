#include <string>

#include "core/files.hpp"
#include "experiment/settings.hpp"
#include "loop/detail/live_feed.hpp"
#include "loop/jobs.hpp"
#include "loop/unit_run.hpp"
#include "results/store.hpp"
#include "view/recorded_run.hpp"
#include "view/run_stream.hpp"

namespace clearway::loop {
namespace {

/// Lost frames are made up for after this time of the simulation at most.
constexpr double key_period_s = 2.0;

/// Hands every step to the server, then waits until the run may go on.
class Broadcast : public trace::StepListener {
  public:
    Broadcast(detail::LiveFeed& feed, const roads::Network& network, const graph::LinkRules& rules)
        : feed_(feed), stream_(view::origin_of(network), rules, {.key_period_s = key_period_s}) {}

    void on_step(const truth::Snapshot&, const traffic::Roster&) override {}
    void on_step_end(const trace::RecordedStep& step) override {
        blocks_.clear();
        stream_.step(step, blocks_);
        feed_.send(blocks_);
        feed_.wait_until_allowed(step.snapshot->time.value);
    }

  private:
    detail::LiveFeed& feed_;
    view::RunStream stream_;
    std::string blocks_;
};

}  // namespace

core::ExitCode run_live(const experiment::RunJob& unit, const std::filesystem::path& work) {
    const results::Store store = results::Store::open(unit.output);
    const experiment::ConditionSpec& condition = unit.conditions.at(0);
    const std::filesystem::path demand = work / "demand";
    core::make_folder(demand);
    detail::LiveFeed feed(unit.live.value().socket);
    UnitRun run(unit, demand, work / "sumo");
    std::string greeting;
    view::FrameEncoder::encode_message(view::about({unit.scenario, condition.name, unit.replication},
                                                   condition, run.network(), run.incidents()),
                                       greeting);
    view::FrameEncoder::encode_message(view::drawing_of(run.network()), greeting);
    feed.send(greeting);
    Broadcast broadcast(feed, run.network(), experiment::loop_config(condition).rules());
    results::RunTiming timing;
    const results::RunRecord record = run.finish_here(condition, timing, &broadcast);
    store.write(record, timing);
    std::string end;
    view::FrameEncoder::encode_message(R"({"ended": true})", end);
    feed.send(end);
    return core::ExitCode::ok;
}

}  // namespace clearway::loop
