#pragma once

#include <string>

#include "core/files.hpp"
#include "user.hpp"

namespace clearway::cli {

/// A user with the scenario `./crossings`: two signals, one emergency vehicle.
class CrossingsTest : public UserTest {
  protected:
    void SetUp() override {
        UserTest::SetUp();
        write("crossings/net.net.xml",
              core::read_file(CLEARWAY_SOURCE_DIR "/tests/support/data/two_crossings.net.xml"));
        write_scenario("B_east");
    }
    /// `to`: where all vehicles go; `key`: more of the table `[network]`.
    void write_scenario(const std::string& to, const std::string& key = "") const {
        write("crossings/scenario.toml", R"(name = "crossings"
version = "v1"
title = "Two crossings"
[network]
file = "net.net.xml"
)" + key + R"([time]
warm_up_s = 20.0
window_s = 60.0
horizon_s = 400.0
[demand]
human = 5
automated = 3
emergency = 1
[[flow]]
from = "west_A"
to = ")" + to + R"("
share = 1.0
)");
    }
};

}  // namespace clearway::cli
