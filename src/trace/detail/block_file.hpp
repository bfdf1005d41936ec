#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/atomic_file.hpp"

namespace clearway::trace::detail {

/// Hash of what was added, 32 hex digits; the same as core::content_hash of all of it.
class RunningHash {
  public:
    RunningHash();
    ~RunningHash();
    RunningHash(const RunningHash&) = delete;
    RunningHash& operator=(const RunningHash&) = delete;
    void add(std::string_view bytes);
    std::string digest() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// A file of compressed blocks:
//
//     "CLEARWAY"  version (u32)
//     per block: compressed length (u32)  length (u32)  XXH3-64 of the compressed bytes (u64)  zlib stream
//     end:       0 (u32)  blocks (u32)  XXH3-128 of all blocks, uncompressed (32 hex digits)
//
// Numbers are little-endian. The last hash does not depend on the version of zlib: it is the identity of the
// content.

inline constexpr std::uint32_t block_file_version = 1;

/// Written aside, and there after `finish`. Throws core::EnvironmentError.
class BlockWriter {
  public:
    explicit BlockWriter(const std::filesystem::path& file);
    void write(std::string_view block);
    void finish();
    /// Bytes of the file so far.
    std::uint64_t size() const { return size_; }
    std::string content_hash() const { return hash_.digest(); }

  private:
    void put(std::string_view bytes);

    core::AtomicFile file_;
    RunningHash hash_;
    std::string compressed_;
    std::uint32_t blocks_ = 0;
    std::uint64_t size_ = 0;
};

/// Throws core::InputError, naming the file, for one that is missing, something else, of another version, cut
/// short or damaged.
class BlockReader {
  public:
    explicit BlockReader(const std::filesystem::path& file);
    /// The next block, valid until the next call; nothing at the end, once the hash of the whole was found
    /// right.
    std::optional<std::string_view> next();
    const std::filesystem::path& file() const { return file_; }
    /// Of the whole, once `next` has given nothing.
    const std::string& content_hash() const { return content_hash_; }

  private:
    std::string take(std::size_t bytes);
    void check_end();
    [[noreturn]] void fail(const std::string& what) const;

    std::filesystem::path file_;
    std::ifstream stream_;
    std::uint64_t left_ = 0;  ///< Bytes of the file that were not read yet.
    RunningHash hash_;
    std::string block_;
    std::uint32_t blocks_ = 0;
    std::string content_hash_;
};

}  // namespace clearway::trace::detail
