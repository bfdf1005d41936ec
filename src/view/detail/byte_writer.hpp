#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace clearway::view::detail {

/// Writes the numbers of a stream (see view::BlockKind). Keeps its buffer.
class ByteWriter {
  public:
    void byte(std::uint8_t value) { bytes_.push_back(static_cast<char>(value)); }
    void number(std::uint64_t value);
    void signed_number(std::int64_t value);
    /// Length and bytes.
    void text(std::string_view text);

    void clear() { bytes_.clear(); }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// Ascending numbers, each as its difference from the one before; the first from 0.
class Ascending {
  public:
    explicit Ascending(ByteWriter& writer) : writer_(writer) {}
    void write(std::uint32_t value) {
        writer_.number(value - last_);
        last_ = value;
    }

  private:
    ByteWriter& writer_;
    std::uint32_t last_ = 0;
};

}  // namespace clearway::view::detail
