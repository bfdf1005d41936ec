#pragma once

#include <string>
#include <vector>

#include "core/files.hpp"
#include "user.hpp"

namespace clearway::cli {

inline const std::string recording = "out/recordings/line/mine/00000.h5";
inline const std::string run_of_mine = "out/line/mine/0";

/// A user with a study of one short run a condition: `baseline`, `mine`, and `mine` while nothing fails.
class RecordedRunTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write_line_scenario();
    }
    Ended run(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {
            "run",          "line",      "--seeds", "1",           "--out", "out",    "--no-solo", "--policy",
            "dissertation", "--failure", "B10",     "--predictor", "none",  "--name", "mine"};
        words.insert(words.end(), more.begin(), more.end());
        return clearway(words);
    }
    void damage(const std::string& file, const std::string& from, const std::string& to) const {
        std::string text = read(file);
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << file;
        text.replace(at, from.size(), to);
        core::write_atomically(folder() / file, text);
    }
};

}  // namespace clearway::cli
