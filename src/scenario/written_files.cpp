#include "scenario/written_files.hpp"

#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/xml_stream.hpp"
#include "traffic/written_files.hpp"

namespace clearway::scenario {
namespace {

class WrittenFiles : public core::XmlHandler {
  public:
    void begin(const std::filesystem::path& file) { file_ = file.string(); }

    void start(std::string_view element, const core::XmlAttributes& attributes, unsigned long line) override {
        parents_.emplace_back(element);
        line_ = line;
        if (element == "include")
            add(fmt::format("<include> of \"{}\"", attributes.find("href").value_or("")),
                "files without others inside", "Put in what it includes");
        if (element == "param") return check_parameter(attributes);
        // A file of these is read.
        if (element == "rerouter" || element == "variableSpeedSign") return;
        for (const char* const name : {"file", "output", "dest"})
            if (const auto file = attributes.find(name)) check(name, *file);
    }
    void end(std::string_view) override { parents_.pop_back(); }

    std::vector<core::Problem> take() { return std::move(problems_); }

  private:
    void check_parameter(const core::XmlAttributes& attributes) {
        const std::string_view key = attributes.find("key").value_or("");
        const std::string_view value = attributes.find("value").value_or("");
        const bool is_of_program =
            key == "file" && parents_.size() > 1 && parents_[parents_.size() - 2] == "tlLogic";
        const bool is_off = key == "has.ssm.device" && (value == "false" || value == "0");
        if (is_of_program || (traffic::lets_vehicles_write(key) && !is_off)) check(key, value);
    }

    void check(std::string_view name, std::string_view file) {
        if (file.empty() || file == "NUL" || file == "nul" || file == "/dev/null") return;
        const std::string& element = parents_.back() == "param" && parents_.size() > 1
                                         ? parents_[parents_.size() - 2]
                                         : parents_.back();
        add(fmt::format("<{}> lets SUMO write files: {}=\"{}\"", element, name, file), "NUL",
            "Take it out: a run writes tables of its own");
    }

    void add(std::string what, std::string allowed, std::string cure) {
        constexpr std::size_t most_problems = 20;
        if (problems_.size() < most_problems)
            problems_.push_back(
                {fmt::format("{}:{}", file_, line_), std::move(what), std::move(allowed), std::move(cure)});
    }

    std::string file_;
    unsigned long line_ = 0;
    std::vector<std::string> parents_;
    std::vector<core::Problem> problems_;
};

}  // namespace

void refuse_written_files(const std::filesystem::path& network,
                          const std::vector<std::filesystem::path>& additional) {
    WrittenFiles written;
    written.begin(network);
    core::stream_xml(network, written);
    for (const std::filesystem::path& file : additional) {
        written.begin(file);
        core::stream_xml(file, written);
    }
    std::vector<core::Problem> problems = written.take();
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

}  // namespace clearway::scenario
