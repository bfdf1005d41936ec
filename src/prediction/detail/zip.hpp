#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace clearway::prediction::detail {

// Uncompressed zip archives (PKWARE's APPNOTE 6.3), as torch.save writes them.

/// A member of a zip archive.
struct ZipEntry {
    std::string name;
    std::string_view content;  ///< Of the archive's bytes.
    std::uint32_t crc = 0;     ///< As the directory says.
};

/// The members of an archive, as its directory lists them. Sizes and places come from the directory alone:
/// PyTorch leaves those of the local headers empty. Everything is checked against the bytes that there are,
/// and each member against its CRC-32. Throws core::InputError, `source` being the file that messages name:
/// no archive, cut off, compressed, encrypted, of several volumes, beyond 4 GB or 4096 members, a name twice,
/// members that overlap, a checksum that differs.
std::vector<ZipEntry> zip_entries(std::string_view bytes, const std::string& source);
/// Whether `bytes` start as zip archives do.
bool starts_as_zip(std::string_view bytes);

/// An archive that is written in memory, for content below 4 GB. The data of each member start at a multiple
/// of 64 byte, as PyTorch aligns its archives, so that readers may map them.
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

}  // namespace clearway::prediction::detail
