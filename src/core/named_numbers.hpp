#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace clearway::core {

/// Sets the numbers of configurations that `values` names by their fields; appends a problem for every name
/// that is no field of any and every value out of its range, `where` being the option or file they came from.
template <class... Configs>
void set_numbers(const std::map<std::string, double>& values, const std::string& where,
                 std::vector<Problem>& problems, Configs&... configs) {
    std::vector<std::string> names;
    const auto set = [&]<class Config>(Config& config) {
        for_each_field<Config>([&](const auto& field) {
            using Member = std::remove_cvref_t<decltype(config.*field.member)>;
            if constexpr (std::is_arithmetic_v<Member>) {
                names.emplace_back(field.name);
                const auto found = values.find(field.name);
                if (found == values.end()) return;
                if (found->second >= field.minimum && found->second <= field.maximum) {
                    config.*field.member = static_cast<Member>(found->second);
                } else {
                    problems.push_back({fmt::format("{} {}", where, field.name),
                                        fmt::format("{} is out of range", found->second),
                                        fmt::format("{} to {}", field.minimum, field.maximum), ""});
                }
            }
        });
    };
    (set(configs), ...);
    for (const auto& [name, value] : values) {
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        const std::string near = nearest(name, names);
        problems.push_back({fmt::format("{} {}", where, name), "is no setting",
                            fmt::format("{}", fmt::join(names, ", ")),
                            near.empty() ? "" : fmt::format("Did you mean `{}`?", near)});
    }
}

}  // namespace clearway::core
