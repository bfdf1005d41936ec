#include "campaign/replay_page.hpp"

#include <cstdio>
#include <vector>

#include <fmt/format.h>

#include "campaign/run_name.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/own_output.hpp"
#include "scenario/config.hpp"
#include "scenario/network.hpp"
#include "view/drawing.hpp"
#include "view/player.hpp"
#include "view/recorded_run.hpp"

namespace clearway::campaign {
namespace {

/// In a run folder the copy of the scenario is above its network; it names the files with signal programs.
std::vector<std::filesystem::path> signal_programs_beside(const std::filesystem::path& network_file) {
    const std::filesystem::path scenario = network_file.parent_path().parent_path() / "scenario.toml";
    if (!std::filesystem::exists(scenario)) return {};
    return scenario::additional_files(scenario::load(scenario.string()));
}

void require_one_network(const trace::RecordingInfo& first, const trace::RecordingInfo& second) {
    if (first.settings.network_hash == second.settings.network_hash) return;
    throw core::InputError({"RUN RUN",
                            fmt::format("{} and {} were recorded on two networks",
                                        experiment::to_text(first.key), experiment::to_text(second.key)),
                            "two runs on one network", "Write a page for each"});
}

/// Two runs side by side differ by their conditions alone only if their demand is the same.
void say_other_traffic(const trace::RecordingInfo& first, const trace::RecordingInfo& second) {
    if (first.provenance.demand_hash == second.provenance.demand_hash) return;
    fmt::print(stderr,
               "clearway: {} (seed {}) and {} (seed {}) have different traffic: their conditions do not "
               "explain all differences between them\n",
               experiment::to_text(first.key), first.provenance.study_seed, experiment::to_text(second.key),
               second.provenance.study_seed);
}

/// `city-corridor-0.html`, `city-baseline-corridor-0.html`; names of conditions and scenarios name folders.
std::filesystem::path usual_name(const std::vector<experiment::RunKey>& keys) {
    std::string name = keys.front().scenario;
    for (const experiment::RunKey& key : keys)
        name += "-" + key.condition;
    return fmt::format("{}-{}.html", name, keys.back().replication);
}

}  // namespace

std::filesystem::path run_folder_of(const std::filesystem::path& recording) {
    return std::filesystem::absolute(recording)
        .lexically_normal()
        .parent_path()
        .parent_path()
        .parent_path()
        .parent_path();
}

roads::Network recorded_network(const trace::RecordingInfo& info, const std::filesystem::path& recording,
                                const std::filesystem::path& option) {
    const std::filesystem::path file = option.empty() ? run_folder_of(recording) / "scenarios" /
                                                            info.key.scenario / "network" / "network.net.xml"
                                                      : option;
    const std::string where = option.empty() ? file.string() : "--network " + file.string();
    if (!std::filesystem::exists(file))
        throw core::InputError({where, "is not there", "the network on which the recording was made",
                                "Name it with --network, or leave the recording in its run folder"});
    if (core::content_hash(core::read_file(file)) != info.settings.network_hash)
        throw core::InputError({where, "is not the network on which the recording was made",
                                "content hash " + info.settings.network_hash, "Name it with --network"});
    return roads::Network::read(file, signal_programs_beside(file));
}

std::vector<double> recorded_mean_times(const trace::RecordingInfo& info,
                                        const std::filesystem::path& recording,
                                        const std::filesystem::path& option) {
    const std::filesystem::path folder = run_folder_of(recording) / "scenarios" / info.key.scenario;
    if (!option.empty() || !std::filesystem::exists(folder / "scenario.toml")) return {};
    const scenario::ScenarioConfig config = scenario::load((folder / "scenario.toml").string());
    if (config.network.mean_times.empty()) return {};
    return scenario::open_network(config, folder / "network").mean_times_s;
}

std::string written_words(const std::filesystem::path& file, std::size_t bytes) {
    constexpr double mega = 1e6;
    constexpr double large_mb = 8.0;  // what a browser takes a second or two to unpack
    const double size_mb = static_cast<double>(bytes) / mega;
    return fmt::format("written: {}, {:.1f} MB; open it in a browser{}", file.string(), size_mb,
                       size_mb < large_mb
                           ? ""
                           : ". For a smaller page, choose a part of the run: --from SECONDS --to SECONDS");
}

core::ExitCode write_replay_page(const ReplayPage& page) {
    std::vector<NamedRecording> recordings;
    std::vector<experiment::RunKey> keys;
    std::string title;
    for (const std::string& run : page.runs) {
        recordings.push_back(recording_named(run, "RUN"));
        const trace::RecordingInfo& info = recordings.back().reader->info();
        require_one_network(recordings.front().reader->info(), info);
        say_other_traffic(recordings.front().reader->info(), info);
        keys.push_back(info.key);
        title += (title.empty() ? "" : " and ") + experiment::to_text(info.key);
    }
    const roads::Network network =
        recorded_network(recordings.front().reader->info(), recordings.front().file, page.network);
    view::Play play;
    play.title = title;
    for (const NamedRecording& recording : recordings)
        play.runs.push_back(view::view_of(*recording.reader, network, page.window, {}));
    const std::filesystem::path file = page.file.empty() ? usual_name(keys) : page.file;
    const std::string text = view::player_page(title, {{view::drawing_of(network)}, {play}});
    core::write_own(file, text, {"a page of clearway replay --view", view::page_mark});
    fmt::print("{}\n", file.string());
    fmt::print(stderr, "clearway: {}\n", written_words(file, text.size()));
    return core::ExitCode::ok;
}

}  // namespace clearway::campaign
