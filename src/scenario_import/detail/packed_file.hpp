#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace clearway::scenario_import::detail {

enum class Packing : std::uint8_t { none, gzip, bzip2 };

/// Reads a file piece by piece and unpacks it; its first bytes tell how.
class PackedFile {
  public:
    /// Throws core::InputError when it cannot be opened.
    explicit PackedFile(const std::filesystem::path& file);
    ~PackedFile();
    PackedFile(const PackedFile&) = delete;
    PackedFile& operator=(const PackedFile&) = delete;

    Packing packing() const { return packing_; }
    /// Fills `buffer` and returns the number of bytes, 0 at the end. Throws core::InputError when the file is
    /// damaged.
    std::size_t read(std::span<char> buffer);

  private:
    struct Streams;
    std::filesystem::path file_;
    Packing packing_ = Packing::none;
    std::unique_ptr<Streams> streams_;
};

}  // namespace clearway::scenario_import::detail
