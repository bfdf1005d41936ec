#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "core/fields.hpp"
#include "traffic/lease.hpp"
#include "traffic/refusal.hpp"

namespace clearway::metrics {

/// What became of the leases of one policy and one action in a run.
struct LeaseRow {
    std::string policy;
    traffic::LeaseKind action = traffic::LeaseKind::drive_at;
    std::uint64_t issued = 0;
    std::uint64_t renewed = 0;
    std::uint64_t acted = 0;
    std::uint64_t expired = 0;
    std::map<traffic::Refusal, std::uint64_t> refused;  ///< Leases refused for this at least once.

    bool operator==(const LeaseRow&) const = default;

    /// `refused` with words for the reasons, in the same order.
    std::map<std::string, std::uint64_t> refused_words() const {
        std::map<std::string, std::uint64_t> words;
        for (const auto& [reason, count] : refused)
            words.emplace(name(reason), count);
        return words;
    }

    /// The numeric columns. In tables, policy and action come before them, refusals by reason after them.
    static constexpr void fields(const auto& table) {
        using R = LeaseRow;
        using core::Field;
        table(Field{"issued", "1", &R::issued, 0.0, 1e12, "New leases, carried out or not", ""},
              Field{"renewed", "1", &R::renewed, 0.0, 1e12, "Leases that renewed an earlier one", ""},
              Field{"acted", "1", &R::acted, 0.0, 1e12, "Leases that took effect for at least one step", ""},
              Field{"expired", "1", &R::expired, 0.0, 1e12, "Leases that expired", ""});
    }
};

}  // namespace clearway::metrics
