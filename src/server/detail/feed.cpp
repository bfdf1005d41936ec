#include "server/detail/feed.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>

namespace clearway::server::detail {

bool read_number(std::string_view bytes, std::size_t& at, std::uint64_t& value) {
    value = 0;
    for (unsigned shift = 0; at < bytes.size() && shift < 64; shift += 7) {
        const auto byte = static_cast<unsigned char>(bytes[at++]);
        value |= static_cast<std::uint64_t>(byte & 0x7fU) << shift;
        if (byte < 0x80U) return true;
    }
    return false;
}

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

}  // namespace clearway::server::detail
