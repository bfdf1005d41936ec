#include "core/random.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace clearway::core {
namespace {

/// The 53 high bits as a number in [0, 1).
double to_unit(std::uint64_t word) {
    return static_cast<double>(word >> 11) * 0x1.0p-53;
}

}  // namespace

std::uint64_t fnv1a64(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const char byte : bytes) {
        hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3ULL;
    }
    return hash;
}

std::uint64_t mix64(std::uint64_t word) {
    word += 0x9e3779b97f4a7c15ULL;
    word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9ULL;
    word = (word ^ (word >> 27)) * 0x94d049bb133111ebULL;
    return word ^ (word >> 31);
}

std::uint64_t pair_subject(std::uint64_t one, std::uint64_t other) {
    const auto [low, high] = std::minmax(one, other);
    return mix64(low) ^ high;
}

KeyedRandom::KeyedRandom(StudySeed seed, Replication replication)
    : base_(mix64(mix64(seed.value) ^ (0xc1ea0000ULL + replication.value))) {}

std::uint64_t KeyedRandom::bits(Purpose purpose, std::uint64_t subject, std::uint64_t counter) const {
    std::uint64_t word = mix64(base_ ^ static_cast<std::uint64_t>(purpose));
    word = mix64(word ^ subject);
    return mix64(word + counter * 0xd1342543de82ef95ULL);
}

double KeyedRandom::uniform(Purpose purpose, std::uint64_t subject, std::uint64_t counter) const {
    return to_unit(bits(purpose, subject, counter));
}

double KeyedRandom::normal(Purpose purpose, std::uint64_t subject, std::uint64_t counter) const {
    const std::uint64_t word = bits(purpose, subject, counter);
    const double radius = std::sqrt(-2.0 * std::log1p(-to_unit(word)));
    return radius * std::cos(2.0 * std::numbers::pi * to_unit(mix64(word ^ 0x5851f42d4c957f2dULL)));
}

std::uint64_t KeyedRandom::below(std::uint64_t bound, Purpose purpose, std::uint64_t subject,
                                 std::uint64_t counter) const {
    assert(bound > 0);
    // Multiplication instead of a remainder; the bias is negligible while bound is far below 2^53.
    const double scaled = to_unit(bits(purpose, subject, counter)) * static_cast<double>(bound);
    return std::min(static_cast<std::uint64_t>(scaled), bound - 1);
}

}  // namespace clearway::core
