#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace clearway::scenario_import::detail {

/// Counts what cannot be used, by kind, with examples by name.
class LeftOut {
  public:
    static constexpr std::size_t few = 3;
    static constexpr std::size_t all = static_cast<std::size_t>(-1);

    /// Names the first `examples` of each kind.
    void add(const std::string& what, const std::string& example, std::size_t examples = few);
    std::vector<std::string> lines() const;

  private:
    struct Count {
        std::size_t number = 0;
        std::vector<std::string> examples;
    };
    std::map<std::string, Count> counts_;
};

}  // namespace clearway::scenario_import::detail
