#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "trace/detail/observation_codec.hpp"

namespace clearway::trace::detail {

/// Believed vehicles, expected to be where they reported to be, or where they are.
class BelievedVehiclesCodec {
  public:
    template <class Stream, class Vehicles>
    void code(Stream& stream, Vehicles& now, const std::vector<traffic::ObservedVehicle>& reports,
              const std::vector<core::VehicleKey>& report_keys, const truth::Snapshot& snapshot) {
        keys_.code_rows(stream, now);
        core::match_rows(keys_.now(), report_keys, report_row_);
        core::match_rows(keys_.now(), snapshot.key, true_row_);
        code_columns(stream, now, reports, snapshot);
    }

  private:
    template <class Stream, class Vehicles>
    void code_columns(Stream& stream, Vehicles& now, const std::vector<traffic::ObservedVehicle>& reports,
                      const truth::Snapshot& snapshot) {
        const traffic::ObservedVehicle nobody;
        const auto report = [&](std::uint32_t row) -> const traffic::ObservedVehicle& {
            return report_row_[row] == no_row ? nobody : reports[report_row_[row]];
        };
        const std::size_t rows = now.size();
        column(stream, rows, [&](std::uint32_t row) {
            stream.choice(now[row].vehicle_class, report(row).vehicle_class, traffic::vehicle_classes.size());
        });
        column(stream, rows, [&](std::uint32_t row) { stream.real(now[row].age_s, report(row).age_s); });
        column(stream, rows, [&](std::uint32_t row) {
            const bool as_above = row > 0 && now[row].age_s == now[row - 1].age_s;
            stream.real(now[row].sigma_m, as_above ? now[row - 1].sigma_m : report(row).position_sigma_m);
        });
        code_motion(
            stream, rows, [&](std::uint32_t row) -> auto& { return now[row].state; },
            [&](std::uint32_t row) {
                traffic::MotionState state = report(row).state;
                if (now[row].age_s == 0.0F || true_row_[row] == no_row) return state;
                state.x_m = snapshot.x_m[true_row_[row]];
                state.y_m = snapshot.y_m[true_row_[row]];
                state.lane_position_m = snapshot.lane_position_m[true_row_[row]];
                return state;
            });
    }

    KeyList keys_;
    std::vector<std::uint32_t> report_row_, true_row_;
};

class BeliefCodec {
  public:
    template <class Stream, class Belief>
    void code(Stream& stream, Belief& now, const traffic::Observation& observation,
              const truth::Snapshot& snapshot, const ObservationCodec& reports) {
        stream.real(now.time.value, observation.time.value);
        if constexpr (Stream::reading) {
            now.roster = observation.roster;
        } else if (now.roster != observation.roster) {
            throw std::invalid_argument("a belief refers to another roster than its observation");
        }
        vehicles_.code(stream, now.vehicles, observation.vehicles, reports.keys(), snapshot);
        own_states_.code(stream, now.own_states, observation.own_states, reports.own_keys(), snapshot);
        code_signals(stream, now.signals, observation.signals);
        bool both_ways = true;
        if constexpr (!Stream::reading) both_ways = is_stored_both_ways(now);
        stream.number(both_ways, true);
        code_links(stream, now, both_ways);
    }

  private:
    static float distance_m(const traffic::BelievedVehicle& left, const traffic::BelievedVehicle& right) {
        const float across_m = left.state.x_m - right.state.x_m;
        const float along_m = left.state.y_m - right.state.y_m;
        return std::sqrt(across_m * across_m + along_m * along_m);
    }

    static std::uint32_t bits(float number) { return std::bit_cast<std::uint32_t>(number); }

    static bool is_stored_both_ways(const traffic::BelievedGraph& belief) {
        if (belief.first_link.size() != belief.vehicles.size() + 1) return false;
        std::vector<std::uint32_t> next(belief.first_link.begin(), belief.first_link.end() - 1);
        for (std::uint32_t row = 0; row < belief.vehicles.size(); ++row) {
            std::uint32_t above = 0;
            for (const traffic::BelievedLink& link : belief.links_of(row)) {
                if (link.neighbour == row || link.neighbour >= belief.vehicles.size()) return false;
                if (above > 0 && link.neighbour < above) return false;
                above = link.neighbour + 1;
                if (link.neighbour < row) continue;
                std::uint32_t& at = next[link.neighbour];
                if (at == belief.first_link[link.neighbour + 1]) return false;
                const traffic::BelievedLink& back = belief.links[at++];
                if (back.neighbour != row || bits(back.distance_m) != bits(link.distance_m) ||
                    bits(back.probability) != bits(link.probability))
                    return false;
            }
        }
        for (std::uint32_t row = 0; row < belief.vehicles.size(); ++row) {
            const auto links = belief.links_of(row);
            const auto higher =
                std::ranges::find_if(links, [&](const auto& link) { return link.neighbour > row; });
            if (next[row] != belief.first_link[row] + static_cast<std::uint32_t>(higher - links.begin()))
                return false;
        }
        return true;
    }

    /// The links of each row; where all are stored both ways, only those to higher rows.
    template <class Stream, class Belief>
    void code_links(Stream& stream, Belief& now, bool both_ways) {
        const auto rows = static_cast<std::uint32_t>(now.vehicles.size());
        if constexpr (!Stream::reading) collect(now, both_ways);
        auto first_links = static_cast<std::uint32_t>(now.first_link.size());
        stream.number(first_links, rows + 1);
        if (first_links != rows + 1) {
            if (first_links != 0 || rows != 0) throw std::runtime_error("links of no vehicle");
            if constexpr (Stream::reading) now.first_link.clear();
        }
        if constexpr (Stream::reading) count_.assign(rows, 0);
        column(stream, rows, [&](std::uint32_t row) { stream.number(count_[row], 0U); });
        std::size_t total = 0;
        for (const std::uint32_t count : count_)
            total += count;
        if constexpr (Stream::reading) {
            if (total > std::size_t{rows} * rows) throw std::runtime_error("there are too many links");
            links_.assign(total, {});
            left_.clear();
            for (std::uint32_t row = 0; row < rows; ++row)
                left_.insert(left_.end(), count_[row], row);
        }
        const auto links = static_cast<std::uint32_t>(total);
        column(stream, links, [&](std::uint32_t at) {
            const bool starts = at == 0 || left_[at - 1] != left_[at];
            const std::uint32_t above = starts ? (both_ways ? left_[at] : no_row) : links_[at - 1].neighbour;
            stream.number(links_[at].neighbour, above + 1);
            if (links_[at].neighbour >= rows) throw std::runtime_error("a neighbour is unknown");
        });
        column(stream, links, [&](std::uint32_t at) {
            stream.real(links_[at].distance_m,
                        distance_m(now.vehicles[left_[at]], now.vehicles[links_[at].neighbour]));
        });
        column(stream, links, [&](std::uint32_t at) { stream.real(links_[at].probability, 1.0F); });
        if constexpr (Stream::reading) {
            if (first_links != 0) restore(now, both_ways);
        }
    }

    void collect(const traffic::BelievedGraph& belief, bool both_ways) {
        count_.assign(belief.vehicles.size(), 0);
        links_.clear();
        left_.clear();
        for (std::uint32_t row = 0; row < belief.vehicles.size(); ++row) {
            for (const traffic::BelievedLink& link : belief.links_of(row)) {
                if (both_ways && link.neighbour < row) continue;
                links_.push_back(link);
                left_.push_back(row);
                ++count_[row];
            }
        }
    }

    void restore(traffic::BelievedGraph& belief, bool both_ways) const {
        const std::size_t rows = belief.vehicles.size();
        belief.first_link.assign(rows + 1, 0);
        for (std::size_t at = 0; at < links_.size(); ++at) {
            ++belief.first_link[left_[at] + 1];
            if (both_ways) ++belief.first_link[links_[at].neighbour + 1];
        }
        for (std::size_t row = 0; row < rows; ++row)
            belief.first_link[row + 1] += belief.first_link[row];
        std::vector<std::uint32_t> next(belief.first_link.begin(), belief.first_link.end() - 1);
        belief.links.assign(belief.first_link.back(), {});
        for (std::size_t at = 0; at < links_.size(); ++at) {
            const traffic::BelievedLink& link = links_[at];
            belief.links[next[left_[at]]++] = link;
            if (both_ways)
                belief.links[next[link.neighbour]++] = {left_[at], link.distance_m, link.probability};
        }
    }

    BelievedVehiclesCodec vehicles_, own_states_;
    std::vector<std::uint32_t> count_, left_;
    std::vector<traffic::BelievedLink> links_;
};

}  // namespace clearway::trace::detail
