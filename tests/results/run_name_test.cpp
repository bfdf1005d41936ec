#include "results/run_name.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "results/synthetic.hpp"
#include "support/temporary_folder.hpp"
#include "trace/recording.hpp"

namespace clearway::results {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class RunName : public testing::Test {
  protected:
    const support::TemporaryFolder folder;
    const Store store = Store::create(folder.path() / "mine", synthetic::manifest());

    /// By its name; of campaign, by its title too.
    static std::string called(const std::string& word, const Store& opened, const std::string& where) {
        for (const experiment::ConditionSpec& condition : opened.manifest().conditions)
            if (condition.name == word) return word;
        throw core::InputError({where, "is unknown", "", core::did_you_mean(word, {"treated"})});
    }
    std::string name(const std::string& end) const { return (folder.path() / "mine").string() + "/" + end; }
    std::string error_of(const std::string& word) const {
        try {
            run_named(word, "RUN", called);
        } catch (const core::InputError& error) {
            return error.what();
        }
        return "none";
    }
};

TEST_F(RunName, IsReadAsItIsWritten) {
    store.manifest().for_each_run([&](const experiment::RunKey& key) {
        const NamedRun run = run_named(run_name(store.folder(), key), "RUN", called);
        EXPECT_EQ(run.key, key);
        EXPECT_TRUE(std::filesystem::equivalent(run.store.folder(), store.folder()));
    });
    EXPECT_EQ(run_name("runs/mine/", {"alpha", "treated", 1}), "runs/mine/alpha/treated/1");
}

TEST_F(RunName, MayBeTheFolderOfTheRunsFiles) {
    const experiment::RunKey key{"alpha", "treated", 1};
    for (const char* const end :
         {"runs/alpha/treated/00001", "alpha/treated/00001/", "recordings/alpha/treated/1"})
        EXPECT_EQ(run_named(name(end), "RUN", called).key, key) << end;
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
    EXPECT_THROW(recording_named(name("alpha/treated/1"), "RUN", called), core::InputError);
    const std::filesystem::path file = trace::recording_file(store.folder(), key);
    std::filesystem::create_directories(file.parent_path());
    const auto record = [&](const experiment::RunKey& held) {
        trace::RecordingInfo info;
        info.key = held;
        info.condition.name = held.condition;
        trace::RecordingWriter(file, info).finish();
    };
    record({"alpha", "baseline", 1});
    EXPECT_THROW(recording_named(name("alpha/treated/1"), "RUN", called), core::InputError)
        << "that of another run";
    record(key);
    EXPECT_TRUE(
        std::filesystem::equivalent(recording_named(name("alpha/treated/1"), "RUN", called).file, file));
    EXPECT_TRUE(std::filesystem::equivalent(recording_named(file.string(), "RUN", called).file, file));
}

}  // namespace
}  // namespace clearway::results
