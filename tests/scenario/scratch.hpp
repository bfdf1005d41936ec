#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::scenario {

/// A folder of its own for each test, removed at its end.
class ScratchTest : public ::testing::Test {
  protected:
    void SetUp() override {
        setenv("SUMO_HOME", "/usr/share/sumo", 0);
        setenv("CLEARWAY_HOME", CLEARWAY_SOURCE_DIR, 1);
    }

    std::filesystem::path write(const std::string& name, const std::string& text) const {
        return folder_.write(name, text);
    }
    const std::filesystem::path& folder() const { return folder_.path(); }

    /// The problems that `action` reports; fails when it reports none.
    template <class Action>
    static std::vector<core::Problem> problems_of(Action&& action) {
        try {
            action();
        } catch (const core::InputError& error) {
            return error.problems();
        }
        ADD_FAILURE() << "no InputError";
        return {};
    }

  private:
    support::TemporaryFolder folder_;
};

/// A straight road of two edges, one lane each, and a side road that nothing leads to.
inline constexpr const char* line_nodes =
    "<nodes><node id=\"a\" x=\"0\" y=\"0\"/><node id=\"b\" x=\"600\" y=\"0\"/><node id=\"c\" x=\"1200\" "
    "y=\"0\"/>"
    "<node id=\"d\" x=\"600\" y=\"300\"/></nodes>\n";
inline constexpr const char* line_edges =
    "<edges><edge id=\"first\" from=\"a\" to=\"b\" numLanes=\"1\" speed=\"20\"/>"
    "<edge id=\"second\" from=\"b\" to=\"c\" numLanes=\"1\" speed=\"20\"/>"
    "<edge id=\"side\" from=\"d\" to=\"b\" numLanes=\"1\" speed=\"20\"/></edges>\n";
inline constexpr const char* line_head =
    "name = \"line\"\nversion = \"test\"\n[network]\nnodes = \"line.nod.xml\"\nedges = \"line.edg.xml\"\n";

}  // namespace clearway::scenario
