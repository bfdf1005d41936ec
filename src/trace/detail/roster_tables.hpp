#pragma once

#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "trace/detail/enumerations.hpp"
#include "trace/detail/tables.hpp"
#include "traffic/vehicle.hpp"

namespace clearway::trace::detail {

/// Vehicles and routes added to a roster, and vehicles that changed, since the previous step.
template <class File>
class RosterTables {
  public:
    /// `prefix` of the groups: "" or "observation/".
    RosterTables(File& file, const std::string& prefix, Names& names)
        : names_(names),
          routes_(file, prefix + "routes", "Routes in the order of their numbers"),
          route_edges_(file, prefix + "route_edges", "Their edges, in driving order"),
          roster_(file, prefix + "roster", "Vehicles that were registered or whose entry changed") {}

    template <class Roster>
    void code(Roster& roster) {
        code_routes(roster);
        code_vehicles(roster);
    }

  private:
    template <class Value>
    using Column = ColumnOf<File, Value>;
    using Info = traffic::VehicleInfo;

    template <class Roster>
    void code_routes(Roster& roster) {
        std::vector<std::vector<core::EdgeIndex>> added;
        std::size_t edges = 0;
        if constexpr (!File::reading) {
            for (; known_routes_ < roster.route_count(); ++known_routes_) {
                added.push_back(roster.route(core::RouteIndex{static_cast<std::uint32_t>(known_routes_)}));
                edges += added.back().size();
            }
        }
        route_edges_.count(edges);
        list<File>(routes_, added, [&](auto& route) {
            auto count = static_cast<std::uint32_t>(route.size());
            edge_count_(count);
            if constexpr (File::reading) {
                if (count > edges) throw std::runtime_error("a route has more edges than there are");
                edges -= count;
                route.resize(count);
            }
            for (auto& edge : route)
                code_value(edge_, edge);
            if constexpr (File::reading) {
                if (roster.add_route(route).value != known_routes_++)
                    throw std::runtime_error("a route is listed twice");
            }
        });
    }

    template <class Roster>
    void code_vehicles(Roster& roster) {
        std::vector<Info> changed;
        if constexpr (!File::reading) {
            for (std::size_t row = 0; row < roster.vehicles().size(); ++row) {
                const Info& info = roster.vehicles()[row];
                if (row < known_.size() && same(known_[row], info)) continue;
                changed.push_back(info);
                known_.resize(std::max(known_.size(), row + 1));
                known_[row] = info;
            }
        }
        list<File>(roster_, changed, [&](auto& info) {
            code_identity(info);
            vehicle_class_(info.vehicle_class);
            kind_(info.kind);
            length_m_(info.length_m);
            width_m_(info.width_m);
            minimum_gap_m_(info.minimum_gap_m);
            maximum_speed_mps_(info.maximum_speed_mps);
            acceleration_mps2_(info.acceleration_mps2);
            deceleration_mps2_(info.deceleration_mps2);
            speed_factor_(info.speed_factor);
            code_value(route_, info.route);
            if constexpr (File::reading) {
                if (info.route.exists() && info.route.value >= roster.route_count())
                    throw std::runtime_error("a route is unknown");
                roster.add(info);
            }
        });
    }

    void code_identity(Info& info) {
        if constexpr (File::reading) {
            std::uint32_t row = none;
            vehicle_(row);
            info.key = names_.key(row);
            info.id = names_.id(row);
        } else {
            if (info.key != core::vehicle_key(info.id))
                throw std::invalid_argument("the key of vehicle " + info.id + " is not that of its id");
            const std::uint32_t row = names_.vehicle(info.key);
            names_.id(row) = info.id;
            vehicle_(row);
        }
    }

    static bool same(const Info& one, const Info& other) {
        const auto same_real = [&](float Info::*member) {
            return std::bit_cast<std::uint32_t>(one.*member) == std::bit_cast<std::uint32_t>(other.*member);
        };
        return one.route == other.route && one.vehicle_class == other.vehicle_class &&
               one.kind == other.kind && same_real(&Info::length_m) && same_real(&Info::width_m) &&
               same_real(&Info::minimum_gap_m) && same_real(&Info::maximum_speed_mps) &&
               same_real(&Info::acceleration_mps2) && same_real(&Info::deceleration_mps2) &&
               same_real(&Info::speed_factor);
    }

    Names& names_;
    typename File::Rows routes_, route_edges_, roster_;
    Column<std::uint32_t> edge_count_{routes_, {"edges", "1", "Edges of the route"}};
    Column<std::uint32_t> edge_{route_edges_, {"edge", "", "Index of the edge in the network"}};
    Column<std::uint32_t> vehicle_{roster_, vehicle_column};
    Column<traffic::VehicleClass> vehicle_class_{roster_, class_column, class_names};
    Column<traffic::VehicleKind> kind_{roster_, {"kind", "", "What the vehicle is"}, kind_names};
    Column<float> length_m_{roster_, {"length_m", "m", ""}};
    Column<float> width_m_{roster_, {"width_m", "m", ""}};
    Column<float> minimum_gap_m_{roster_,
                                 {"minimum_gap_m", "m", "Gap kept to the vehicle ahead at standstill"}};
    Column<float> maximum_speed_mps_{roster_, {"maximum_speed_mps", "m/s", ""}};
    Column<float> acceleration_mps2_{
        roster_, {"acceleration_mps2", "m/s^2", "Greatest acceleration in normal driving"}};
    Column<float> deceleration_mps2_{
        roster_, {"deceleration_mps2", "m/s^2", "Greatest deceleration in normal driving"}};
    Column<float> speed_factor_{roster_, {"speed_factor", "1", "Desired speed divided by the limit"}};
    Column<std::uint32_t> route_{roster_, {"route", "", "Number of the route; 4294967295: none"}};

    std::size_t known_routes_ = 0;
    std::vector<Info> known_;
};

}  // namespace clearway::trace::detail
