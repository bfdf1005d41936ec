#pragma once

#include <filesystem>
#include <set>
#include <vector>

namespace clearway::sumo::detail {

/// The files that SUMO has open for writing, by descriptor, so that a forked child can have its own.
class Outputs {
  public:
    /// Descriptors that are open now.
    static std::set<int> open_descriptors();

    Outputs() = default;
    /// The regular files opened for writing since `before`. All must lie in `folder` (canonical): a file
    /// elsewhere could not be given to each child. Throws core::InputError naming those that do not.
    Outputs(const std::set<int>& before, const std::filesystem::path& folder);

    /// Copies each file to its place below `folder` (canonical) and makes SUMO's descriptor point there. What
    /// SUMO has not flushed yet is in this process's memory and follows later, so the result is what one
    /// process would have written. Throws core::EnvironmentError.
    void move_to(const std::filesystem::path& folder);

  private:
    struct Output {
        int descriptor = -1;
        std::filesystem::path relative;
    };
    std::filesystem::path folder_;
    std::vector<Output> outputs_;
};

}  // namespace clearway::sumo::detail
