#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace clearway::server::detail {

/// One message to a client, shared by all that get it.
struct Message {
    enum class Kind : std::uint8_t { words, names, key, delta };
    Kind kind = Kind::words;
    std::size_t run = 0;
    std::string bytes;  ///< Text for words; else the number of the run and a block.
};
using SharedMessage = std::shared_ptr<const Message>;

/// What the server keeps of the runs for clients that come later: their names so far, and all since the last
/// key frame.
class Hub {
  public:
    explicit Hub(std::size_t runs) : runs_(runs) {}

    /// Takes one block of the run `number`. Returns the message for clients, if it is one, and the time of a
    /// frame.
    struct Taken {
        SharedMessage message;  ///< Null for words between run and server.
        double time_s = -1.0;   ///< Of a frame; negative for others.
        bool ended = false;
    };
    Taken take(std::size_t number, std::uint8_t kind, std::string_view content);

    /// Whether every run has sent its name and its network.
    bool has_begun() const;
    /// What a client is told first. Call it once the runs have begun.
    std::string welcome(bool allow_control) const;
    /// Names and frames with which a client that comes now begins.
    std::vector<SharedMessage> beginning() const;

  private:
    struct Run {
        std::vector<std::string> words;  ///< About, drawing.
        std::vector<SharedMessage> names, frames;
    };
    std::vector<Run> runs_;
};

}  // namespace clearway::server::detail
