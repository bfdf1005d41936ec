#include "scenario/detail/network_sources.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/process.hpp"
#include "core/xml_stream.hpp"
#include "roads/controllers.hpp"
#include "scenario/written_files.hpp"

namespace clearway::scenario::detail {
namespace {

constexpr std::size_t most_lines = 12;

/// A source and the key that names it.
struct Source {
    std::string key;
    std::filesystem::path file;
};

std::vector<Source> sources_of(const ScenarioConfig& config) {
    const NetworkSource& network = config.network;
    std::vector<Source> sources;
    for (const auto& [key, file] : {std::pair{"nodes", &network.nodes}, std::pair{"edges", &network.edges},
                                    std::pair{"connections", &network.connections},
                                    std::pair{"signals", &network.signals}, std::pair{"file", &network.file}})
        if (!file->empty()) sources.push_back({fmt::format("network.{}", key), resolve(config, *file)});
    return sources;
}

/// Those that netconvert builds: it keeps no attributes of phases that the others need.
std::vector<std::string> built_controllers() {
    std::vector<std::string> built = roads::controllers();
    std::erase_if(built, roads::needs_target_phase);
    return built;
}

/// Reads the programs of a `.tll.xml`.
class Programs : public core::XmlHandler {
  public:
    explicit Programs(const std::filesystem::path& file) : file_(file.string()) {}

    void start(std::string_view element, const core::XmlAttributes& attributes, unsigned long line) override {
        if (element != "tlLogic") return;
        const std::string signal(attributes.find("id").value_or(""));
        const std::string type(attributes.find("type").value_or("static"));
        const std::string place = fmt::format("{}:{}", file_, line);
        if (roads::needs_target_phase(type))
            problems_.push_back(
                {place,
                 fmt::format("type=\"{}\" of signal \"{}\" needs phases with targetLanes, which netconvert "
                             "does not keep",
                             type, signal),
                 core::listed(built_controllers()),
                 "Write one of these, or give the network as one file: [network] file"});
        else if (auto problem = roads::controller_problem(place, signal, type))
            problems_.push_back(std::move(*problem));
    }
    void end(std::string_view) override {}
    std::vector<core::Problem> problems() { return std::move(problems_); }

  private:
    std::string file_;
    std::vector<core::Problem> problems_;
};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

/// The source that the words are about: the one that they name, or that alone holds such elements.
const Source* blamed(const std::vector<Source>& sources, const std::string& complaint) {
    for (const Source& source : sources)
        if (complaint.find(source.file.string()) != std::string::npos) return &source;
    constexpr std::array<std::pair<const char*, const char*>, 7> elements = {
        {{"tlLogic", "network.signals"},
         {"tl-logic", "network.signals"},
         {"traffic light", "network.signals"},
         {"connection '", "network.connections"},
         {"edge '", "network.edges"},
         {"Edge's '", "network.edges"},
         {"node", "network.nodes"}}};
    for (const auto& [element, key] : elements) {
        if (complaint.find(element) == std::string::npos) continue;
        for (const Source& source : sources)
            if (source.key == key) return &source;
    }
    return sources.size() == 1 ? &sources.front() : nullptr;
}

/// Problems of a network that its source does not show.
std::vector<core::Problem> problems_of_source(const ScenarioConfig& config, const std::filesystem::path& made,
                                              std::vector<core::Problem> problems) {
    std::vector<std::string> files =
        core::texts_of(sources_of(config), [](const Source& source) { return source.file.string(); });
    const char* const key = config.network.plain() ? "network" : "network.file";
    for (core::Problem& problem : problems) {
        if (!problem.where.starts_with(made.string())) continue;
        problem.where =
            fmt::format("{}: what netconvert makes of {}", config.where(key), core::listed(files));
        if (config.network.restrict != Restriction::none)
            problem.cure += ". With network.restrict = \"none\" the file is taken as it is";
    }
    return problems;
}

/// How deep elements are nested.
class Levels : public core::XmlHandler {
  public:
    void start(std::string_view, const core::XmlAttributes&, unsigned long) override {
        ++level_;
        any_ = true;
    }
    void end(std::string_view) override { --level_; }
    /// Where reading ended.
    int level() const { return level_; }
    bool any() const { return any_; }

  private:
    int level_ = 0;
    bool any_ = false;
};

/// Netconvert does not end on elements that are nested deeply. What else is wrong it says itself.
void check_levels(const std::filesystem::path& file) {
    Levels levels;
    try {
        core::stream_xml(file, levels);
    } catch (const core::InputError&) {
        // With a document type there is none either.
        if (levels.level() >= core::most_xml_levels || !levels.any()) throw;
    }
}

}  // namespace

void check_sources(const ScenarioConfig& config) {
    const NetworkSource& network = config.network;
    if (!network.plain()) return;
    for (const std::string* const file : {&network.nodes, &network.edges, &network.connections})
        if (!file->empty()) check_levels(resolve(config, *file));
    if (network.signals.empty()) return;
    const std::filesystem::path file = resolve(config, network.signals);
    Programs programs(file);
    core::stream_xml(file, programs);
    std::vector<core::Problem> problems = programs.problems();
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

std::string complaint_in(const std::filesystem::path& log, const std::filesystem::path& made,
                         const std::string& source) {
    const std::string text = core::tail(log, 1000);
    std::vector<std::string> lines;
    std::size_t begin = text.find("Error:");
    if (begin == std::string::npos) return core::tail(log, most_lines);
    while (begin < text.size() && lines.size() < most_lines) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        if (!line.empty() && !line.starts_with("Warning") && line != "Quitting (on error).")
            lines.push_back(line);
        begin = end + 1;
    }
    std::string words = fmt::format("{}", fmt::join(lines, "\n"));
    while (words.ends_with('.'))
        words.pop_back();
    return replaced(replaced(words, (made / "whole.net.xml").string(), source),
                    (made / "raw.net.xml").string(), source);
}

core::Problem refusal(const ScenarioConfig& config, const std::string& ended, const std::string& complaint) {
    const std::vector<Source> sources = sources_of(config);
    const std::string what = fmt::format("netconvert refuses this network ({}):\n{}", ended, complaint);
    if (const Source* source = blamed(sources, complaint))
        return {config.where(source->key), what, "", fmt::format("Correct {}", source->file.string())};
    std::vector<std::string> files =
        core::texts_of(sources, [](const Source& source) { return source.file.string(); });
    return {config.where("network"), what, "", fmt::format("Correct one of {}", core::listed(files))};
}

roads::Network read_made(const ScenarioConfig& config, const std::filesystem::path& made,
                         const std::vector<std::filesystem::path>& additional) {
    try {
        refuse_written_files(made, additional);
        return roads::Network::read(made, additional);
    } catch (const core::InputError& error) {
        // Lines of the made network say nothing to the user, and it does not stay: look in the user's own.
        const std::filesystem::path own = resolve(config, config.network.file);
        if (!config.network.plain() && std::filesystem::exists(own)) roads::Network::read(own, additional);
        throw core::InputError(problems_of_source(config, made, error.problems()));
    }
}

}  // namespace clearway::scenario::detail
