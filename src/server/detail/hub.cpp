#include "server/detail/hub.hpp"

#include <algorithm>

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>

#include "core/json.hpp"
#include "view/frame_encoder.hpp"

namespace clearway::server::detail {
namespace {

using view::BlockKind;

/// Reads one number of a stream (view::BlockKind). False when it is not whole yet.
bool read_number(std::string_view bytes, std::size_t& at, std::uint64_t& value) {
    value = 0;
    for (unsigned shift = 0; at < bytes.size(); shift += 7) {
        const auto byte = static_cast<unsigned char>(bytes[at++]);
        value |= static_cast<std::uint64_t>(byte & 0x7fU) << shift;
        if (byte < 0x80U) return true;
    }
    return false;
}

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

void Feed::allow(double time_s) {
    allowed_s_ = time_s;
    if (is_writing_ || allowed_s_ == sent_s_) return;
    is_writing_ = true;
    sent_s_ = allowed_s_;
    boost::asio::async_write(
        socket_, boost::asio::buffer(&sent_s_, sizeof sent_s_),
        [self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
            self->is_writing_ = false;
            if (!error && self->allowed_s_ != self->sent_s_) self->allow(self->allowed_s_);
        });
}

void Feed::read() {
    socket_.async_read_some(
        boost::asio::buffer(chunk_),
        [self = shared_from_this()](const boost::system::error_code& error, std::size_t size) {
            if (error) return self->events_.closed();
            self->pending_.append(self->chunk_.data(), size);
            self->take_blocks();
            self->read();
        });
}

void Feed::take_blocks() {
    std::size_t taken = 0;
    while (taken < pending_.size()) {
        std::size_t at = taken + 1;
        std::uint64_t length = 0;
        if (!read_number(pending_, at, length) || length > pending_.size() - at) break;
        events_.block(static_cast<std::uint8_t>(pending_[taken]),
                      std::string_view(pending_).substr(at, length));
        taken = at + length;
    }
    pending_.erase(0, taken);
}

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
