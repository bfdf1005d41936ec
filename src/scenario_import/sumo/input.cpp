#include "scenario_import/sumo/input.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/error.hpp"
#include "scenario_import/detail/source.hpp"

namespace clearway::scenario_import::detail {

namespace {

class InputReader {
  public:
    explicit InputReader(const TakeInput& take) : take_(take) {}

    void read(const std::filesystem::path& file) {
        open_.push_back(file.lexically_normal());
        for_each_element(file, [&](Element&& element) { take(std::move(element), file); });
        open_.pop_back();
    }

  private:
    void take(Element&& element, const std::filesystem::path& file) {
        if (element.name == "include")
            include(element, file);
        else if (element.name == "interval" && std::ranges::any_of(element.children, is_demand))
            take_interval(std::move(element), file);
        else
            take_(std::move(element), file);
    }

    void include(const Element& element, const std::filesystem::path& file) {
        const std::filesystem::path included = (file.parent_path() / element.text("href")).lexically_normal();
        const std::string place = fmt::format("{}:{}: include", file.string(), element.line);
        if (!std::filesystem::is_regular_file(included))
            throw core::InputError(core::Problem{place, fmt::format("no file {}", included.string()),
                                                 "an existing file", "correct the path"});
        if (core::contains(open_, included))
            throw core::InputError(
                core::Problem{place, fmt::format("{} includes itself", included.filename().string()),
                              "files that do not include each other in a circle", "remove the include"});
        refuse_bomb(included);
        read(included);
    }

    void take_interval(Element&& interval, const std::filesystem::path& file) {
        for (Element& child : interval.children) {
            if (child.name == "flow" || child.name == "personFlow")
                for (const char* const name : {"begin", "end"})
                    if (!child.has(name) && interval.has(name)) child.set(name, interval.text(name));
            take(std::move(child), file);
        }
    }

    static bool is_demand(const Element& element) {
        constexpr std::array names = {"flow", "vehicle", "trip", "person", "personFlow"};
        return core::contains(names, element.name);
    }

    const TakeInput& take_;
    std::vector<std::filesystem::path> open_;
};

}  // namespace

void for_each_input(const std::filesystem::path& file, const TakeInput& take) {
    InputReader(take).read(file);
}

}  // namespace clearway::scenario_import::detail
