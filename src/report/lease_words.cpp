#include "report/lease_words.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

using Refused = std::map<traffic::Refusal, std::uint64_t>;

const char* words_of(traffic::LeaseKind action) {
    using traffic::LeaseKind;
    switch (action) {
        case LeaseKind::drive_at:
            return "asked a vehicle for a speed";
        case LeaseKind::change_lane:
            return "asked a vehicle to change lanes";
        case LeaseKind::own_change_lane:
            return "asked the EV itself to change lanes";
        case LeaseKind::hold_lane:
            return "asked a vehicle to keep its lane";
        case LeaseKind::pull_aside:
            return "asked a vehicle to pull aside";
        case LeaseKind::stop_at_line:
            return "asked a vehicle to stop at the line";
        case LeaseKind::hold_green:
            return "asked a signal for green";
        case LeaseKind::adjust_green:
            return "gave time back at a signal";
        case LeaseKind::pass_red:
            return "let the EV pass red";
        case LeaseKind::consider_way:
            return "considered a faster way that gains too little";
        case LeaseKind::stand_back:
            return "stood back: not the situation it is for";
        case LeaseKind::take_route:
            return "chose another way for the EV";
    }
    return "";
}

/// Leases of which a message was lost. What is heard is renewed, what is lost is asked anew: among those
/// issued, lost ones weigh too much.
std::uint64_t lost_of(const metrics::LeaseRow& row) {
    const auto lost = row.refused.find(traffic::Refusal::unheard);
    return lost == row.refused.end() ? 0 : lost->second;
}

std::uint64_t heard_of(const metrics::LeaseRow& row) {
    return std::max(row.acted, row.issued - std::min(row.issued, lost_of(row)));
}

/// `, 238 of 451 messages lost`, or empty.
std::string lost_words(const metrics::LeaseRow& row) {
    return lost_of(row) == 0 ? ""
                             : fmt::format(", {} of {} messages lost", grouped(lost_of(row)),
                                           grouped(row.issued + row.renewed));
}

/// `354 of 699 messages to signals lost`, but for those that are leases, which tell it themselves. Empty
/// where none is.
std::string lost_signal_messages(const ConditionFacts& condition) {
    std::uint64_t sent = condition.count("signal_requests_sent");
    std::uint64_t lost = sent - condition.count("signal_requests_heard");
    for (const metrics::LeaseRow& row : condition.leases) {
        const bool asks_signal =
            row.action == traffic::LeaseKind::hold_green || row.action == traffic::LeaseKind::adjust_green;
        if (!asks_signal || lost_of(row) == 0) continue;
        sent -= std::min(sent, row.issued + row.renewed);
        lost -= std::min(lost, lost_of(row));
    }
    return lost == 0 ? "" : fmt::format("{} of {} messages to signals lost", grouped(lost), grouped(sent));
}

std::vector<std::pair<traffic::Refusal, std::uint64_t>> most_frequent_first(const Refused& refused) {
    std::vector<std::pair<traffic::Refusal, std::uint64_t>> reasons(refused.begin(), refused.end());
    std::ranges::stable_sort(reasons, std::greater{}, &std::pair<traffic::Refusal, std::uint64_t>::second);
    return reasons;
}

/// `no_room_beside 12, outranked 3`, the most frequent first, but for what was lost.
std::string reasons_of(const metrics::LeaseRow& row) {
    auto reasons = most_frequent_first(row.refused);
    std::erase_if(reasons, [](const auto& entry) { return entry.first == traffic::Refusal::unheard; });
    return core::listed(core::texts_of(reasons, [](const auto& entry) {
        return fmt::format("{} {}", name(entry.first), grouped(entry.second));
    }));
}

Refused::const_iterator most_frequent(const Refused& refused) {
    return std::ranges::max_element(refused, {}, &Refused::value_type::second);
}

/// ` (7,407 leases, all refused as vehicle_gone, 6 as outranked)`: what a part wanted that never acted;
/// nothing if that was nothing. A lease is refused once for each reason, so one may have several.
std::string vain_leases(const analysis::IdlePart& part) {
    if (part.vain == 0) return {};
    const std::string leases = counted(part.vain, "lease");
    if (part.refused.empty()) return fmt::format(" ({}, none carried out)", leases);
    std::string reasons;
    for (const auto& [reason, count] : most_frequent_first(part.refused)) {
        const std::string many = count >= part.vain ? "all" : 2 * count > part.vain ? "most" : grouped(count);
        reasons += fmt::format(", {}{} as {}", many, reasons.empty() ? " refused" : "", name(reason));
    }
    return fmt::format(" ({}{})", leases, reasons);
}

/// One sentence for all parts of which `runs_of` counts a run, those of equally many runs together.
std::string sentence_of_parts(const char* what, const std::vector<analysis::IdlePart>& parts,
                              std::size_t analysis::IdlePart::*runs_of) {
    std::vector<std::pair<std::string, std::string>> groups;  // `3 of 20 runs`, names.
    for (const analysis::IdlePart& part : parts) {
        if (part.*runs_of == 0) continue;
        std::string runs = fmt::format("{} of {}", part.*runs_of, counted(part.runs, "run"));
        const std::string name =
            part.policy + (runs_of == &analysis::IdlePart::idle_runs ? vain_leases(part) : "");
        if (!groups.empty() && groups.back().first == runs)
            groups.back().second += ", " + name;
        else
            groups.emplace_back(std::move(runs), name);
    }
    std::string text;
    for (const auto& [runs, names] : groups)
        text += fmt::format("{}{} in {}", text.empty() ? "" : "; ", names, runs);
    return text.empty() ? text : fmt::format("{}: {}.", what, text);
}

/// What was heard of a policy's requests in all runs of a condition; standing back is no request.
struct Requests {
    std::uint64_t heard = 0;
    std::uint64_t acted = 0;
    Refused refused = {};

    /// From 20 on a share is more than chance, and with a quarter carried out, a policy is tried at all.
    bool are_mostly_vain() const { return heard >= 20 && acted > 0 && 4 * acted <= heard; }
};

/// What a writer of a policy can do about a refusal; empty where its name says it.
const char* cure_of(traffic::Refusal reason) {
    using traffic::Refusal;
    switch (reason) {
        case Refusal::not_controllable:
            return ": human drivers; ask only where belief.vehicles.is_automated";
        case Refusal::vehicle_gone:
            return ": not on the road; name vehicles by belief.vehicles.key, not by row";
        case Refusal::no_such_lane:
            return ": lane numbers count from the outermost, 0: belief.vehicles.lane_number, not lane";
        case Refusal::outranked:
            return ": other leases for the same target go first; see priority";
        default:
            return "";
    }
}

}  // namespace

std::string lease_sentence(const ConditionFacts& condition) {
    if (condition.condition.policies.empty()) return "has no policy that could ask for anything";
    std::vector<std::string> found;
    for (const metrics::LeaseRow& row : condition.leases) {
        const std::uint64_t heard = heard_of(row);
        const std::string often = heard == 1 ? "once" : grouped(heard) + " times";
        std::string text = fmt::format("{}: {} {}, {} carried out{}", row.policy, words_of(row.action), often,
                                       grouped(row.acted), lost_words(row));
        if (const std::string reasons = reasons_of(row); !reasons.empty())
            text += ", refused at some time: " + reasons;
        found.push_back(std::move(text));
    }
    if (found.empty()) return "asked for nothing";
    if (const std::string lost = lost_signal_messages(condition); !lost.empty()) found.push_back(lost);
    return fmt::format("{}", fmt::join(found, "; "));
}

std::string refusals_sentence(const ConditionFacts& condition) {
    std::map<std::string, Requests> policies;
    for (const metrics::LeaseRow& row : condition.leases) {
        if (row.action == traffic::LeaseKind::stand_back || row.action == traffic::LeaseKind::consider_way)
            continue;
        Requests& requests = policies[row.policy];
        requests.heard += heard_of(row);
        requests.acted += row.acted;
        for (const auto& [reason, count] : row.refused)
            if (reason != traffic::Refusal::unheard) requests.refused[reason] += count;
    }
    std::vector<std::string> facts;
    for (const auto& [policy, requests] : policies) {
        const auto most = most_frequent(requests.refused);
        if (!requests.are_mostly_vain() || most == requests.refused.end()) continue;
        const double vain = 100.0 * static_cast<double>(requests.heard - requests.acted) /
                            static_cast<double>(requests.heard);
        facts.push_back(fmt::format(
            "Of {}'s {} requests {:.0f} % were never carried out, mostly refused as {}{}.", policy,
            grouped(requests.heard), std::floor(vain), name(most->first), cure_of(most->first)));
    }
    return fmt::format("{}", fmt::join(facts, " "));
}

std::string idle_sentence(const ConditionFacts& condition) {
    std::string text = sentence_of_parts("Never acted", condition.idle_parts, &analysis::IdlePart::idle_runs);
    std::set<traffic::Refusal> told;
    for (const analysis::IdlePart& part : condition.idle_parts) {
        if (part.idle_runs == 0 || part.refused.empty()) continue;
        const traffic::Refusal most = most_frequent(part.refused)->first;
        const std::string cure = cure_of(most);
        if (!cure.empty() && told.insert(most).second) text += fmt::format(" {}{}.", name(most), cure);
    }
    return text;
}

std::string own_lane_sentence(const ConditionFacts& condition) {
    return sentence_of_parts("Only changed the EV's own lane", condition.idle_parts,
                             &analysis::IdlePart::own_runs);
}

}  // namespace clearway::report
