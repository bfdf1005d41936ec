#pragma once

#include <charconv>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "trace/detail/enumerations.hpp"
#include "trace/detail/tables.hpp"
#include "traffic/lease.hpp"

namespace clearway::trace::detail {

/// Numbers separated by blanks.
template <class Number>
std::string number_list(const std::vector<Number>& numbers) {
    return fmt::format("{}", fmt::join(numbers, " "));
}
inline std::string number_list(const std::vector<core::EdgeIndex>& way) {
    std::vector<std::uint32_t> edges;
    for (const core::EdgeIndex edge : way)
        edges.push_back(edge.value);
    return number_list(edges);
}
template <class Number>
std::vector<Number> numbers_from(const std::string& text) {
    std::vector<Number> numbers;
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); at < end; ++at) {
        const auto [next, error] = std::from_chars(at, end, numbers.emplace_back());
        if (error != std::errc() || (next != end && *next != ' '))
            throw std::runtime_error("links of a signal, or edges of a way, are not numbers");
        at = next;
    }
    return numbers;
}

inline std::vector<core::EdgeIndex> way_from(const std::string& text) {
    std::vector<core::EdgeIndex> way;
    for (const std::uint32_t edge : numbers_from<std::uint32_t>(text))
        way.push_back({edge});
    return way;
}

/// The leases that a decision issued.
template <class File>
class LeaseTables {
  public:
    LeaseTables(File& file, Names& names)
        : names_(names), rows_(file, "leases", "The leases issued by the decision of the step") {}

    template <class Leases>
    void code(Leases& leases) {
        list<File>(rows_, leases, [&](auto& lease) {
            code_target(lease.target);
            code_action(lease.action);
            code_value(expiry_s_, lease.expiry);
            code_priority(lease.priority);
            names_.code_text(policy_, lease.policy);
            names_.code_text(reason_, lease.reason);
            names_.code(beneficiary_, lease.beneficiary);
        });
    }

  private:
    template <class Value>
    using Column = ColumnOf<File, Value>;

    /// The members of all actions.
    struct Members {
        double speed_mps = 0.0;
        std::uint32_t lane_number = 0;
        traffic::Side side = traffic::Side::right;
        std::string links, own_links;
    };

    template <class Target>
    void code_target(Target& target) {
        core::SignalIndex signal;
        core::VehicleKey vehicle;
        traffic::Stretch stretch;
        if constexpr (!File::reading) {
            if (const auto* const index = std::get_if<core::SignalIndex>(&target)) {
                if (!index->exists())
                    throw std::invalid_argument("a lease is for a signal that does not exist");
                signal = *index;
            } else if (const auto* const place = std::get_if<traffic::Stretch>(&target)) {
                if (!place->lane.exists())
                    throw std::invalid_argument("a lease is for a lane that does not exist");
                stretch = *place;
            } else {
                vehicle = std::get<core::VehicleKey>(target);
            }
        }
        code_value(signal_, signal);
        names_.code(vehicle_, vehicle);
        code_value(stretch_lane_, stretch.lane);
        stretch_from_m_(stretch.from_m);
        stretch_to_m_(stretch.to_m);
        stretch_below_mps_(stretch.below_mps);
        stretch_addressed_(stretch.addressed);
        if constexpr (File::reading) {
            if (signal.exists()) {
                target = signal;
            } else if (stretch.lane.exists()) {
                target = stretch;
            } else {
                target = vehicle;
            }
        }
    }

    template <class Priority>
    void code_priority(Priority& priority) {
        std::int32_t number = priority;
        priority_(number);
        if constexpr (File::reading) priority = number;
    }

    template <class Action>
    void code_action(Action& action) {
        auto kind = static_cast<ActionKind>(action.index());
        action_(kind);
        Members members;
        if constexpr (!File::reading) std::visit([&](const auto& one) { take(members, one); }, action);
        speed_mps_(members.speed_mps);
        lane_number_(members.lane_number);
        side_(members.side);
        names_.code_text(links_, members.links);
        names_.code_text(own_links_, members.own_links);
        if constexpr (File::reading) {
            action = empty_action(kind);
            std::visit([&](auto& one) { give(members, one); }, action);
        }
    }

    template <class Action>
    static void take(Members& members, const Action& action) {
        if constexpr (std::is_same_v<Action, traffic::DriveAt>) {
            members.speed_mps = action.speed.value;
        } else if constexpr (std::is_same_v<Action, traffic::ChangeLane>) {
            members.lane_number = action.lane_number;
        } else if constexpr (std::is_same_v<Action, traffic::PullAside>) {
            members.side = action.side;
        } else if constexpr (std::is_same_v<Action, traffic::HoldGreen>) {
            members.links = number_list(action.links);
            members.own_links = number_list(action.own_links);
        } else if constexpr (std::is_same_v<Action, traffic::AdjustGreen>) {
            members.links = number_list(action.links);
        } else if constexpr (std::is_same_v<Action, traffic::TakeRoute>) {
            members.links = number_list(action.edges);
        } else if constexpr (std::is_same_v<Action, traffic::StandBack>) {
            members.links = number_list(action.way);
        } else {
            static_assert(std::is_empty_v<Action>, "a new action must be coded here");
        }
    }

    template <class Action>
    static void give(const Members& members, Action& action) {
        if constexpr (std::is_same_v<Action, traffic::DriveAt>) {
            action.speed.value = members.speed_mps;
        } else if constexpr (std::is_same_v<Action, traffic::ChangeLane>) {
            action.lane_number = members.lane_number;
        } else if constexpr (std::is_same_v<Action, traffic::PullAside>) {
            action.side = members.side;
        } else if constexpr (std::is_same_v<Action, traffic::HoldGreen>) {
            action.links = numbers_from<std::uint16_t>(members.links);
            action.own_links = numbers_from<std::uint16_t>(members.own_links);
        } else if constexpr (std::is_same_v<Action, traffic::AdjustGreen>) {
            action.links = numbers_from<std::uint16_t>(members.links);
        } else if constexpr (std::is_same_v<Action, traffic::TakeRoute>) {
            action.edges = way_from(members.links);
        } else if constexpr (std::is_same_v<Action, traffic::StandBack>) {
            action.way = way_from(members.links);
        } else {
            static_assert(std::is_empty_v<Action>, "a new action must be coded here");
        }
    }

    Names& names_;
    typename File::Rows rows_;
    Column<std::uint32_t> vehicle_{
        rows_, {"vehicle", "", "Row in /vehicles: the vehicle asked; 4294967295: a signal or a stretch"}};
    Column<std::uint32_t> signal_{rows_,
                                  {"signal", "", "Index in the network: the signal asked; 4294967295: none"}};
    Column<std::uint32_t> stretch_lane_{
        rows_,
        {"stretch_lane", "", "Lane of the network: whoever is on this stretch is asked; 4294967295: none"}};
    Column<float> stretch_from_m_{rows_, {"stretch_from_m", "m", "From the start of the lane"}};
    Column<float> stretch_to_m_{rows_, {"stretch_to_m", "m", "From the start of the lane"}};
    Column<float> stretch_below_mps_{rows_, {"stretch_below_mps", "m/s", "Only slower vehicles are asked"}};
    Column<traffic::Addressed> stretch_addressed_{
        rows_, {"stretch_addressed", "", "Automated vehicles, or human drivers as well"}, addressed_names};
    Column<ActionKind> action_{rows_, {"action", "", "What is asked"}, action_names};
    Column<double> speed_mps_{rows_, {"speed_mps", "m/s", "Speed of drive_at"}};
    Column<std::uint32_t> lane_number_{rows_, {"lane_number", "1", "Lane of change_lane; 0: the outermost"}};
    Column<traffic::Side> side_{rows_, {"side", "", "Side of pull_aside"}, side_names};
    Column<std::uint32_t> links_{
        rows_, {"links", "", "Row in /texts: links of a signal, or edges of a way, separated by blanks"}};
    Column<std::uint32_t> own_links_{
        rows_, {"own_links", "", "Row in /texts: the links that the beneficiary may take itself"}};
    Column<double> expiry_s_{rows_, {"expiry_s", "s", "Simulation time at which the lease ends"}};
    Column<std::int32_t> priority_{rows_, {"priority", "1", "The higher priority wins"}};
    Column<std::uint32_t> policy_{rows_, {"policy", "", "Row in /texts: the policy that asked"}};
    Column<std::uint32_t> reason_{rows_, {"reason", "", "Row in /texts"}};
    Column<std::uint32_t> beneficiary_{
        rows_, {"beneficiary", "", "Row in /vehicles: the emergency vehicle served; 4294967295: none"}};
};

}  // namespace clearway::trace::detail
