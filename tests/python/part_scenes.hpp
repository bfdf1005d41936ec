#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "core/files.hpp"
#include "core/settings.hpp"
#include "python/nursery.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::testing {

/// What a part in Python is shown in scenes drawn by tests, as `python3 -m clearway.conformance` shows it to
/// parts of users: part_scenes.py notes it, and the package ships it.
class PartScenes {
  public:
    PartScenes() {
        ::setenv("CLEARWAY_PACKAGE", CLEARWAY_SOURCE_DIR "/python", 1);
        nursery_.emplace();
    }

    /// The part that notes a scene, and its settings.
    static std::string recorder() { return CLEARWAY_SOURCE_DIR "/tests/python/part_scenes.py:Recorder"; }
    core::Settings settings(const std::string& scene) const {
        return {{"into", noted().string()}, {"scene", scene}};
    }

    /// Compares with a file of the package. CLEARWAY_RENEW_GOLDEN=1 writes it and fails once, so that it is a
    /// deliberate act.
    void expect_shipped(const std::string& name) const {
        const std::filesystem::path shipped = CLEARWAY_SOURCE_DIR "/python/clearway/" + name;
        const bool are_equal =
            std::filesystem::exists(shipped) && core::read_file(shipped) == core::read_file(noted());
        EXPECT_TRUE(are_equal) << name
                               << " is not what parts are shown now: CLEARWAY_RENEW_GOLDEN=1 and this "
                               << "test write it";
        if (!are_equal && std::getenv("CLEARWAY_RENEW_GOLDEN") != nullptr)
            std::filesystem::copy_file(noted(), shipped, std::filesystem::copy_options::overwrite_existing);
    }

  private:
    std::filesystem::path noted() const { return folder_.path() / "scenes.jsonl"; }

    support::TemporaryFolder folder_;
    std::optional<python::Nursery> nursery_;
};

}  // namespace clearway::testing
