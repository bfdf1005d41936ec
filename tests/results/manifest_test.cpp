#include "results/manifest.hpp"

#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "results/synthetic.hpp"
#include "support/message_of.hpp"

namespace clearway::results {
namespace {

TEST(Manifest, SurvivesTheWayThroughJson) {
    const Manifest manifest = synthetic::manifest();
    EXPECT_EQ(manifest_from_json(to_json(manifest), "m"), manifest);
}

TEST(Manifest, ListsEveryRunOnceSorted) {
    const auto runs = synthetic::manifest(3).runs();
    EXPECT_EQ(runs.size(), 2U * 2U * 3U);
    EXPECT_TRUE(std::ranges::is_sorted(runs));
    EXPECT_EQ(runs.front(), (experiment::RunKey{"alpha", "baseline", 0}));
}

TEST(Manifest, HasAnotherHashWhenAnythingDiffers) {
    const Manifest manifest = synthetic::manifest();
    Manifest other = manifest;
    other.study_seed = 2;
    EXPECT_NE(manifest_hash(other), manifest_hash(manifest));
    other = manifest;
    other.conditions[1].failure = "B10";
    EXPECT_NE(manifest_hash(other), manifest_hash(manifest));
    other = manifest;
    other.scenarios[0].configuration += "# changed\n";
    EXPECT_NE(manifest_hash(other), manifest_hash(manifest));
}

TEST(Manifest, NamesTheConditionsThatDifferAndWhatDiffersInThem) {
    const Manifest manifest = synthetic::manifest();
    Manifest other = manifest;
    other.conditions[0].policies = {"/here/soft.py:Soft@" + std::string(32, '1')};
    other.conditions[1].failure = "B10";
    Manifest changed = other;
    changed.conditions[0].policies = {"/there/soft.py:Soft@" + std::string(32, '2')};
    EXPECT_EQ(differences(other, changed), "conditions (Baseline: soft.py has changed)") << "by its title";
    EXPECT_EQ(differences(other, changed, {{manifest.conditions[0].name, "Today"}}),
              "conditions (Today: soft.py has changed)")
        << "by that of its study file";
    EXPECT_THAT(differences(manifest, other), testing::HasSubstr(manifest.conditions[1].name + ": failure"));
    changed = manifest;
    changed.conditions[1].name = "another";
    EXPECT_EQ(differences(manifest, changed),
              fmt::format("conditions ({} is not asked for)", manifest.conditions[1].name))
        << "new ones may come in, so they are not what blocks";
    changed = manifest;
    changed.conditions.push_back(changed.conditions[1]);
    changed.conditions.back().name = "another";
    EXPECT_EQ(differences(manifest, changed), "conditions (another is new)");
    std::swap(changed.conditions[0], changed.conditions[1]);
    EXPECT_EQ(differences(manifest, changed), "order of conditions");
    changed = manifest;
    std::swap(changed.conditions[0], changed.conditions[1]);
    EXPECT_EQ(differences(manifest, changed), "order of conditions");
}

TEST(Manifest, NamesWhatDiffersInScenarios) {
    Manifest stored = synthetic::manifest();
    ScenarioEntry& before = stored.scenarios[0];
    before.configuration =
        "name = \"alpha\"\n\n[demand]\ndensity = 1.0\n\n[road]\nfriction = 1.0\n\n[dense]\nfactor = 7.0\n";
    Manifest wanted = stored;
    ScenarioEntry& now = wanted.scenarios[0];
    now.configuration = "name = \"alpha\"\n\n[demand]\ndensity = 7.0\n\n[road]\nfriction = 1.0\n";
    now.variant = "dense";
    EXPECT_EQ(differences(stored, wanted), "scenarios (alpha: variant: standard there, dense now)");
    EXPECT_EQ(manifest_from_json(to_json(wanted), "m"), wanted);
    now = before;
    now.configuration =
        "name = \"alpha\"\n\n[demand]\ndensity = 2.0\n\n[road]\nfriction = 0.5\n\n[dense]\nfactor = 7.0\n";
    EXPECT_EQ(
        differences(stored, wanted),
        "scenarios (alpha: demand.density: 1.0 there, 2.0 now; alpha: road.friction: 1.0 there, 0.5 now)");
    now.configuration = before.configuration + "\n[limits]\na_kmh = 1\nb_kmh = 2\n";
    EXPECT_EQ(differences(stored, wanted), "scenarios (alpha: limits: none there, a_kmh 1, b_kmh 2 now)");
    now = before;
    now.configuration_hash = std::string(32, 'b');
    EXPECT_EQ(differences(stored, wanted), "scenarios (alpha: its files)");
    now = before;
    now.name = "gamma";
    EXPECT_EQ(differences(stored, wanted), "scenarios (alpha is not asked for; gamma is new)");
}

TEST(Manifest, ContinuesAStudyWithFewerReplicationsOrConditions) {
    const Manifest stored = synthetic::manifest();
    Manifest wanted = stored;
    wanted.replications += 2;
    for (const std::size_t at : {std::size_t{0}, std::size_t{1}, stored.conditions.size()}) {
        Manifest more = wanted;
        const auto added = more.conditions.insert(more.conditions.begin() + static_cast<std::ptrdiff_t>(at),
                                                  stored.conditions[1]);
        added->name = "another";
        EXPECT_TRUE(continues(more, stored)) << at;
        EXPECT_FALSE(continues(stored, more)) << at;
        more.plan.emplace();
        Manifest planned = stored;
        planned.plan.emplace();
        EXPECT_FALSE(continues(more, planned)) << "a plan is about its conditions";
        more = wanted;
        std::swap(more.conditions[0], more.conditions[1]);
        EXPECT_FALSE(continues(more, stored)) << "the first baseline may be another";
    }
    wanted.conditions[1].failure = "B10";
    EXPECT_FALSE(continues(wanted, stored));
}

TEST(Manifest, OfMoreRunsThanAnyStudyHasIsRefused) {
    const auto problem_of = [](std::uint32_t replications, std::size_t scenarios) {
        Manifest manifest = synthetic::manifest(replications);
        manifest.scenarios.resize(scenarios, manifest.scenarios.front());
        return support::message_of([&] { manifest_from_json(to_json(manifest), "manifest.json"); });
    };
    EXPECT_EQ(problem_of(100000, 2), "");
    EXPECT_THAT(problem_of(100001, 2),
                testing::HasSubstr("manifest.json: replications: 100001 make 400004 runs"));
    EXPECT_THAT(problem_of(4294967295, 2),
                testing::AllOf(testing::HasSubstr("17179869180 runs"), testing::HasSubstr("at most 100000"),
                               testing::HasSubstr("from a backup")));
    EXPECT_THAT(problem_of(100000, 11), testing::HasSubstr("2200000 runs"));
}

TEST(Manifest, IsRefusedWhenEditedOrOfAnotherFormat) {
    std::string text = to_json(synthetic::manifest());
    text.replace(text.find("1.15.0"), 6, "1.16.0");
    EXPECT_THROW(manifest_from_json(text, "m"), core::InputError);
    text = to_json(synthetic::manifest());
    text.replace(text.find("\"format\": 5"), 11, "\"format\": 9");
    try {
        manifest_from_json(text, "m.json");
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("m.json: format: is 9 (allowed: 5)"),
                                                 testing::HasSubstr("version of Clearway that wrote it")));
    }
}

TEST(Manifest, IsRefusedWhenANameLeadsOutOfItsFolder) {
    for (const char* const name : {"../../escaped", "/tmp/escaped", "..", "a/b", ""}) {
        Manifest study = synthetic::manifest();
        study.study = name;
        Manifest scenario = synthetic::manifest();
        scenario.scenarios[1].name = name;
        Manifest condition = synthetic::manifest();
        condition.conditions[1].name = name;
        for (const auto& [manifest, where] :
             {std::pair(study, "m.json: study: "), std::pair(scenario, "m.json: scenarios: name: "),
              std::pair(condition, "m.json: conditions: name: ")}) {
            try {
                manifest_from_json(to_json(manifest), "m.json");
                ADD_FAILURE() << where << name;
            } catch (const core::InputError& error) {
                EXPECT_THAT(error.what(), testing::HasSubstr(where + ('"' + std::string(name)) +
                                                             "\" cannot be the name of a folder (allowed: "));
            }
        }
    }
}

}  // namespace
}  // namespace clearway::results
