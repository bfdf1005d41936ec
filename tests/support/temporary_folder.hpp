#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/temporary_folder.hpp"

namespace clearway::support {

/// A temporary folder into which a test writes its files.
class TemporaryFolder : public core::TemporaryFolder {
  public:
    /// Writes `content` to a file of this folder and answers its path.
    std::filesystem::path write(const std::string& name, std::string_view content) const {
        std::ofstream stream(path() / name, std::ios::binary);
        stream << content;
        if (!stream.flush()) throw std::runtime_error("cannot write " + name);
        return path() / name;
    }
};

}  // namespace clearway::support
