#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <sqlite3.h>

#include "core/files.hpp"
#include "results/store.hpp"
#include "results/synthetic.hpp"
#include "results/table_reader.hpp"
#include "results/table_writer.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::results {
namespace {

using synthetic::record;

/// Four runs of a study of eight; one failed, three are missing.
void fill(const Store& store, std::vector<experiment::RunKey> keys) {
    for (const experiment::RunKey& key : keys)
        synthetic::write(store, record(key));
    store.write(synthetic::error({"alpha", "treated", 0}));
}

const std::vector<experiment::RunKey> keys = {
    {"alpha", "baseline", 0}, {"alpha", "baseline", 1}, {"alpha", "treated", 1}, {"beta", "baseline", 0}};

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

/// The lines of a table that is written now.
std::vector<std::string> table_lines(const Store& store, const std::filesystem::path& file) {
    write_tables(store);
    return lines_of(core::read_file(file));
}

TEST(Tables, HaveALineForEveryRunOfTheStudyWhateverBecameOfIt) {
    const support::TemporaryFolder folder;
    const Store store = Store::create(folder.path(), synthetic::manifest());
    fill(store, keys);
    const Results results = read_results(store);
    EXPECT_EQ(results.runs.size(), 4U);
    EXPECT_EQ(results.errors.size(), 1U);
    EXPECT_EQ(results.missing.size(), 3U);
    const auto lines = table_lines(store, store.runs_csv());
    ASSERT_EQ(lines.size(), 9U);
    EXPECT_THAT(lines[0], testing::StartsWith("scenario,condition,replication,outcome,cause,safety_checks,"
                                              "emergency_restricted_travel_time_s,emergency_travel_time_s,"));
    EXPECT_THAT(lines[1], testing::StartsWith("alpha,baseline,0,ok,,on,50.1,50.1,,"));
    EXPECT_THAT(lines[3], testing::StartsWith("alpha,treated,0,failed,signal,,"));
    EXPECT_THAT(lines[6], testing::StartsWith("beta,baseline,1,missing,,,"));
    for (const std::string& line : lines)
        EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(lines[0], ',')) << line;
}

TEST(Tables, QuoteNamesAndLeaveCellsEmptyForWhatThereIsNot) {
    const support::TemporaryFolder folder;
    const Store store = Store::create(folder.path(), synthetic::manifest());
    fill(store, keys);
    const auto lines = table_lines(store, store.vehicles_csv());
    ASSERT_EQ(lines.size(), 1U + 4U * 3U);
    EXPECT_EQ(lines[0],
              "scenario,condition,replication,id,class,kind,outcome,planned_depart_s,depart_s,depart_delay_s,"
              "arrival_s,travel_time_s,time_loss_s,waiting_time_s,waiting_count,route_length_m,teleports,"
              "incident_met_s");
    EXPECT_EQ(lines[1],
              "alpha,baseline,0,\"e,\"\"1\"\"\",emergency,car,arrived,1.25,1.5,0.25,51.6,50.1,"
              "5.010000000000001,0,3,1234.5,0,");
    EXPECT_EQ(lines[3], "alpha,baseline,0,h2,human,other,not_inserted,0,,,,,,,,,0,");
}

TEST(Tables, DoNotDependOnTheOrderInWhichRunsEnded) {
    const support::TemporaryFolder folder;
    const Store forward = Store::create(folder.path() / "a", synthetic::manifest());
    const Store backward = Store::create(folder.path() / "b", synthetic::manifest());
    fill(forward, keys);
    fill(backward, {keys.rbegin(), keys.rend()});
    for (const Store* store : {&forward, &backward})
        write_tables(*store);
    for (const char* file : {"runs.csv", "vehicles.csv", "leases.csv", "results.sqlite"})
        EXPECT_EQ(core::read_file(forward.folder() / file), core::read_file(backward.folder() / file))
            << file;
}

TEST(Tables, HaveALineForEveryOutcomeOfTheLeasesOfAnAction) {
    const support::TemporaryFolder folder;
    const Store store = Store::create(folder.path(), synthetic::manifest());
    RunRecord run = synthetic::record({"alpha", "treated", 0});
    run.leases.push_back({"listing_5_5",
                          traffic::LeaseKind::change_lane,
                          5,
                          2,
                          1,
                          3,
                          {{traffic::Refusal::no_room_beside, 4}}});
    store.write(run, {});
    EXPECT_EQ(store.read(run.key)->leases, run.leases);
    write_tables(store);
    EXPECT_EQ(core::read_file(folder.path() / "leases.csv"),
              "scenario,condition,replication,policy,action,outcome,reason,leases\n"
              "alpha,treated,0,listing_5_5,change_lane,issued,,5\n"
              "alpha,treated,0,listing_5_5,change_lane,renewed,,2\n"
              "alpha,treated,0,listing_5_5,change_lane,acted,,1\n"
              "alpha,treated,0,listing_5_5,change_lane,expired,,3\n"
              "alpha,treated,0,listing_5_5,change_lane,refused,no_room_beside,4\n");
}

std::string query(const std::filesystem::path& file, const std::string& sql) {
    sqlite3* database = nullptr;
    EXPECT_EQ(sqlite3_open_v2(file.c_str(), &database, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
    std::string answer;
    const auto collect = [](void* text, int columns, char** values, char**) {
        for (int column = 0; column < columns; ++column)
            *static_cast<std::string*>(text) +=
                (values[column] == nullptr ? "null" : values[column]) + std::string("|");
        return 0;
    };
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), collect, &answer, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
    return answer;
}

TEST(Tables, AreInOneDatabaseToo) {
    const support::TemporaryFolder folder;
    const Store store = Store::create(folder.path(), synthetic::manifest());
    fill(store, keys);
    write_tables(store);
    const auto file = folder.path() / "results.sqlite";
    EXPECT_EQ(query(file, "SELECT count(*), sum(emergency_travel_time_s), max(collisions) FROM runs"),
              "4|200.4|1|");
    EXPECT_EQ(query(file, "SELECT outcome, depart_s FROM vehicles WHERE id = 'h2' LIMIT 1"),
              "not_inserted|null|");
    EXPECT_EQ(query(file, "SELECT outcome, cause FROM errors ORDER BY outcome LIMIT 1"), "failed|signal|");
    EXPECT_EQ(query(file, "SELECT count(*) FROM errors WHERE outcome = 'missing'"), "3|");
    EXPECT_EQ(
        query(file,
              "SELECT typeof(waiting_count), typeof(travel_time_s) FROM vehicles WHERE id = 'h1' LIMIT 1"),
        "integer|real|");
}

TEST(Tables, HaveAColumnForEveryFactorOfTheStudy) {
    Manifest manifest = synthetic::manifest();
    manifest.conditions[0].factors = {{"part.kind", "auto"}};
    manifest.conditions[1].factors = {
        {"failure.dark_share", "-2"}, {"condition.failure", "B5"}, {"part.kind", "0.5"}};
    manifest.scenarios[1].factors = {{"scenario.demand.human", "80"}};
    const support::TemporaryFolder folder;
    const Store store = Store::create(folder.path(), manifest);
    fill(store, keys);
    synthetic::write(store, record({"beta", "treated", 1}));
    const auto lines = table_lines(store, store.runs_csv());
    EXPECT_THAT(lines[0],
                testing::HasSubstr(
                    ",safety_checks,condition.failure,failure.dark_share,part.kind,scenario.demand.human,"
                    "emergency_restricted_travel_time_s,emergency_travel_time_s,"));
    EXPECT_THAT(lines[1], testing::StartsWith("alpha,baseline,0,ok,,on,,,auto,,50.1,"));
    EXPECT_THAT(lines[3], testing::StartsWith("alpha,treated,0,failed,signal,,B5,-2,0.5,,"));
    EXPECT_THAT(lines[8], testing::StartsWith("beta,treated,1,ok,,on,B5,-2,0.5,80,50.1,"));
    for (const std::string& line : lines)
        EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(lines[0], ',')) << line;
    write_tables(store);
    EXPECT_EQ(query(folder.path() / "results.sqlite",
                    "SELECT \"condition.failure\", typeof(\"failure.dark_share\"), \"scenario.demand.human\" "
                    "FROM runs WHERE \"failure.dark_share\" < 0 ORDER BY scenario"),
              "B5|integer|null|B5|integer|80|");
    EXPECT_EQ(
        query(folder.path() / "results.sqlite",
              "SELECT name, type FROM pragma_table_info('runs') WHERE name IN ('condition.failure', "
              "'failure.dark_share', 'part.kind', 'scenario.demand.human') ORDER BY name"),
        "condition.failure|TEXT|failure.dark_share|NUMERIC|part.kind|TEXT|scenario.demand.human|NUMERIC|");
    std::ostringstream json;
    print_table(store, "runs", TableFormat::json, json);
    EXPECT_THAT(
        json.str(),
        testing::HasSubstr("\"condition.failure\":\"B5\",\"failure.dark_share\":-2,\"part.kind\":\"0.5\","
                           "\"scenario.demand.human\":80,"));
    std::ostringstream csv;
    print_table(store, "runs", TableFormat::csv, csv);
    EXPECT_THAT(csv.str(), testing::HasSubstr("beta,treated,1,on,B5,-2,0.5,80,50.1,"));
    EXPECT_EQ(Store::open(folder.path()).manifest(), manifest);
}

}  // namespace
}  // namespace clearway::results
