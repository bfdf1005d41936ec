#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "view/detail/byte_writer.hpp"
#include "view/frame.hpp"

namespace clearway::view {

/// Raised when the meaning of a stream changes; page/src/stream.ts knows the same number.
inline constexpr int stream_format = 2;

/// What the first byte of a block says. A stream is a sequence of blocks: this byte, the length of the rest
/// as a number, the rest. Numbers are unsigned, seven bits a byte, lowest first, the eighth bit set where
/// another follows; signed ones are zigzag-coded into them (0, -1, 1, -2, ...).
enum class BlockKind : std::uint8_t {
    names = 1,    ///< Names.
    key = 2,      ///< A frame that needs no other.
    delta = 3,    ///< A frame as its difference from the one before.
    message = 4,  ///< JSON text: how a run ended, what a server says.
};

/// Codes the frames of one stream, for replay and live alike (docs/reference/frames.md).
///
/// A place is coded as its difference from the place that the last two frames extrapolate to, so a vehicle at
/// steady speed costs four bytes. The differences are of whole numbers: nothing drifts. A reader that starts
/// at a key frame, after the names so far, needs nothing else: a frame may be left out if all up to the next
/// key frame are. One thread.
class FrameEncoder {
  public:
    /// The block of `names`, appended to `stream`.
    static void encode(const Names& names, std::string& stream);
    /// A block of any kind around its content.
    static void append_block(BlockKind kind, std::string_view content, std::string& stream);
    /// A block of JSON text.
    static void encode_message(std::string_view json, std::string& stream);
    /// Appends a key frame or the difference from the frame before. The first must be a key frame.
    void encode_key(const Frame& frame, std::string& stream);
    void encode_delta(const Frame& frame, std::string& stream);

  private:
    struct Motion {
        std::int32_t x = 0, y = 0;
    };
    void encode(const Frame& frame, BlockKind kind, std::string& stream);
    void write_vehicles(const Frame& frame);
    void write_columns(const Frame& frame, const std::vector<const SeenVehicle*>& before);
    void write_signals(const Frame& frame);
    void write_links(const Frame& frame);
    void write_ghosts(const Frame& frame);
    void write_leases(const Frame& frame);
    void write_ways(const Frame& frame);
    void write_known_blocks(const Frame& frame);

    detail::ByteWriter writer_;
    Frame last_;                       ///< Empty before a key frame.
    std::vector<Motion> last_motion_;  ///< Of the vehicles of `last_`: how far they moved in it.
};

}  // namespace clearway::view
