#include "cli/detail/replay_page.hpp"

#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "cli/detail/recorded_network.hpp"
#include "core/files.hpp"
#include "results/run_name.hpp"
#include "view/player.hpp"

namespace clearway::cli {
namespace {

void require_one_network(const trace::RecordingInfo& first, const trace::RecordingInfo& second) {
    if (first.settings.network_hash == second.settings.network_hash) return;
    throw core::InputError({"RUN RUN",
                            fmt::format("{} and {} were recorded on two networks",
                                        experiment::to_text(first.key), experiment::to_text(second.key)),
                            "two runs on one network", "Write a page for each"});
}

/// `city-corridor-0.html`, `city-baseline-corridor-0.html`; names of conditions and scenarios name folders.
std::filesystem::path usual_name(const std::vector<experiment::RunKey>& keys) {
    std::string name = keys.front().scenario;
    for (const experiment::RunKey& key : keys)
        name += "-" + key.condition;
    return fmt::format("{}-{}.html", name, keys.back().replication);
}

}  // namespace

core::ExitCode write_replay_page(const ReplayPage& page) {
    std::vector<results::NamedRecording> recordings;
    std::vector<experiment::RunKey> keys;
    std::string title;
    for (const std::string& run : page.runs) {
        recordings.push_back(results::recording_named(run, "RUN"));
        const trace::RecordingInfo& info = recordings.back().reader->info();
        require_one_network(recordings.front().reader->info(), info);
        keys.push_back(info.key);
        title += (title.empty() ? "" : " and ") + experiment::to_text(info.key);
    }
    const roads::Network network =
        recorded_network(recordings.front().reader->info(), recordings.front().file, page.network);
    view::Play play;
    play.title = title;
    for (const results::NamedRecording& recording : recordings)
        play.runs.push_back(view::view_of(*recording.reader, network, page.window, {}));
    const std::filesystem::path file = page.file.empty() ? usual_name(keys) : page.file;
    core::write_atomically(file, view::player_page(title, {{view::drawing_of(network)}, {play}}));
    fmt::print("{}\n", file.string());
    fmt::print(stderr, "clearway: written: {}; open it in a browser\n", file.string());
    return core::ExitCode::ok;
}

}  // namespace clearway::cli
