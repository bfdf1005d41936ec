#pragma once

#include <filesystem>
#include <system_error>
#include <utility>

#include "core/files.hpp"

namespace clearway::loop::detail {

/// Makes its folder, and removes it in the end.
class WorkFolder {
  public:
    explicit WorkFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
        core::make_folder(folder_);
    }
    ~WorkFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    const std::filesystem::path& path() const { return folder_; }

  private:
    std::filesystem::path folder_;
};

}  // namespace clearway::loop::detail
