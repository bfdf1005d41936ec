#include "analysis/detail/condition_leases.hpp"

#include <algorithm>
#include <tuple>

#include "core/fields.hpp"
#include "experiment/settings.hpp"
#include "traffic/lease.hpp"

namespace clearway::analysis::detail {
namespace {

void add_leases(const std::vector<metrics::LeaseRow>& more, std::vector<metrics::LeaseRow>& total) {
    for (const metrics::LeaseRow& row : more) {
        auto place = std::ranges::find_if(total, [&](const metrics::LeaseRow& known) {
            return known.policy == row.policy && known.action == row.action;
        });
        if (place == total.end()) {
            total.push_back(row);
            continue;
        }
        core::for_each_field<metrics::LeaseRow>(
            [&](const auto& field) { (*place).*field.member += row.*field.member; });
        for (const auto& [reason, count] : row.refused)
            place->refused[reason] += count;
    }
}

/// Adds a run to what is known of a part.
void count_run(const std::vector<metrics::LeaseRow>& leases, IdlePart& part) {
    bool acts = false;
    bool acts_on_others = false;
    for (const metrics::LeaseRow& row : leases) {
        if (row.policy != part.policy || row.acted == 0) continue;
        acts = true;
        acts_on_others = acts_on_others || row.action != traffic::LeaseKind::own_change_lane;
    }
    ++part.runs;
    if (!acts) ++part.idle_runs;
    for (const metrics::LeaseRow& row : leases) {
        if (acts || row.policy != part.policy) continue;
        part.vain += row.issued;
        for (const auto& [reason, count] : row.refused)
            part.refused[reason] += count;
    }
    if (acts && !acts_on_others) ++part.own_runs;
}

}  // namespace

std::vector<metrics::LeaseRow> leases_of(const Runs& runs) {
    std::vector<metrics::LeaseRow> total;
    for (const results::RunRecord* run : runs)
        if (run != nullptr) add_leases(run->leases, total);
    std::ranges::sort(total, {},
                      [](const metrics::LeaseRow& row) { return std::tie(row.policy, row.action); });
    return total;
}

std::vector<IdlePart> idle_parts(const Runs& runs, const experiment::ConditionSpec& condition) {
    std::vector<IdlePart> idle;
    for (const std::string& policy : experiment::parts_of(condition)) {
        IdlePart part{policy};
        for (const results::RunRecord* run : runs) {
            if (run != nullptr) count_run(run->leases, part);
        }
        if (part.idle_runs + part.own_runs > 0) idle.push_back(std::move(part));
    }
    return idle;
}

}  // namespace clearway::analysis::detail
