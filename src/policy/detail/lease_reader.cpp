#include "policy/detail/lease_reader.hpp"

#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clearway::policy::detail {
namespace {

using Json = nlohmann::json;

std::vector<std::uint16_t> links_of(const Json& row, const char* key) {
    return row.value(key, std::vector<std::uint16_t>{});
}

traffic::Side side_of(const Json& row) {
    return row.at("side").get<std::string>() == "left" ? traffic::Side::left : traffic::Side::right;
}

traffic::Action action_of(const Json& row) {
    const auto kind = row.at("action").get<std::string>();
    if (kind == "drive_at") return traffic::DriveAt{core::MetresPerSecond(row.at("speed_mps").get<double>())};
    if (kind == "change_lane") return traffic::ChangeLane{row.at("lane_number").get<std::uint32_t>()};
    if (kind == "hold_lane") return traffic::HoldLane{};
    if (kind == "pull_aside") return traffic::PullAside{side_of(row)};
    if (kind == "stop_at_line") return traffic::StopAtLine{};
    if (kind == "hold_green") return traffic::HoldGreen{links_of(row, "links"), links_of(row, "own_links")};
    if (kind == "adjust_green") return traffic::AdjustGreen{links_of(row, "links")};
    if (kind == "pass_red") return traffic::PassRed{};
    throw std::invalid_argument(fmt::format("`{}` is not an action", kind));
}

traffic::Target target_of(const Json& row) {
    if (row.contains("signal")) return core::SignalIndex{row.at("signal").get<std::uint32_t>()};
    return core::VehicleKey{row.at("vehicle").get<std::uint64_t>()};
}

}  // namespace

const std::string& kept_text(const std::string& text) {
    static std::set<std::string> texts;
    return *texts.insert(text).first;
}

void read_leases(const std::string& answer, const std::string& policy, core::Seconds now,
                 std::vector<traffic::Lease>& leases) {
    try {
        for (const Json& row : Json::parse(answer)) {
            leases.push_back({.target = target_of(row),
                              .action = action_of(row),
                              .expiry = core::Seconds(now.value + row.at("lasting_s").get<double>()),
                              .priority = row.at("priority").get<int>(),
                              .policy = kept_text(row.value("policy", policy)).c_str(),
                              .reason = kept_text(row.at("reason").get<std::string>()).c_str(),
                              .beneficiary = core::VehicleKey{row.at("beneficiary").get<std::uint64_t>()}});
        }
    } catch (const Json::exception& error) {
        throw std::invalid_argument(fmt::format("an answer that is not a list of leases: {}", error.what()));
    }
}

}  // namespace clearway::policy::detail
