#pragma once

#include <bit>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "trace/detail/codec_lists.hpp"
#include "trace/recording.hpp"

namespace clearway::trace::detail {

/// Vehicles and routes that a roster got, and routes that changed, since the step before.
class RosterCodec {
  public:
    /// `keys` tells whether vehicles are registered with the stream.
    enum class Keys : std::uint8_t { registered, known };
    explicit RosterCodec(Keys keys) : keys_(keys) {}

    template <class Stream, class Roster>
    void code(Stream& stream, Roster& roster) {
        code_routes(stream, roster);
        code_changes(stream, roster);
        code_new_vehicles(stream, roster);
    }

  private:
    static bool same(const traffic::VehicleInfo& one, const traffic::VehicleInfo& other) {
        using Info = traffic::VehicleInfo;
        const auto same_real = [&](float Info::*member) {
            return std::bit_cast<std::uint32_t>(one.*member) == std::bit_cast<std::uint32_t>(other.*member);
        };
        return one.route == other.route && one.vehicle_class == other.vehicle_class &&
               one.kind == other.kind && same_real(&Info::length_m) && same_real(&Info::width_m) &&
               same_real(&Info::minimum_gap_m) && same_real(&Info::maximum_speed_mps) &&
               same_real(&Info::acceleration_mps2) && same_real(&Info::deceleration_mps2) &&
               same_real(&Info::speed_factor);
    }

    template <class Stream, class Info>
    static void code_info(Stream& stream, Info& info, const traffic::VehicleInfo& foreseen) {
        stream.choice(info.vehicle_class, foreseen.vehicle_class, traffic::vehicle_classes.size());
        stream.choice(info.kind, foreseen.kind, static_cast<std::uint64_t>(traffic::VehicleKind::other) + 1);
        stream.real(info.length_m, foreseen.length_m);
        stream.real(info.width_m, foreseen.width_m);
        stream.real(info.minimum_gap_m, foreseen.minimum_gap_m);
        stream.real(info.maximum_speed_mps, foreseen.maximum_speed_mps);
        stream.real(info.acceleration_mps2, foreseen.acceleration_mps2);
        stream.real(info.deceleration_mps2, foreseen.deceleration_mps2);
        stream.real(info.speed_factor, foreseen.speed_factor);
        stream.number(info.route, foreseen.route);
    }

    template <class Stream, class Roster>
    void code_routes(Stream& stream, Roster& roster) {
        std::vector<core::EdgeIndex> edges;
        const auto code_edges = [&](auto& route) {
            core::EdgeIndex last{0};
            list(stream, route, [&](auto& edge) {
                stream.number(edge, last);
                last = edge;
            });
        };
        if constexpr (Stream::reading) {
            for (std::size_t count = stream.size(); count > 0; --count) {
                code_edges(edges);
                if (roster.add_route(edges).value != routes_++)
                    throw std::runtime_error("a route comes twice");
            }
        } else {
            stream.size(roster.route_count() - routes_);
            for (; routes_ < roster.route_count(); ++routes_)
                code_edges(roster.route(core::RouteIndex{static_cast<std::uint32_t>(routes_)}));
        }
    }

    template <class Stream, class Roster>
    void code_changes(Stream& stream, Roster& roster) {
        changed_.clear();
        if constexpr (!Stream::reading) {
            for (std::uint32_t row = 0; row < known_.size(); ++row) {
                if (!same(known_[row], roster.vehicles()[row])) changed_.push_back(row);
            }
        }
        list(stream, changed_, [&](auto& row) {
            stream.number(row);
            if (row >= known_.size()) throw std::runtime_error("a vehicle changed that is unknown");
            code_vehicle(stream, roster, row, known_[row]);
        });
    }

    template <class Stream, class Roster>
    void code_new_vehicles(Stream& stream, Roster& roster) {
        std::size_t count = 0;
        if constexpr (Stream::reading) {
            count = stream.size();
        } else {
            count = roster.vehicles().size() - known_.size();
            stream.size(count);
        }
        for (; count > 0; --count) {
            traffic::VehicleInfo base = known_.empty() ? traffic::VehicleInfo{} : known_.back();
            const auto row = static_cast<std::uint32_t>(known_.size());
            if constexpr (Stream::reading) {
                base.id = stream.characters();
                base.key = core::vehicle_key(base.id);
            } else {
                const traffic::VehicleInfo& added = roster.vehicles()[row];
                if (added.key != core::vehicle_key(added.id))
                    throw std::invalid_argument("the key of vehicle " + added.id + " is not that of its id");
                stream.characters(added.id);
            }
            known_.push_back(base);
            code_vehicle(stream, roster, row, base);
            if (keys_ == Keys::registered) stream.register_key(known_.back().key);
        }
    }

    template <class Stream, class Roster>
    void code_vehicle(Stream& stream, Roster& roster, std::uint32_t row, const traffic::VehicleInfo& base) {
        if constexpr (Stream::reading) {
            traffic::VehicleInfo info = base;
            code_info(stream, info, base);
            if (info.route.exists() && info.route.value >= roster.route_count())
                throw std::runtime_error("a route is unknown");
            known_[row] = info;
            roster.add(info);
            if (roster.vehicles().size() != known_.size()) throw std::runtime_error("a vehicle comes twice");
        } else {
            const traffic::VehicleInfo& info = roster.vehicles()[row];
            code_info(stream, info, base);
            known_[row] = info;
        }
    }

    Keys keys_;
    std::size_t routes_ = 0;
    std::vector<traffic::VehicleInfo> known_;
    std::vector<std::uint32_t> changed_;
};

}  // namespace clearway::trace::detail
