#include "support/allocation_count.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> calls = 0;
std::atomic<void (*)()> looks = nullptr;
}  // namespace

void* operator new(std::size_t bytes, const std::nothrow_t& /*unused*/) noexcept {
    ++calls;
    if (void (*const look)() = looks.exchange(nullptr)) {
        look();
        looks = look;
    }
    return std::malloc(bytes == 0 ? 1 : bytes);
}

void* operator new(std::size_t bytes) {
    void* memory = operator new(bytes, std::nothrow);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace clearway::support {

std::size_t allocation_count() {
    return calls;
}

void look_at_allocations(void (*look)()) {
    looks = look;
}

}  // namespace clearway::support
