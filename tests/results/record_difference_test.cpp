#include "results/record_difference.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/json.hpp"
#include "results/synthetic.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::results {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const experiment::RunKey key{"alpha", "treated", 1};

/// A record that has something in each of its tables.
RunRecord full_record() {
    RunRecord run = synthetic::record(key);
    run.condition.settings = {{"policy.period_s", "2"}};
    run.leases = {{"clear_lane", traffic::LeaseKind::change_lane, 4, 140, 2, 1, {}},
                  {"clear_lane", traffic::LeaseKind::drive_at, 8, 99, 4, 1, {}}};
    run.leases[1].refused[traffic::Refusal::outranked] = 3;
    run.traffic = synthetic::traffic_tables();
    run.signal_events = {{{60.25, "J", 1, 2, "0 1", ""}, {61.0, "J", 102, 1, "0", "ev 1"}}};
    return run;
}

class RecordDifference : public testing::Test {
  protected:
    void SetUp() override {
        one_.write(full_record(), {});
        other_.write(full_record(), {});
    }

    std::vector<CellDifference> found() const { return differences(one_, other_, key); }

    /// The differences when the other store holds this record.
    std::vector<CellDifference> found_with(const RunRecord& run) const {
        std::filesystem::remove_all(other_.run_folder(key));
        other_.write(run, {});
        return found();
    }

    core::Json record_of_other() const { return core::Json::parse(core::read_file(file_)); }

    /// Writes a record with the hash that fits it, as somebody would who edits it unnoticed.
    void write_sealed(core::Json run) const {
        run.erase("hash");
        run["hash"] = core::content_hash(core::to_text(run));
        core::write_atomically(file_, core::to_text(run));
    }

    support::TemporaryFolder folder_;
    Store one_ = Store::create(folder_.path() / "one", synthetic::manifest());
    Store other_ = Store::create(folder_.path() / "other", synthetic::manifest());
    std::filesystem::path file_ = other_.run_folder(key) / "run.json";
};

/// `leases 2 (clear_lane) issued: 8, 1008`.
std::vector<std::string> texts_of(const std::vector<CellDifference>& cells) {
    std::vector<std::string> texts;
    for (const CellDifference& cell : cells)
        texts.push_back(cell.table + " " + (cell.row.empty() ? "" : cell.row + " ") + cell.column + ": " +
                        cell.one + ", " + cell.other);
    return texts;
}

/// Another value of the same type.
core::Json changed(const core::Json& value) {
    if (value.is_number_float()) return value.get<double>() + 1000.0;
    if (value.is_number()) return value.get<std::int64_t>() + 1000;
    if (value.is_boolean()) return !value.get<bool>();
    return value.is_string() ? core::Json(value.get<std::string>() + "x") : core::Json(1);
}

TEST_F(RecordDifference, IsNoneBetweenEqualRecordsWhateverTheyTook) {
    RunTiming slow;
    slow.wall_s = 9.0;
    std::filesystem::remove_all(other_.run_folder(key));
    other_.write(full_record(), slow);
    EXPECT_NE(core::read_file(one_.run_folder(key) / "timing.json"),
              core::read_file(other_.run_folder(key) / "timing.json"));
    EXPECT_THAT(found(), IsEmpty());
}

TEST_F(RecordDifference, IsFoundInEveryValueOfRunJson) {
    const core::Json whole = record_of_other();
    const core::Json leaves = whole.flatten();
    EXPECT_GT(leaves.size(), 100U);
    for (const auto& [pointer, value] : leaves.items()) {
        if (pointer == "/hash") continue;
        core::Json edited = whole;
        edited[core::Json::json_pointer(pointer)] = changed(value);
        write_sealed(edited);
        EXPECT_EQ(found().size(), 1U) << pointer;
    }
    for (const auto& [name, value] : whole.items()) {
        if (name == "hash") continue;
        core::Json without = whole;
        without.erase(name);
        write_sealed(without);
        EXPECT_EQ(found().size(), 1U) << "without " << name;
    }
    core::Json with_more = whole;
    with_more["more"] = 1;
    write_sealed(with_more);
    EXPECT_THAT(texts_of(found()), ElementsAre("run more: missing, 1"));
}

TEST_F(RecordDifference, NamesTableRowAndColumnOfValuesInRunJson) {
    RunRecord run = full_record();
    run.metrics.simulated_s = 601.0;
    run.condition.settings = {{"policy.period_s", "3"}};
    run.leases[1].issued = 1008;
    run.leases[1].refused[traffic::Refusal::outranked] = 4;
    run.leases.push_back(run.leases[0]);
    EXPECT_THAT(
        texts_of(found_with(run)),
        ElementsAre("condition_spec settings.policy.period_s: 2, 3", "metrics simulated_s: 600.25, 601.0",
                    "leases 2 (clear_lane) issued: 8, 1008", "leases 2 (clear_lane) refused.outranked: 3, 4",
                    "leases 3 (clear_lane) (row): missing, there"));
}

TEST_F(RecordDifference, NamesTheCellsOfTrafficTables) {
    RunRecord run = full_record();
    run.traffic.approaches[0].vehicles = 1003;
    run.traffic.recovery.pop_back();
    run.traffic.journeys[1].signal = "K";
    run.traffic.edge_times[0].time_s = 13.5;
    run.traffic.holds.clear();
    run.traffic.locks[0].lasted_s = 81.0;
    EXPECT_THAT(texts_of(found_with(run)), ElementsAre("traffic.approaches 1 (a,\"b) vehicles: 3, 1003",
                                                       "traffic.recovery 2 (0) (row): there, missing",
                                                       "traffic.journeys 2 (ev 1) signal: J\n2, K",
                                                       "traffic.edge_times 1 (ev 1) time_s: 12.5, 13.5",
                                                       "traffic.holds 1 (J\n2) (row): there, missing",
                                                       "traffic.locks 1 (a,\"b) lasted_s: 81.25, 81"));
}

TEST_F(RecordDifference, NamesTheCellsOfVehiclesAndSignalEvents) {
    RunRecord run = full_record();
    run.vehicles[1].waiting_time_s = 1.5;
    run.vehicles[1].vehicle_class = traffic::VehicleClass::automated;
    (*run.signal_events)[1].parameter = 2;
    const std::vector<std::string> expected = {"vehicles 2 (h1) class: human, automated",
                                               "vehicles 2 (h1) waiting_time_s: 0, 1.5",
                                               "signal_events 2 (61) parameter: 1, 2"};
    EXPECT_EQ(texts_of(found_with(run)), expected);
    run = full_record();
    run.signal_events.reset();
    const auto without_log = found_with(run);
    ASSERT_EQ(without_log.size(), 1U);
    EXPECT_EQ(without_log[0].column, "signal_events_hash");
    EXPECT_EQ(without_log[0].other, "missing");
}

TEST_F(RecordDifference, IsFoundWhereOnlyTheSpellingDiffers) {
    core::Json run = record_of_other();
    std::string holds = run["traffic"]["holds"];
    ASSERT_THAT(holds, HasSubstr(",3,"));
    run["traffic"]["holds"] = holds.replace(holds.find(",3,"), 3, ",\"3\",");
    write_sealed(run);
    const auto cells = found();
    ASSERT_EQ(cells.size(), 1U);
    EXPECT_EQ(cells[0].column, "hash");
}

TEST_F(RecordDifference, IsNoneWhereTheSamePartsAreInAnotherFolder) {
    const auto with_part = [](const char* part) {
        RunRecord run = full_record();
        run.condition.settings.clear();
        run.condition.policies = {part};
        return run;
    };
    std::filesystem::remove_all(one_.run_folder(key));
    one_.write(with_part("/home/a/mine.py:Mine@1cb61cb61cb61cb6"), {});
    EXPECT_THAT(found_with(with_part("/home/b/mine.py:Mine@1cb61cb61cb61cb6")), IsEmpty());
    EXPECT_THAT(found_with(with_part("/home/b/mine.py:Mine@2222222222222222")), testing::SizeIs(1));
}

TEST_F(RecordDifference, RefusesATableThatIsNoCsv) {
    core::Json run = record_of_other();
    run["traffic"]["holds"] = "signal,holds,held_s\n\"J,3,41.5\n";
    write_sealed(run);
    try {
        found();
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(),
                    testing::AllOf(HasSubstr("run.json: traffic.holds"), HasSubstr("a quote is not closed")));
    }
}

}  // namespace
}  // namespace clearway::results
