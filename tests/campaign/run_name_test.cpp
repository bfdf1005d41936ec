#include "campaign/run_name.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "results/synthetic.hpp"
#include "support/temporary_folder.hpp"
#include "trace/recording.hpp"

namespace clearway::campaign {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class RunName : public testing::Test {
  protected:
    const support::TemporaryFolder folder;
    const results::Store store =
        results::Store::create(folder.path() / "mine", results::synthetic::manifest());

    std::string name(const std::string& end) const { return (folder.path() / "mine").string() + "/" + end; }
    std::string error_of(const std::string& word) const {
        try {
            run_named(word, "RUN");
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "none";
    }
};

TEST_F(RunName, IsReadAsItIsWritten) {
    store.manifest().for_each_run([&](const experiment::RunKey& key) {
        const NamedRun run = run_named(run_name(store.folder(), key), "RUN");
        EXPECT_EQ(run.key, key);
        EXPECT_TRUE(std::filesystem::equivalent(run.store.folder(), store.folder()));
    });
    EXPECT_EQ(run_name("runs/mine/", {"alpha", "treated", 1}), "runs/mine/alpha/treated/1");
}

TEST_F(RunName, MayBeTheFolderOfTheRunsFiles) {
    const experiment::RunKey key{"alpha", "treated", 1};
    for (const char* const end :
         {"runs/alpha/treated/00001", "alpha/treated/00001/", "recordings/alpha/treated/1"})
        EXPECT_EQ(run_named(name(end), "RUN").key, key) << end;
}

TEST_F(RunName, OfNoRunIsRefusedWithTheNearest) {
    EXPECT_THAT(error_of(name("alpa/treatd/7")),
                AllOf(HasSubstr("mine/alpa/treatd/7: replication"), HasSubstr("Did you mean 'alpha'?"),
                      HasSubstr("Did you mean 'treated'?"), HasSubstr("`7` is not in this study"),
                      HasSubstr("0 to 1")));
    for (const char* const word : {"", "7", "alpha/7", "nowhere/alpha/treated/0"})
        EXPECT_THAT(error_of(word), AllOf(HasSubstr("is not a run"), HasSubstr(run_name_form))) << word;
    for (const char* const number : {"x", "-1", "1x", "99999999999"})
        EXPECT_THAT(error_of(name("alpha/treated/" + std::string(number))),
                    HasSubstr("is not in this study"));
}

TEST_F(RunName, LeadsToItsRecording) {
    const experiment::RunKey key{"alpha", "treated", 1};
    EXPECT_THROW(recording_named(name("alpha/treated/1"), "RUN"), core::InputError);
    const std::filesystem::path file = trace::recording_file(store.folder(), key);
    std::filesystem::create_directories(file.parent_path());
    const auto record = [&](const experiment::RunKey& held) {
        trace::RecordingInfo info;
        info.key = held;
        info.condition.name = held.condition;
        trace::RecordingWriter(file, info).finish();
    };
    record({"alpha", "baseline", 1});
    EXPECT_THROW(recording_named(name("alpha/treated/1"), "RUN"), core::InputError) << "that of another run";
    record(key);
    EXPECT_TRUE(std::filesystem::equivalent(recording_named(name("alpha/treated/1"), "RUN").file, file));
    EXPECT_TRUE(std::filesystem::equivalent(recording_named(file.string(), "RUN").file, file));
}

}  // namespace
}  // namespace clearway::campaign
