#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace clearway::training::detail {

/// An uncompressed zip archive in memory (PKWARE's APPNOTE 6.3), for content below 4 GB. The data of each
/// member starts at a multiple of 64 byte, as PyTorch aligns its archives, so that readers may map them.
class ZipArchive {
  public:
    /// Names must differ; asserts the size limit.
    void add(const std::string& name, std::string_view content);
    std::string finish() &&;

  private:
    std::string bytes_;
    std::string directory_;
    std::uint16_t members_ = 0;
};

}  // namespace clearway::training::detail
