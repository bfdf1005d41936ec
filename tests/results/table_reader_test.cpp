#include "results/table_reader.hpp"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sqlite3.h>
#include <sys/stat.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "results/synthetic.hpp"
#include "results/table_writer.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::results {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class TableReader : public testing::Test {
  protected:
    TableReader() : store(Store::create(folder.path(), synthetic::manifest())) {
        store.write(synthetic::record({"alpha", "baseline", 0}), {});
        store.write(synthetic::error({"alpha", "treated", 0}));
        write_tables(store);
    }
    std::string printed(const std::string& table, TableFormat format) const {
        std::ostringstream out;
        print_table(store, table, format, out);
        return out.str();
    }
    std::string error_of(const std::string& table) const {
        try {
            printed(table, TableFormat::csv);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return {};
    }
    void execute(const char* sql) const {
        sqlite3* database = nullptr;
        ASSERT_EQ(sqlite3_open((folder.path() / "results.sqlite").c_str(), &database), SQLITE_OK);
        EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK);
        sqlite3_close(database);
    }

    support::TemporaryFolder folder;
    Store store;
};

TEST_F(TableReader, ListsTheTables) {
    EXPECT_THAT(table_names(store), testing::IsSupersetOf({"errors", "leases", "runs", "study", "vehicles"}));
}

TEST_F(TableReader, KnowsTablesOfAStudyThatWasExtendedSince) {
    EXPECT_TRUE(tables_are_current(store));
    EXPECT_FALSE(tables_are_current(Store::create(folder.path(), synthetic::manifest(3))));
}

TEST_F(TableReader, PrintsTextNumbersAndWhatIsNotAvailable) {
    const std::string csv = printed("vehicles", TableFormat::csv);
    EXPECT_THAT(csv, StartsWith("scenario,condition,replication,id,class,"));
    EXPECT_THAT(csv, HasSubstr("\nalpha,baseline,0,\"e,\"\"1\"\"\",emergency,car,arrived,1.25,1.5,"));
    const auto rows = nlohmann::json::parse(printed("vehicles", TableFormat::json));
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0]["travel_time_s"], 50.1);
    EXPECT_TRUE(rows[2]["travel_time_s"].is_null());
    EXPECT_EQ(rows[2]["outcome"], "not_inserted");
}

TEST_F(TableReader, KeepsAllBitsOfASeed) {
    execute("UPDATE runs SET simulator_seed = -1");
    EXPECT_THAT(printed("runs", TableFormat::csv), HasSubstr(",18446744073709551615,"));
}

TEST_F(TableReader, NamesTheColumnsOfAnEmptyTable) {
    execute("DELETE FROM errors");
    EXPECT_EQ(printed("errors", TableFormat::csv), "scenario,condition,replication,outcome,cause,message\n");
    EXPECT_EQ(printed("errors", TableFormat::json), "[\n]\n");
}

TEST_F(TableReader, KnowsWhetherTheTablesHoldEveryRun) {
    EXPECT_TRUE(tables_are_current(store));
    store.write(synthetic::record({"alpha", "baseline", 1}), {});
    EXPECT_FALSE(tables_are_current(store));
    write_tables(store);
    store.write(synthetic::error({"beta", "treated", 1}));
    EXPECT_FALSE(tables_are_current(store));
    std::filesystem::remove(folder.path() / "results.sqlite");
    EXPECT_FALSE(tables_are_current(store));
}

TEST_F(TableReader, KnowsWhetherAllTablesAreThere) {
    for (const char* const table : {"runs.csv", "vehicles.csv", "leases.csv"}) {
        std::filesystem::remove(folder.path() / table);
        EXPECT_FALSE(tables_are_current(store)) << table;
        write_tables(store);
        EXPECT_TRUE(tables_are_current(store));
    }
}

TEST_F(TableReader, SeesThatARunWasMadeAnewWithAnotherResult) {
    const experiment::RunKey key{"alpha", "baseline", 0};
    RunRecord record = synthetic::record(key);
    const auto made_anew = [&] {
        std::filesystem::remove_all(store.run_folder(key));
        store.write(record, {});
    };
    made_anew();
    EXPECT_TRUE(tables_are_current(store)) << "the same result";
    record.metrics.emergency_travel_time_s = 77.5;
    made_anew();
    EXPECT_FALSE(tables_are_current(store));
    write_tables(store);
    EXPECT_TRUE(tables_are_current(store));
    EXPECT_THAT(printed("runs", TableFormat::csv), HasSubstr(",77.5,"));
    record.vehicles.at(0).travel_time_s = 66.5;  // Stands in another file.
    made_anew();
    EXPECT_FALSE(tables_are_current(store));
    write_tables(store);
    EXPECT_THAT(core::read_file(store.vehicles_csv()), HasSubstr(",66.5,"));
    RunError error = synthetic::error({"alpha", "treated", 0});
    error.message += " and otherwise";
    store.write(error);
    EXPECT_FALSE(tables_are_current(store));
}

TEST_F(TableReader, NoticesADatabaseThatWasEdited) {
    EXPECT_THAT(edited_tables(store), testing::IsEmpty());
    printed("runs", TableFormat::csv);
    EXPECT_THAT(edited_tables(store), testing::IsEmpty()) << "reading changes nothing";
    execute("UPDATE vehicles SET travel_time_s = 50.2 WHERE id = 'h1'");
    EXPECT_THAT(edited_tables(store), testing::ElementsAre("results.sqlite"));
    std::ofstream(store.runs_csv(), std::ios::app) << "more\n";
    EXPECT_THAT(edited_tables(store), testing::ElementsAre("results.sqlite", "runs.csv"));
    write_tables(store);
    EXPECT_THAT(edited_tables(store), testing::IsEmpty());
}

TEST_F(TableReader, RefusesAPipeInPlaceOfTheDatabase) {
    std::filesystem::remove(folder.path() / "results.sqlite");
    ASSERT_EQ(mkfifo((folder.path() / "results.sqlite").c_str(), 0600), 0);
    EXPECT_THAT(error_of("runs"), HasSubstr("results.sqlite: is neither a file nor a folder"));
    EXPECT_THROW(edited_tables(store), core::InputError);
    EXPECT_THROW(tables_are_current(store), core::InputError);
}

TEST_F(TableReader, TakesADatabaseWithoutAHashOfItsRunsAsOutOfDate) {
    execute("DELETE FROM study WHERE key = 'runs_hash'");
    EXPECT_FALSE(tables_are_current(store));
}

TEST_F(TableReader, RefusesOtherVersionsOtherFilesAndUnknownTables) {
    EXPECT_THAT(error_of("nobody; DROP TABLE runs"),
                HasSubstr("errors, leases, runs, signal_events, signals, study, vehicles"));
    execute("UPDATE study SET value = '99' WHERE key = 'format'");
    EXPECT_THAT(error_of("runs"), HasSubstr("another version: format \"99\""));
    EXPECT_THROW(tables_are_current(store), core::InputError);
    std::ofstream(folder.path() / "results.sqlite") << "no database at all, but long enough to look at";
    EXPECT_THAT(error_of("runs"), HasSubstr("results.sqlite"));
}

/// A run with an event log.
class EventLogs : public TableReader {
  protected:
    EventLogs() {
        RunRecord run = synthetic::record({"alpha", "treated", 1});
        run.signal_events = {{10.5, "J", 102, 3, "4 5", "e,1"}, {12.0, "J", 8, 1, "0", ""}};
        store.write(run, {});
    }
    std::filesystem::path log() const {
        return store.run_folder({"alpha", "treated", 1}) / "signal_events.csv";
    }
    void replace(const std::string& what, const std::string& by) const {
        std::string text = core::read_file(log());
        text.replace(text.find(what), what.size(), by);
        std::ofstream(log()) << text;
    }
};

TEST_F(EventLogs, AreATable) {
    EXPECT_THAT(table_names(store), testing::Contains("signal_events"));
    EXPECT_EQ(printed("signal_events", TableFormat::csv),
              "scenario,condition,replication,time_s,signal,event,parameter,links,vehicle,name\n"
              "alpha,treated,1,10.5,J,102,3,4 5,\"e,1\",Preempt (Call) Input On\n"
              "alpha,treated,1,12,J,8,1,0,,Phase Begin Yellow Clearance\n");
    const auto rows = nlohmann::json::parse(printed("signal_events", TableFormat::json));
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0]["event"], 102);
    EXPECT_EQ(rows[1]["links"], "0") << "a list of one";
    EXPECT_EQ(rows[0]["vehicle"], "e,1");
}

TEST_F(EventLogs, ThatAreDamagedAreToldWithTheirLine) {
    replace("12,J,8", "12,J,x");
    EXPECT_THAT(error_of("signal_events"), HasSubstr("signal_events.csv:3"));
    EXPECT_THAT(error_of("signal_events"), HasSubstr("makes it again"));
    EXPECT_THROW(store.read_signal_events({"alpha", "treated", 1}), core::InputError);
    EXPECT_EQ(store.set_damaged_aside({{"alpha", "treated", 1}}).size(), 1U);
}

TEST_F(EventLogs, ThatFitNoHashAreTold) {
    replace("10.5", "10.0");
    EXPECT_THAT(error_of("signal_events"), HasSubstr("does not fit its hash"));
}

TEST_F(EventLogs, WithOtherWordsOrOutOfOrderAreTold) {
    replace("10.5,J,102", "10.5,J,104");
    EXPECT_THAT(error_of("signal_events"), HasSubstr("event 104 is not \"Preempt (Call) Input On\""));
    replace("10.5,J,104", "13,J,102");
    EXPECT_THAT(error_of("signal_events"), HasSubstr("before that of the line above"));
}

TEST_F(TableReader, TellsWhereNoRunKeptAnEventLog) {
    EXPECT_THAT(error_of("signal_events"), HasSubstr("holds no event logs"));
    EXPECT_EQ(store.read_signal_events({"alpha", "baseline", 0}), std::nullopt);
}

}  // namespace
}  // namespace clearway::results
