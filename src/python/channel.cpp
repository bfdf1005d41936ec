#include "python/channel.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace clearway::python {
namespace {

void close_one(int& descriptor) {
    if (descriptor >= 0) ::close(descriptor);
    descriptor = -1;
}

void close_all(Descriptors& descriptors) {
    close_one(descriptors.memory);
    close_one(descriptors.read);
    close_one(descriptors.write);
}

void make_pipe(int& read, int& write) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
        throw core::EnvironmentError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
    read = ends[0];
    write = ends[1];
}

}  // namespace

Channel::Channel() {
    ours_.memory = ::memfd_create("clearway", MFD_CLOEXEC);
    if (ours_.memory < 0 || ::ftruncate(ours_.memory, 2 * capacity) != 0)
        throw core::EnvironmentError(fmt::format("cannot share memory: {}", std::strerror(errno)));
    theirs_.memory = ::fcntl(ours_.memory, F_DUPFD_CLOEXEC, 0);
    make_pipe(theirs_.read, ours_.write);
    make_pipe(ours_.read, theirs_.write);
    map();
}

Channel::Channel(const Descriptors& ours) : ours_(ours) {
    for (const int descriptor : {ours.memory, ours.read, ours.write})
        ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    map();
}

Channel::~Channel() {
    ::munmap(memory_, 2 * capacity);
    close_all(ours_);
    close_all(theirs_);
}

void Channel::map() {
    // A bell that nobody hears is an answer of `ring`, not the end of this process.
    std::signal(SIGPIPE, SIG_IGN);
    void* const mapped = ::mmap(nullptr, 2 * capacity, PROT_READ | PROT_WRITE, MAP_SHARED, ours_.memory, 0);
    if (mapped == MAP_FAILED)
        throw core::EnvironmentError(fmt::format("cannot share memory: {}", std::strerror(errno)));
    memory_ = static_cast<std::byte*>(mapped);
}

void Channel::close_theirs() {
    close_all(theirs_);
}

void Channel::write_text(std::string_view text) const {
    const std::uint64_t length = text.size();
    if (length + sizeof(length) > capacity) throw std::length_error("a text does not fit into shared memory");
    std::memcpy(memory_, &length, sizeof(length));
    std::memcpy(memory_ + sizeof(length), text.data(), text.size());
}

std::string Channel::read_text() const {
    std::uint64_t length = 0;
    std::memcpy(&length, incoming().data(), sizeof(length));
    length = std::min<std::uint64_t>(length, capacity - sizeof(length));
    return {reinterpret_cast<const char*>(incoming().data()) + sizeof(length), length};
}

bool Channel::ring(Bell bell) const {
    const char letter = static_cast<char>(bell);
    ssize_t written = 0;
    while ((written = ::write(ours_.write, &letter, 1)) < 0 && errno == EINTR) {
    }
    return written == 1;
}

bool Channel::wait(Bell& bell) const {
    char letter = 0;
    ssize_t read = 0;
    while ((read = ::read(ours_.read, &letter, 1)) < 0 && errno == EINTR) {
    }
    bell = static_cast<Bell>(letter);
    return read == 1;
}

}  // namespace clearway::python
