#include "links/link_run.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::links {
namespace {

using testing::AllOf;
using testing::HasSubstr;

LinkRun sample_run() {
    LinkScores scores;
    for (int i = 0; i < 300; ++i) {
        scores.add(static_cast<float>(i) / 299.0F, i % 3 == 0,
                   {.age_class = static_cast<std::size_t>(i) % age_classes,
                    .hard = i % 2 == 0,
                    .ahead_of_emergency = i % 5 == 0});
    }
    LinkRun run{.scenario = "merge \"dense\"\n",
                .configuration_hash = "abc",
                .study_seed = 8101,
                .replication = 7,
                .predictor = "kalman",
                .cases = {}};
    PlaceHistogram places;
    for (const double error_m : {0.05, 0.07, 12.0, 350.0, 9000.0})
        places.add(error_m);
    run.cases.push_back({"B10",
                         Exits::known,
                         {5, 100, 40, 3, 1, 6, 30, 4},
                         {30, 4, 5, 90, 2, 26, 11, 7},
                         scores.summary(),
                         places.errors()});
    run.cases.push_back({"perfect", Exits::unknown, {}, {}, {}});
    return run;
}

LinkTiming sample_timing() {
    return {{{"B10", Exits::known, 5, 100, 0.25}, {"perfect", Exits::unknown, 0, 0, 0.0}}};
}

class LinkRunFile : public testing::Test {
  protected:
    void SetUp() override { write_link_run(file(), sample_run(), sample_timing()); }
    std::filesystem::path file() const { return folder_.path() / "kalman-0123.links"; }
    /// The message with which reading `bytes` is refused.
    std::string refusal(const std::string& bytes) const {
        core::write_atomically(file(), bytes);
        try {
            read_link_run(file());
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "accepted";
    }

  private:
    support::TemporaryFolder folder_;
};

TEST_F(LinkRunFile, comes_back_as_it_was) {
    EXPECT_EQ(read_link_run(file()).scenario, "merge \"dense\"\n");
    EXPECT_EQ(read_link_run(file()), sample_run());
    const LinkTiming timing = read_link_timing(file());
    ASSERT_EQ(timing.cases.size(), 2U);
    EXPECT_DOUBLE_EQ(timing.cases[0].predict_s, 0.25);
    EXPECT_EQ(timing.cases[0].failure, "B10");
}

TEST_F(LinkRunFile, is_refused_when_damaged_with_the_cure) {
    const std::string bytes = core::read_file(file());
    std::string flipped = bytes;
    flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 1);
    for (const std::string& damaged : {flipped, bytes.substr(0, bytes.size() - 40), bytes + "x"})
        EXPECT_THAT(refusal(damaged),
                    AllOf(HasSubstr("kalman-0123.links"), HasSubstr("damaged"), HasSubstr("Remove it")));
    for (const char* const other : {"", "something else", "clearway links 1\n"})
        EXPECT_THAT(refusal(other), AllOf(HasSubstr("kalman-0123.links"), HasSubstr("version 2")));
}

TEST_F(LinkRunFile, with_damaged_times_is_refused_with_the_cure) {
    std::filesystem::path times = file();
    times.replace_extension(".timing.json");
    for (const char* const damaged : {"", "[1", "{\"cases\": [{\"failure\": 1}]}"}) {
        core::write_atomically(times, damaged);
        try {
            read_link_timing(file());
            FAIL() << damaged;
        } catch (const core::InputError& error) {
            EXPECT_THAT(error.what(), AllOf(HasSubstr("kalman-0123.timing.json"), HasSubstr("Remove it")));
        }
    }
}

TEST_F(LinkRunFile, is_missed_by_name) {
    std::filesystem::remove(file());
    try {
        read_link_run(file());
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("kalman-0123.links"));
    }
}

}  // namespace
}  // namespace clearway::links
