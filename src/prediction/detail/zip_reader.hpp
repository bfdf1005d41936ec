#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace clearway::prediction::detail {

/// A member of a zip archive.
struct ZipEntry {
    std::string name;
    std::string_view content;  ///< Of the archive's bytes.
    std::uint32_t crc = 0;     ///< As the directory says.
};

/// The members of an uncompressed zip archive (PKWARE's APPNOTE 6.3), as its directory lists them. Sizes and
/// places come from the directory alone: PyTorch leaves those of the local headers empty. Everything is
/// checked against the bytes that there are, and each member against its CRC-32. Throws core::InputError,
/// `source` being the file that messages name: no archive, cut off, compressed, encrypted, of several
/// volumes, beyond 4 GB or 4096 members, a name twice, members that overlap, a checksum that differs.
std::vector<ZipEntry> zip_entries(std::string_view bytes, const std::string& source);

/// Whether `bytes` start as zip archives do.
bool starts_as_zip(std::string_view bytes);

}  // namespace clearway::prediction::detail
