#include "results/manifest.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "results/synthetic.hpp"

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
