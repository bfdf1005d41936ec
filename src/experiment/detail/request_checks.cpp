#include "experiment/detail/request_checks.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/settings.hpp"
#include "core/units.hpp"
#include "experiment/settings.hpp"
#include "failures/failure_config.hpp"
#include "policy/policy.hpp"
#include "python/part_name.hpp"

namespace clearway::experiment::detail {
namespace {

constexpr const char* compliance_name = "requests.compliance";

/// The value of a shipped part's setting, as text: what the condition sets, or else the default; nothing if
/// the part has no such setting.
std::optional<std::string> value_of(const ConditionSpec& condition, const std::string& part,
                                    const std::string& field) {
    const auto component = std::ranges::find(components(), part, &Component::name);
    if (component == components().end()) return std::nullopt;
    const auto row = std::ranges::find(component->table.rows, field, &core::SettingInfo::name);
    if (row == component->table.rows.end()) return std::nullopt;
    const auto set = condition.settings.find(part + "." + field);
    return set == condition.settings.end() ? row->preset : set->second;
}

/// Whether a policy is code in Python, which asks whom it likes.
bool has_code(const ConditionSpec& condition) {
    return std::ranges::any_of(condition.policies, [](const std::string& policy) {
        return python::part_name_from(policy).has_value();
    });
}

/// How long a request of a part to a vehicle lives that is not renewed, s; nothing for parts that make none.
std::optional<double> lifetime_s(const ConditionSpec& condition, const std::string& part) {
    if (!policy::policies().is(part, traffic::Trait::renews_requests)) return std::nullopt;
    const std::optional<std::string> lease = value_of(condition, part, "lease_s");
    if (!lease) return std::nullopt;
    // Policies lengthen their leases to two periods.
    return std::max(core::number_from(*lease).value_or(0.0), 2.0 * loop_config(condition).policy_period_s);
}

/// The channel of requests to vehicles; nothing if it is perfect, or wrong, which is told elsewhere.
std::optional<failures::RequestChannel> channel_of(const ConditionSpec& condition) {
    try {
        const failures::FailureConfig failure = failures::failure_from(condition.failure);
        const failures::RequestChannel& channel = failure;
        if (channel.propagation != failures::Propagation::perfect) return channel;
    } catch (const core::InputError&) {
        return std::nullopt;
    }
    return std::nullopt;
}

void check_latency(const failures::RequestChannel& channel, const std::string& part, double lives_s,
                   const std::string& where, std::vector<core::Problem>& problems) {
    const double arrives_s = channel.latency_s * channel.hops;
    if (arrives_s < lives_s - core::clock_tolerance_s) return;
    problems.push_back({where + "failure.request_latency_s",
                        fmt::format("{:g} s times request_hops={} is {:g} s, but requests of {} live {:g} s",
                                    channel.latency_s, channel.hops, arrives_s, part, lives_s),
                        fmt::format("below {:g} s with these hops", lives_s / channel.hops),
                        fmt::format("Set {}.lease_s above {:g}, or lower request_latency_s or request_hops",
                                    part, arrives_s)});
}

void check_interval(const failures::RequestChannel& channel, const std::string& part, double lives_s,
                    const std::string& where, std::vector<core::Problem>& problems) {
    if (channel.interval_s <= lives_s + core::clock_tolerance_s) return;
    problems.push_back(
        {where + "failure.request_interval_s",
         fmt::format("{:g} s, but requests of {} live {:g} s: they end before the next message",
                     channel.interval_s, part, lives_s),
         fmt::format("up to {:g} s with this lifetime", lives_s),
         fmt::format("Set {}.lease_s to {:g} or more, or lower request_interval_s", part,
                     channel.interval_s)});
}

void check_times(const ConditionSpec& condition, const std::string& where,
                 std::vector<core::Problem>& problems) {
    const std::optional<failures::RequestChannel> channel = channel_of(condition);
    if (!channel) return;
    for (const std::string& part : parts_of(condition)) {
        const std::optional<double> lives_s = lifetime_s(condition, part);
        if (!lives_s) continue;
        check_latency(*channel, part, *lives_s, where, problems);
        check_interval(*channel, part, *lives_s, where, problems);
    }
}

/// A part that asks human drivers plans with their help, so some must comply.
void check_compliance(const ConditionSpec& condition, const std::vector<std::string>& asking,
                      const std::string& where, std::vector<core::Problem>& problems) {
    const auto compliance = value_of(condition, "requests", "compliance");
    if (core::number_from(compliance.value_or("")).value_or(0.0) > 0.0) return;
    for (const std::string& name : asking)
        problems.push_back({where + name,
                            fmt::format("is 1, but no driver complies: {} is 0", compliance_name),
                            fmt::format("0, or 1 with {} above 0", compliance_name),
                            fmt::format("Set {} above 0, or remove {}", compliance_name, name)});
}

void check_humans(const ConditionSpec& condition, const std::string& where,
                  std::vector<core::Problem>& problems) {
    std::vector<std::string> askable, asking;
    for (const std::string& part : parts_of(condition)) {
        const std::optional<std::string> asks = value_of(condition, part, "ask_humans");
        if (!asks) continue;
        askable.push_back(part + ".ask_humans");
        if (*asks == "1") asking.push_back(askable.back());
    }
    check_compliance(condition, asking, where, problems);
    if (!asking.empty() || has_code(condition)) return;
    for (const auto& [name, value] : condition.settings) {
        if (!name.starts_with("requests.")) continue;
        problems.push_back(
            {where + name, "has no effect, because no human driver is asked",
             askable.empty() ? "a part that can ask human drivers" : "1 for one of " + core::listed(askable),
             askable.empty() ? "Remove " + name
                             : fmt::format("Set {} to 1, or remove {}", askable.front(), name)});
    }
}

}  // namespace

void check_requests(const ConditionSpec& condition, const std::string& where,
                    std::vector<core::Problem>& problems) {
    check_times(condition, where, problems);
    check_humans(condition, where, problems);
}

}  // namespace clearway::experiment::detail
