#include "campaign/recorded_network.hpp"

#include <vector>

#include "core/error.hpp"
#include "core/files.hpp"
#include "scenario/config.hpp"

namespace clearway::campaign {
namespace {

/// In a run folder the copy of the scenario is above its network; it names the files with signal programs.
std::vector<std::filesystem::path> signal_programs_beside(const std::filesystem::path& network_file) {
    const std::filesystem::path scenario = network_file.parent_path().parent_path() / "scenario.toml";
    if (!std::filesystem::exists(scenario)) return {};
    return scenario::additional_files(scenario::load(scenario.string()));
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

}  // namespace clearway::campaign
