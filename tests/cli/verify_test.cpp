// Runs that are made again and compared, as a user meets them.
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "recorded_run.hpp"

namespace clearway::cli {
namespace {

using VerifyTest = RecordedRunTest;

TEST_F(VerifyTest, finds_runs_the_same) {
    ASSERT_EQ(run().code, 0);
    const Ended one = clearway({"verify", "out/line/mine/0"});
    EXPECT_EQ(one.code, 0) << one.err;
    EXPECT_THAT(one.out, testing::ContainsRegex("same +out/line/mine/0  [0-9a-f]+"));
    const Ended all = clearway({"verify", "out", "--all", "--json"});
    EXPECT_EQ(all.code, 0) << all.err;
    const auto json = nlohmann::json::parse(all.out);
    EXPECT_EQ(json.at("same"), 3) << "baseline, mine, and mine while nothing fails";
    EXPECT_EQ(json.at("runs").size(), 3U);
    EXPECT_EQ(
        nlohmann::json::parse(clearway({"verify", "out", "--sample", "1", "--json"}).out).at("verified"), 1);
}

TEST_F(VerifyTest, samples_each_condition_or_names_those_left_out) {
    ASSERT_EQ(clearway({"run", "line", "--seeds", "4", "--out", "out", "--no-solo", "--policy",
                        "dissertation", "--failure", "B10", "--predictor", "none", "--name", "mine"})
                  .code,
              0);
    const auto sampled = [](const Ended& ended) {
        std::multiset<std::string> conditions;
        const auto rows = nlohmann::json::parse(ended.out).at("runs");
        for (const auto& row : rows) {
            const std::string name = row.at("run");
            conditions.insert(name.substr(0, name.rfind('/')));
        }
        return conditions;
    };
    const std::multiset<std::string> six = sampled(clearway({"verify", "out", "--sample", "6", "--json"}));
    EXPECT_EQ(six.size(), 6U);
    for (const std::string& condition : six)
        EXPECT_EQ(six.count(condition), 2U) << condition;
    const Ended two = clearway({"verify", "out", "--sample", "2"});
    EXPECT_THAT(two.out, testing::ContainsRegex("Not sampled: .*\\. --sample 3 takes a run of each"));
}

TEST_F(VerifyTest, tells_where_a_run_differs) {
    ASSERT_EQ(run({"--record"}).code, 0);
    // A network that someone changed with its hash: the same run is another one now.
    const std::string network = "out/scenarios/line/network/network.net.xml";
    damage(network, "speed=\"20.00\"", "speed=\"12.00\"");
    write("out/scenarios/line/network/network.hash", core::content_hash(read(network)));
    const Ended ended = clearway({"verify", "out/line/baseline/0"});
    EXPECT_EQ(ended.code, 7) << ended.err << ended.out;
    EXPECT_THAT(ended.out, AllOf(testing::ContainsRegex("different +out/line/baseline/0"),
                                 HasSubstr("provenance: trace_hash: stored "), HasSubstr("vehicles row 1 ("),
                                 HasSubstr("recordings first differ at "), HasSubstr(" s, snapshot: ")));
}

TEST_F(VerifyTest, compares_all_that_a_record_holds) {
    ASSERT_EQ(run().code, 0);
    // Numbers that somebody edited together with the hash of the record.
    const std::string file = "out/runs/line/mine/00000/run.json";
    auto record = nlohmann::ordered_json::parse(read(file));
    const auto issued = record.at("leases").at(0).at("issued").get<int>();
    record["leases"][0]["issued"] = issued + 1000;
    std::string times = record.at("traffic").at("edge_times");
    ASSERT_NE(times.find(",first,"), std::string::npos);
    record["traffic"]["edge_times"] = times.replace(times.find(",first,"), 7, ",first,1000");
    record.erase("hash");
    record["hash"] = core::content_hash(record.dump(2) + "\n");
    write(file, record.dump(2) + "\n");
    const Ended ended = clearway({"verify", run_of_mine});
    EXPECT_EQ(ended.code, 7) << ended.err << ended.out;
    EXPECT_THAT(ended.out,
                AllOf(testing::ContainsRegex("different +" + run_of_mine),
                      HasSubstr(fmt::format("leases row 1 (dissertation): issued: stored {}, now {}",
                                            issued + 1000, issued)),
                      HasSubstr("traffic.edge_times row 1 (emergency.0): entered_s: stored 1000"),
                      Not(HasSubstr("metrics"))));
}

TEST_F(VerifyTest, names_what_was_changed_beside_the_records) {
    ASSERT_EQ(run().code, 0);
    const auto expect_refused = [&](const std::string& file, const std::string& what) {
        const Ended ended = clearway({"verify", "out", "--all"});
        EXPECT_EQ(ended.code, 3) << ended.err << ended.out;
        EXPECT_THAT(ended.out, IsEmpty());
        EXPECT_THAT(ended.err, AllOf(HasSubstr("clearway: out/scenarios/line/" + file + ": " + what),
                                     HasSubstr("remove out/scenarios/line"), Not(HasSubstr("run.json"))));
    };
    const auto check_edit = [&](const std::string& file, const std::string& from, const std::string& what) {
        const std::string whole = read("out/scenarios/line/" + file);
        damage("out/scenarios/line/" + file, from, from + "1");
        const std::string blamed = file.starts_with("network/") ? file : "scenario.toml";
        expect_refused(blamed, what);
        write("out/scenarios/line/" + file, whole);
    };
    check_edit("network/network.net.xml", "speed=\"", "was changed since it was built");
    check_edit("scenario.toml", "human = ", "was changed, or a file beside it, since the study began");
    check_edit("line.edg.xml", "speed=\"", "was changed, or a file beside it, since the study began");
    EXPECT_EQ(clearway({"verify", "out", "--all"}).code, 0) << "all is put back";
    for (const std::string file : {"network/network.net.xml", "scenario.toml"}) {
        std::filesystem::remove(folder() / "out/scenarios/line" / file);
        expect_refused(file, "is missing");
    }
}

TEST_F(VerifyTest, refuses_what_it_cannot_compare) {
    ASSERT_EQ(run().code, 0);
    const Ended unknown = clearway({"verify", "out/lin/basline/4"});
    EXPECT_EQ(unknown.code, 3);
    EXPECT_THAT(unknown.err, AllOf(HasSubstr("Did you mean 'line'?"), HasSubstr("Did you mean 'baseline'?"),
                                   HasSubstr("`4` is not in this study")));
    EXPECT_EQ(clearway({"verify", "out/line"}).code, 3);
    EXPECT_EQ(clearway({"verify", "out"}).code, 3);
    EXPECT_EQ(clearway({"verify", "out/line/mine/0", "--all"}).code, 3);
    EXPECT_EQ(clearway({"verify", "nowhere", "--all"}).code, 3);
    const Ended itself = clearway({"verify", "out", "--all", "--out", "./out"});
    EXPECT_EQ(itself.code, 3);
    EXPECT_THAT(itself.err, HasSubstr("is the folder to verify"));
    damage("out/runs/line/mine/00000/run.json", "\"arrived\": ", "\"arrived\": 1");
    const Ended damaged = clearway({"verify", "out/line/mine/0"});
    EXPECT_EQ(damaged.code, 3) << damaged.out;
    EXPECT_THAT(damaged.out, AllOf(HasSubstr("damaged"), HasSubstr("run.json: hash")));
    std::filesystem::remove_all(folder() / "out/runs/line/mine");
    const Ended missing = clearway({"verify", "out/line/mine/0"});
    EXPECT_EQ(missing.code, 5);
    EXPECT_THAT(missing.err, HasSubstr("has not been made yet"));
    EXPECT_THAT(missing.out, IsEmpty());
}

TEST_F(VerifyTest, refuses_another_version_of_sumo) {
    ASSERT_EQ(run().code, 0);
    // A manifest as another SUMO would have left it; its hash is that of the changed text.
    auto manifest = nlohmann::ordered_json::parse(read("out/manifest.json"));
    manifest["sumo_version"] = "1.99.0";
    manifest.erase("hash");
    manifest["hash"] = core::content_hash(manifest.dump(2) + "\n");
    write("out/manifest.json", manifest.dump(2) + "\n");
    const Ended ended = clearway({"verify", "out/line/mine/0"});
    EXPECT_EQ(ended.code, 4) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("SUMO 1.99.0 in the study"));
}

}  // namespace
}  // namespace clearway::cli
