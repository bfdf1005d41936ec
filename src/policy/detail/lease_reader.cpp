#include "policy/detail/lease_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "python/channel.hpp"

namespace clearway::policy::detail {
namespace {

using Json = nlohmann::json;

/// A whole number that its type can hold.
template <class Number>
Number whole_of(const Json& value, const char* what) {
    const bool is_whole = value.is_number_unsigned() || value.is_number_integer();
    if (is_whole && value.is_number_unsigned()) {
        const auto number = value.get<std::uint64_t>();
        if (std::in_range<Number>(number)) return static_cast<Number>(number);
    } else if (is_whole) {
        const auto number = value.get<std::int64_t>();
        if (std::in_range<Number>(number)) return static_cast<Number>(number);
    }
    throw std::invalid_argument(fmt::format("{} is {}, not a whole number from {} to {}", what, value.dump(),
                                            std::numeric_limits<Number>::min(),
                                            std::numeric_limits<Number>::max()));
}

double number_of(const Json& row, const char* what, double least, double most) {
    const auto number = row.at(what).get<double>();
    if (number >= least && number <= most) return number;
    throw std::invalid_argument(fmt::format("{} is {} (allowed: {:g} to {:g})", what, number, least, most));
}

std::vector<std::uint16_t> links_of(const Json& row, const char* key) {
    std::vector<std::uint16_t> links;
    if (!row.contains(key)) return links;
    for (const Json& link : row.at(key))
        links.push_back(whole_of<std::uint16_t>(link, key));
    if (!std::ranges::is_sorted(links)) throw std::invalid_argument(fmt::format("{} are not in order", key));
    return links;
}

traffic::Side side_of(const Json& row) {
    const auto side = row.at("side").get<std::string>();
    if (side != "left" && side != "right")
        throw std::invalid_argument(fmt::format("side is `{}` (allowed: left, right)", side));
    return side == "left" ? traffic::Side::left : traffic::Side::right;
}

traffic::Action action_of(const Json& row) {
    constexpr double fastest_mps = 200.0;  // as clearway.Lease allows
    const auto kind = row.at("action").get<std::string>();
    if (kind == "drive_at")
        return traffic::DriveAt{core::MetresPerSecond(number_of(row, "speed_mps", 0.0, fastest_mps))};
    if (kind == "change_lane")
        return traffic::ChangeLane{whole_of<std::uint8_t>(row.at("lane_number"), "lane_number")};
    if (kind == "hold_lane") return traffic::HoldLane{};
    if (kind == "pull_aside") return traffic::PullAside{side_of(row)};
    if (kind == "stop_at_line") return traffic::StopAtLine{};
    if (kind == "hold_green") return traffic::HoldGreen{links_of(row, "links"), links_of(row, "own_links")};
    if (kind == "adjust_green") return traffic::AdjustGreen{links_of(row, "links")};
    if (kind == "pass_red") return traffic::PassRed{};
    if (kind == "take_route") {
        traffic::TakeRoute way;
        for (const Json& edge : row.at("edges"))
            way.edges.push_back(core::EdgeIndex{whole_of<std::uint32_t>(edge, "edges")});
        return way;
    }
    throw std::invalid_argument(fmt::format("`{}` is not an action", kind));
}

traffic::Target target_of(const Json& row) {
    if (row.contains("signal")) return core::SignalIndex{whole_of<std::uint32_t>(row.at("signal"), "signal")};
    return core::VehicleKey{whole_of<std::uint64_t>(row.at("vehicle"), "vehicle")};
}

traffic::Lease lease_of(const Json& row, const std::string& policy, core::Seconds now) {
    constexpr double shortest_s = 1e-3;
    constexpr double longest_s = 3600.0;
    return {.target = target_of(row),
            .action = action_of(row),
            .expiry = core::Seconds(now.value + number_of(row, "lasting_s", shortest_s, longest_s)),
            .priority = whole_of<int>(row.at("priority"), "priority"),
            .policy = kept_text(row.value("policy", policy)).c_str(),
            .reason = kept_text(row.at("reason").get<std::string>()).c_str(),
            .beneficiary = core::VehicleKey{whole_of<std::uint64_t>(row.at("beneficiary"), "beneficiary")}};
}

python::PartError refused(const char* why) {
    return python::PartError(
        fmt::format("its answer is not a list of leases as clearway.Lease makes them: {}", why));
}

}  // namespace

const std::string& kept_text(const std::string& text) {
    static std::set<std::string> texts;
    return *texts.insert(text).first;
}

std::vector<std::string> read_leases(const std::string& answer, const std::string& policy, core::Seconds now,
                                     std::vector<traffic::Lease>& leases) {
    std::vector<std::string> places;
    try {
        const Json rows = Json::parse(answer);
        if (!rows.is_array()) throw std::invalid_argument("it is no list");
        for (const Json& row : rows) {
            leases.push_back(lease_of(row, policy, now));
            places.push_back(row.value("place", std::string()));
        }
    } catch (const Json::exception& error) {
        throw refused(error.what());
    } catch (const std::invalid_argument& error) {
        throw refused(error.what());
    }
    return places;
}

}  // namespace clearway::policy::detail
