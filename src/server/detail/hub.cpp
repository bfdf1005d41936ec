#include "server/detail/hub.hpp"

#include <algorithm>

#include "core/json.hpp"
#include "server/detail/feed.hpp"
#include "view/frame_encoder.hpp"

namespace clearway::server::detail {
namespace {

using view::BlockKind;

Message::Kind kind_of(BlockKind kind) {
    switch (kind) {
        case BlockKind::names:
            return Message::Kind::names;
        case BlockKind::key:
            return Message::Kind::key;
        default:
            return Message::Kind::delta;
    }
}

std::string block_of(std::size_t run, std::uint8_t kind, std::string_view content) {
    std::string bytes(1, static_cast<char>(run));
    view::FrameEncoder::append_block(static_cast<BlockKind>(kind), content, bytes);
    return bytes;
}

}  // namespace

Hub::Taken Hub::take(std::size_t number, std::uint8_t kind, std::string_view content) {
    Run& run = runs_.at(number);
    if (static_cast<BlockKind>(kind) == BlockKind::message) {
        if (run.words.size() == 2) return {.message = nullptr, .time_s = -1.0, .ended = true};
        run.words.emplace_back(content);
        return {};
    }
    const Message::Kind what = kind_of(static_cast<BlockKind>(kind));
    auto message = std::make_shared<const Message>(Message{what, number, block_of(number, kind, content)});
    if (what == Message::Kind::names) {
        run.names.push_back(message);
        return {.message = message, .time_s = -1.0, .ended = false};
    }
    if (what == Message::Kind::key) run.frames.clear();
    run.frames.push_back(message);
    std::size_t at = 0;
    std::uint64_t time_ms = 0;
    read_number(content, at, time_ms);  // a frame begins with its time, and the content is a run's own
    return {.message = message, .time_s = static_cast<double>(time_ms) / 1000.0, .ended = false};
}

bool Hub::has_begun() const {
    return std::ranges::all_of(runs_, [](const Run& run) { return run.words.size() == 2; });
}

std::string Hub::welcome(bool allow_control) const {
    core::Json words = {{"format", view::stream_format},
                        {"allow_control", allow_control},
                        {"drawing", runs_.front().words.at(1)},
                        {"runs", core::Json::array()}};
    for (const Run& run : runs_)
        words["runs"].push_back(core::Json::parse(run.words.at(0)));
    return core::Json{{"welcome", std::move(words)}}.dump(-1, ' ', false,
                                                          core::Json::error_handler_t::replace);
}

std::vector<SharedMessage> Hub::beginning() const {
    std::vector<SharedMessage> all;
    for (const Run& run : runs_)
        all.insert(all.end(), run.names.begin(), run.names.end());
    for (const Run& run : runs_)
        all.insert(all.end(), run.frames.begin(), run.frames.end());
    return all;
}

}  // namespace clearway::server::detail
