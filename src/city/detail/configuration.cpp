#include "city/detail/configuration.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <fmt/format.h>

#include "city/detail/element.hpp"
#include "core/error.hpp"

namespace clearway::city::detail {

namespace {

/// What a set SUMO_HOME would say on Debian.
constexpr const char* usual_sumo_home = "/usr/share/sumo";

/// Options that only show, write or say something: their loss changes no traffic.
bool is_harmless(const std::string& option) {
    constexpr std::array parts = {
        "output",      "log",    "gui",        "xml-validation", "verbose", "warnings", "start",    "quit",
        "delay",       "game",   "osg",        "human-readable", "seed",    "threads",  "step-log", "view",
        "breakpoints", "report", "remote-port"};
    return std::ranges::any_of(parts,
                               [&](const char* part) { return option.find(part) != std::string::npos; });
}

/// `${NAME}` replaced by the environment, as SUMO does.
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

/// The name in `file`'s folder that is most like its own.
std::string nearest_file(const std::filesystem::path& file) {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(file.parent_path(), none))
        names.push_back(entry.path().filename().string());
    return core::nearest(file.filename().string(), names);
}

class ConfigurationReader {
  public:
    explicit ConfigurationReader(const std::filesystem::path& file) : file_(file) {}

    void take(const Element& element) {
        for (const Element& child : element.children)
            take(child);
        const std::string& value = element.has("value") ? element.text("value") : element.text("v");
        if (value.empty()) return;
        const std::string& name = element.name;
        if (name == "net-file" || name == "net" || name == "n") {
            const auto files = list(value, element);
            if (!files.empty()) configuration_.network = files.front();
        } else if (name == "route-files" || name == "routes" || name == "r") {
            configuration_.routes = list(value, element);
        } else if (name == "additional-files" || name == "additional" || name == "a") {
            configuration_.additional = list(value, element);
        } else if (name == "begin" || name == "b") {
            configuration_.begin_s = time_s(value);
        } else if (name == "end" || name == "e") {
            configuration_.end_s = time_s(value);
        } else if (name == "ignore-route-errors") {
            configuration_.ignores_route_errors = value != "false" && value != "0";
        } else if (!is_harmless(name)) {
            configuration_.other_options.push_back(fmt::format("{} = {}", name, value));
        }
    }

    Configuration finish() {
        if (configuration_.network.empty() && problems_.empty())
            problems_.push_back(
                {file_.string(), "names no network", "a net-file", "give the files themselves"});
        if (!problems_.empty()) throw core::InputError(problems_);
        return std::move(configuration_);
    }

  private:
    std::vector<std::filesystem::path> list(const std::string& value, const Element& element) {
        // A name with blanks is one name where it is a file.
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
                if (require(place(part), element)) files.push_back(place(part));
        }
        return files;
    }

    std::filesystem::path place(const std::string& name) const {
        return (file_.parent_path() / name).lexically_normal();
    }

    bool require(const std::filesystem::path& file, const Element& element) {
        if (std::filesystem::is_regular_file(file)) return true;
        const std::string near = nearest_file(file);
        problems_.push_back({fmt::format("{}:{}: {}", file_.string(), element.line, element.name),
                             fmt::format("no file {}", file.string()), "an existing file",
                             near.empty()
                                 ? "correct the path, or give the files themselves"
                                 : fmt::format("there is {}; correct the name, or give the files "
                                               "themselves: clearway import NET ROUTES ADDITIONAL ...",
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

}  // namespace clearway::city::detail
