#pragma once

#include <cstdint>
#include <string_view>

namespace clearway::core {

/// Seed of a whole study, and the number of a replication in it (0-based).
struct StudySeed {
    std::uint64_t value = 1;
};
struct Replication {
    std::uint32_t value = 0;
};

/// What a draw is for. Draws of different purposes are independent. Results depend on the numbers, so these
/// never change (append only).
enum class Purpose : std::uint32_t {
    demand = 1,
    driver = 2,
    vehicle_class = 3,
    emergency = 4,
    simulator = 5,
    pedestrian = 6,
    report_loss = 16,
    outage = 17,
    link_detection = 18,
    position_noise = 19,
    speed_noise = 20,
    sensing_share = 21,
    seen_position = 22,
    known_route = 23,
    heading_noise = 24,
    request_loss = 25,
    request_outage = 26,
    request_shadowing = 27,
    signal_request_loss = 28,
    signal_request_outage = 29,
    signal_request_shadowing = 30,
    siren_reaction = 32,
    spoiled_link = 40,
    false_link = 41,
    training = 48,
    negative_sampling = 49,
    bootstrap = 64,
};

/// FNV-1a, 64 bit (Fowler, Noll, Vo).
std::uint64_t fnv1a64(std::string_view bytes);

/// Finaliser of SplitMix64 (Steele, Lea, Flood 2014): a bijection in which every input bit affects every
/// output bit.
std::uint64_t mix64(std::uint64_t word);

/// Subject of draws about two things, whichever comes first.
std::uint64_t pair_subject(std::uint64_t one, std::uint64_t other);

/// Random numbers without state: a draw is a pure function of (study seed, replication, purpose, subject,
/// counter). Neither the order of calls nor the presence of other vehicles changes a draw, so all conditions
/// of a replication have the same drivers and the same sensor failures. Thread-safe, never allocates.
class KeyedRandom {
  public:
    KeyedRandom(StudySeed seed, Replication replication);

    /// 64 random bits for `subject` (for example a vehicle key) and `counter` (for example the number of the
    /// report).
    std::uint64_t bits(Purpose purpose, std::uint64_t subject, std::uint64_t counter = 0) const;
    /// Uniform in [0, 1).
    double uniform(Purpose purpose, std::uint64_t subject, std::uint64_t counter = 0) const;
    /// Standard normal, by Box and Muller from two independent words.
    double normal(Purpose purpose, std::uint64_t subject, std::uint64_t counter = 0) const;
    /// Uniform integer in [0, bound); `bound` > 0.
    std::uint64_t below(std::uint64_t bound, Purpose purpose, std::uint64_t subject,
                        std::uint64_t counter = 0) const;

  private:
    std::uint64_t base_;
};

}  // namespace clearway::core
