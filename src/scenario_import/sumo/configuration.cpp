#include "scenario_import/sumo/configuration.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "core/error.hpp"
#include "scenario/config.hpp"
#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/source.hpp"

namespace clearway::scenario_import::detail {

namespace {

/// The usual SUMO_HOME on Debian.
constexpr const char* usual_sumo_home = "/usr/share/sumo";

/// Options that only show, write or print something, or control how a run is computed: dropping them changes
/// no traffic. Exact names: `max-depart-delay` is not `delay`.
bool is_harmless(const std::string& option) {
    constexpr std::array<std::string_view, 37> names = {"verbose",
                                                        "v",
                                                        "no-warnings",
                                                        "W",
                                                        "warnings",
                                                        "aggregate-warnings",
                                                        "suppress-warnings",
                                                        "print-options",
                                                        "log",
                                                        "l",
                                                        "message-log",
                                                        "error-log",
                                                        "no-step-log",
                                                        "step-log",
                                                        "step-log.period",
                                                        "no-duration-log",
                                                        "duration-log.disable",
                                                        "duration-log.statistics",
                                                        "duration-log",
                                                        "start",
                                                        "S",
                                                        "quit-on-end",
                                                        "Q",
                                                        "delay",
                                                        "d",
                                                        "breakpoints",
                                                        "demo",
                                                        "D",
                                                        "human-readable-time",
                                                        "seed",
                                                        "random",
                                                        "threads",
                                                        "precision",
                                                        "precision.geo",
                                                        "remote-port",
                                                        "num-clients",
                                                        "language"};
    constexpr std::array<std::string_view, 9> parts = {
        "output", "gui", "xml-validation", "game", "osg", "view", "save-state", "device.ssm", "device.fcd"};
    return core::contains(names, option) || std::ranges::any_of(parts, [&](std::string_view part) {
               return option.find(part) != std::string::npos;
           });
}

/// Replaces `${NAME}` from the environment, as SUMO does.
std::string expanded(std::string text) {
    for (std::size_t open = text.find("${"); open != std::string::npos; open = text.find("${", open + 1)) {
        const std::size_t close = text.find('}', open);
        if (close == std::string::npos) break;
        const std::string name = text.substr(open + 2, close - open - 2);
        const char* value = std::getenv(name.c_str());
        if (value == nullptr && name == "SUMO_HOME") value = usual_sumo_home;
        if (value != nullptr) text.replace(open, close - open + 1, value);
    }
    return text;
}

/// What an option names.
enum class Wanted : std::uint8_t { network, demand };

bool is_wanted(const std::filesystem::path& file, Wanted wanted) {
    try {
        const SourceKind kind = kind_of(file);
        return wanted == Wanted::network ? kind == SourceKind::network
                                         : kind == SourceKind::routes || kind == SourceKind::additional;
    } catch (const core::InputError&) {
        return false;
    }
}

/// The most similar name of a file of that kind in the folder of `file`.
std::string nearest_file(const std::filesystem::path& file, Wanted wanted) {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(file.parent_path(), none))
        if (entry.is_regular_file(none) && is_wanted(entry.path(), wanted))
            names.push_back(entry.path().filename().string());
    return core::nearest(file.filename().string(), names);
}

class ConfigurationReader {
  public:
    explicit ConfigurationReader(const std::filesystem::path& file) : file_(file) {}

    void take(const Element& element) {
        for (const Element& child : element.children)
            take(child);
        std::string value = element.has("value") ? element.text("value") : element.text("v");
        if (value.empty()) value = element.content;
        if (value.empty()) return;
        const std::string& name = element.name;
        if (name == "net-file" || name == "net" || name == "n")
            take_network(list(value, element, Wanted::network), element);
        else if (name == "route-files" || name == "routes" || name == "r")
            configuration_.routes = list(value, element, Wanted::demand);
        else if (name == "additional-files" || name == "additional" || name == "a")
            configuration_.additional = list(value, element, Wanted::demand);
        else
            take_option(name, value);
    }

    Configuration finish() {
        if (configuration_.network.empty() && problems_.empty())
            problems_.push_back(
                {file_.string(), "names no network", "a net-file", "give the files themselves"});
        const std::optional<double> begin_s = configuration_.begin_s;
        const std::optional<double> end_s = configuration_.end_s;
        if (end_s && *end_s >= 0.0 && *end_s <= begin_s.value_or(0.0))
            problems_.push_back(
                {file_.string(),
                 fmt::format("ends at {} s, before its begin at {} s", *end_s, begin_s.value_or(0.0)),
                 "an end after the begin", "correct begin or end"});
        if (!problems_.empty()) throw core::InputError(problems_);
        return std::move(configuration_);
    }

  private:
    void take_network(const std::vector<std::filesystem::path>& files, const Element& element) {
        if (files.empty()) return;
        if (files.size() > 1 || !configuration_.network.empty())
            problems_.push_back({fmt::format("{}:{}: {}", file_.string(), element.line, element.name),
                                 "is a second network", "one network", "remove one"});
        configuration_.network = files.front();
    }

    void take_begin(const std::string& value) {
        configuration_.begin_s = time_s(value);
        const double begin_s = configuration_.begin_s.value_or(-1.0);
        if (begin_s >= 0.0 && begin_s <= latest_departure_s) return;
        problems_.push_back({fmt::format("{}: begin", file_.string()),
                             fmt::format("\"{}\" is not possible", value),
                             fmt::format("a time from 0 to {:g} s", latest_departure_s), "correct it"});
    }

    void take_option(const std::string& name, const std::string& value) {
        if (name == "begin" || name == "b")
            take_begin(value);
        else if (name == "end" || name == "e")
            configuration_.end_s = time_s(value);
        else if (name == "scale" && number(value).value_or(-1.0) >= 0.0)
            configuration_.scale = *number(value);
        else if (name == "step-length" && time_s(value).value_or(0.0) > 0.0)
            configuration_.step_length_s = *time_s(value);
        else if (name == "time-to-teleport" && time_s(value))
            configuration_.time_to_teleport_s = *time_s(value) > 0.0 ? *time_s(value) : -1.0;
        else if (name == "ignore-junction-blocker" && time_s(value))
            configuration_.ignore_junction_blocker_s = *time_s(value) >= 0.0 ? *time_s(value) : -1.0;
        else if (name == "device.rerouting.probability" && number(value).value_or(-1.0) >= 0.0)
            configuration_.rerouting.share = *number(value);
        else if (name == "device.rerouting.period" && time_s(value).value_or(-1.0) >= 0.0)
            configuration_.rerouting.period_s = *time_s(value);
        else if (name == "lateral-resolution" && number(value).value_or(-1.0) > 0.0)
            configuration_.sublane_width_m = *number(value);
        else if (name == "ignore-route-errors")
            configuration_.ignores_route_errors = is_true(value);
        else if (core::contains(scenario::kept_options, name) && time_s(value))
            configuration_.kept_options.push_back(fmt::format("{}={:g}", name, *time_s(value)));
        else if (!is_harmless(name) && (number(value) || !is_false(value)))
            configuration_.other_options.push_back(fmt::format("{} = {}", name, value));
    }

    std::vector<std::filesystem::path> list(const std::string& value, const Element& element, Wanted wanted) {
        // A name with blanks is one name if such a file exists.
        std::vector<std::string> names = words(expanded(value), ",");
        std::vector<std::filesystem::path> files;
        for (std::string& name : names) {
            name.erase(0, name.find_first_not_of(" \t\r\n"));
            name.erase(name.find_last_not_of(" \t\r\n") + 1);
            if (std::filesystem::exists(place(name))) {
                files.push_back(place(name));
                continue;
            }
            for (const std::string& part : words(name))
                if (require(place(part), element, wanted)) files.push_back(place(part));
        }
        return files;
    }

    std::filesystem::path place(const std::string& name) const {
        return (file_.parent_path() / name).lexically_normal();
    }

    bool require(const std::filesystem::path& file, const Element& element, Wanted wanted) {
        if (std::filesystem::is_regular_file(file)) return true;
        const std::string near = nearest_file(file, wanted);
        problems_.push_back(
            {fmt::format("{}:{}: {}", file_.string(), element.line, element.name),
             fmt::format("no file {}", file.string()), "an existing file",
             near.empty() ? "correct the path, or give the files themselves"
                          : fmt::format("there is {}; correct the name, or give the files "
                                        "themselves: clearway scenario import NET ROUTES ADDITIONAL ...",
                                        near)});
        return false;
    }

    std::filesystem::path file_;
    Configuration configuration_;
    std::vector<core::Problem> problems_;
};

}  // namespace

Configuration read_configuration(const std::filesystem::path& file) {
    ConfigurationReader reader(file);
    for_each_element(file, [&](Element&& element) { reader.take(element); });
    return reader.finish();
}

}  // namespace clearway::scenario_import::detail
