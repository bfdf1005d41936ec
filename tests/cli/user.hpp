#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "core/process.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::cli {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// How a program ended and what it said.
struct Ended {
    int code = 0;  ///< As a shell sees it: 128 + signal for a killed program.
    std::string out;
    std::string err;
};

/// How a command line is run beside its words.
struct Environment {
    std::map<std::string, std::string> environment = {};
    std::string before = {};  ///< Shell commands that come first, for example `ulimit -f 1`.
    std::string output = {};  ///< Where standard output goes instead of being read.
};

/// Whether `clearway-train` is built and starts: not without libtorch and XGBoost (packages of part `train`).
bool has_trainer();

/// A test that drives the real `clearway` in a temporary folder, as a user does.
class UserTest : public testing::Test {
  protected:
    void SetUp() override;

    /// Runs `clearway WORDS` in the folder and waits.
    Ended clearway(const std::vector<std::string>& words, const Environment& environment = {}) const;
    /// Starts it; its process id is that of `clearway` itself. `finish` collects it.
    core::Child start(const std::vector<std::string>& words, const Environment& environment = {}) const;
    Ended finish(const core::Child& child) const;

    /// Runs `clearway WORDS` on a terminal of this kind with so many columns and waits; `out` holds all that
    /// it showed.
    Ended on_terminal(const std::vector<std::string>& words, int columns,
                      const std::string& kind = "xterm") const;

    /// A file of the folder.
    std::string read(const std::string& name) const;
    const std::filesystem::path& folder() const { return folder_.path(); }
    std::filesystem::path write(const std::string& name, const std::string& text) const;
    /// An executable script that prints `text`.
    void write_program(const std::string& name, const std::string& text) const;

    /// A run of `seeds` replications of the line under two conditions.
    static std::vector<std::string> two_conditions(const std::string& out, int seeds, int jobs = 1) {
        return {"run",   "line", "--seeds",   std::to_string(seeds), "--jobs",          std::to_string(jobs),
                "--out", out,    "--no-solo", "--condition",         "graph_simulation"};
    }
    /// Writes the scenario `line` into a folder of this name: 600 m of two lanes, nine vehicles, one of them
    /// emergency; a run takes a fraction of a second.
    void write_line_scenario(const std::string& replaced = "", const std::string& replacement = "") const;

  private:
    support::TemporaryFolder folder_;
};

}  // namespace clearway::cli
