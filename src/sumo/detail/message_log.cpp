#include "sumo/detail/message_log.hpp"

#include <cerrno>
#include <iostream>

#include <fcntl.h>
#include <unistd.h>

#include "core/atomic_file.hpp"

namespace clearway::sumo::detail {
namespace {

constexpr std::size_t kept_lines = 12;

/// Writes as much as possible. A full disk must not stop a simulation because of its log; the check of the
/// trip table notices it.
void write_all(int descriptor, const char* text, std::size_t count) {
    while (count > 0) {
        const ssize_t written = ::write(descriptor, text, count);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return;
        text += written;
        count -= static_cast<std::size_t>(written);
    }
}

}  // namespace

MessageLog::MessageLog(const std::filesystem::path& file)
    : descriptor_(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644)) {
    if (descriptor_ < 0) throw core::write_error(file, errno);
}

MessageLog::~MessageLog() {
    ::close(descriptor_);
}

std::string MessageLog::last_lines() const {
    std::string text;
    for (const std::string& line : last_lines_) {
        text += line;
    }
    return text + line_;
}

MessageLog::int_type MessageLog::overflow(int_type letter) {
    if (traits_type::eq_int_type(letter, traits_type::eof())) return traits_type::not_eof(letter);
    const char one = traits_type::to_char_type(letter);
    xsputn(&one, 1);
    return letter;
}

std::streamsize MessageLog::xsputn(const char* text, std::streamsize count) {
    const auto size = static_cast<std::size_t>(count);
    write_all(descriptor_, text, size);
    for (std::size_t i = 0; i < size; ++i) {
        line_ += text[i];
        if (text[i] != '\n') continue;
        last_lines_.push_back(std::move(line_));
        line_.clear();
        if (last_lines_.size() > kept_lines) last_lines_.pop_front();
    }
    return count;
}

MessageCapture::MessageCapture(MessageLog& log) : former_(std::cerr.rdbuf(&log)) {}

MessageCapture::~MessageCapture() {
    std::cerr.rdbuf(former_);
}

}  // namespace clearway::sumo::detail
