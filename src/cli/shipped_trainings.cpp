#include "cli/shipped_trainings.hpp"

#include <optional>

#include "cli/shipped_files.hpp"
#include "core/files.hpp"

namespace clearway::cli {

namespace fs = std::filesystem;

void copy_shipped_trainings(const fs::path& folder) {
    const std::optional<fs::path> trainings = shipped(fs::path("models") / "training");
    if (!trainings) return;
    for (const fs::directory_entry& training : fs::directory_iterator(*trainings)) {
        if (!fs::exists(training.path() / "losses.csv")) continue;
        const fs::path target = folder / training.path().filename();
        core::make_folder(target);
        for (const char* const file : {"losses.csv", "summary.json"}) {
            if (!fs::exists(training.path() / file)) continue;
            core::write_atomically(target / file, core::read_file(training.path() / file));
        }
    }
}

}  // namespace clearway::cli
