#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "trace/detail/observation_tables.hpp"
#include "traffic/belief.hpp"

namespace clearway::trace::detail {

/// What was believed at a decision.
template <class File>
class BeliefTables {
  public:
    BeliefTables(File& file, Names& names)
        : names_(names),
          rows_(file, "belief", "What was believed: one row per decision"),
          vehicles_(file, "belief/vehicles",
                    "Believed vehicles, ordered by key; then what emergency vehicles know of themselves"),
          links_(file, "links", "Believed links"),
          signals_(file, "belief/signals",
                   "What signals are believed to show, where it differs from the observation", names) {}

    bool is_there() {
        std::size_t count = 0;
        rows_.count(count);
        return count == 1;
    }
    template <class Belief>
    void code(Belief& now, const traffic::Observation& observation, const KnownStates& known) {
        if constexpr (File::reading) {
            now.roster = observation.roster;
            now.incidents = observation.incidents;
        } else if (now.roster != observation.roster) {
            throw std::invalid_argument("a belief refers to another roster than its observation");
        } else if (now.incidents != observation.incidents) {
            throw std::invalid_argument("a belief knows other incidents than its observation");
        }
        std::size_t one = 1;
        rows_.count(one);
        code_value(time_s_, now.time);
        code_all_vehicles(now, known);
        signals_.code(now.signals, observation.signals, has_signals_);
        bool has_links = !now.first_link.empty();
        has_links_(has_links);
        bool both_ways = false;
        if constexpr (!File::reading) both_ways = is_stored_both_ways(now);
        both_ways_(both_ways);
        code_links(now, both_ways, has_links);
    }

  private:
    template <class Value>
    using Column = ColumnOf<File, Value>;

    template <class Belief>
    void code_all_vehicles(Belief& now, const KnownStates& known) {
        code_lengths<File>(vehicles_, own_states_, now);
        code_vehicles(now.vehicles, known);
        code_vehicles(now.own_states, known);
    }

    template <class Vehicles>
    void code_vehicles(Vehicles& vehicles, const KnownStates& known) {
        core::VehicleKey before;
        for (auto& vehicle : vehicles) {
            const std::uint32_t row = names_.code(vehicle_, vehicle.key);
            if (&vehicle != &vehicles.front()) require_order<File>(before, vehicle.key);
            before = vehicle.key;
            vehicle_class_(vehicle.vehicle_class);
            age_s_(vehicle.age_s);
            sigma_m_(vehicle.sigma_m);
            state_.code(vehicle.state, row, known);
        }
    }

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

    /// A link with the row of its first end among the believed vehicles.
    struct End {
        std::uint32_t row = 0;
        traffic::BelievedLink link;
    };

    /// The links of each row. When every link is stored in both directions, only those to higher rows are
    /// written.
    template <class Belief>
    void code_links(Belief& now, bool both_ways, bool has_links) {
        if constexpr (!File::reading) {
            if (has_links ? now.first_link.size() != now.vehicles.size() + 1 : !now.vehicles.empty())
                throw std::invalid_argument("a belief has links between vehicles that it does not list");
            collect(now, both_ways);
        }
        row_of_.clear();
        if constexpr (File::reading) index_rows(now.vehicles);
        list<File>(links_, ends_, [&](auto& end) {
            code_end(from_, end.row, now.vehicles);
            code_end(to_, end.link.neighbour, now.vehicles);
            const float foreseen_m = distance_m(now.vehicles[end.row], now.vehicles[end.link.neighbour]);
            code_distance(end.link.distance_m, foreseen_m);
            probability_(end.link.probability);
        });
        if constexpr (File::reading) {
            now.first_link.clear();
            now.links.clear();
            if (has_links) restore(now, both_ways);
        }
    }

    void code_distance(float& distance_m, float foreseen_m) {
        // The bits of a NaN differ between machines.
        bool is_foreseen = !std::isnan(foreseen_m) && bits(distance_m) == bits(foreseen_m);
        as_positions_(is_foreseen);
        float stored_m = is_foreseen ? std::numeric_limits<float>::quiet_NaN() : distance_m;
        distance_m_(stored_m);
        if constexpr (File::reading) distance_m = is_foreseen ? foreseen_m : stored_m;
    }

    void index_rows(const std::vector<traffic::BelievedVehicle>& vehicles) {
        for (std::uint32_t row = 0; row < vehicles.size(); ++row)
            row_of_[vehicles[row].key] = row;
    }

    /// One end of a link, coded as its vehicle.
    void code_end(OutputColumn<std::uint32_t>& column, std::uint32_t row,
                  const std::vector<traffic::BelievedVehicle>& vehicles) {
        if (row >= vehicles.size()) throw std::invalid_argument("a link has an end that is not believed");
        names_.code(column, vehicles[row].key);
    }
    void code_end(InputColumn<std::uint32_t>& column, std::uint32_t& row,
                  const std::vector<traffic::BelievedVehicle>&) {
        core::VehicleKey key;
        names_.code(column, key);
        const auto found = row_of_.find(key);
        if (found == row_of_.end()) throw std::runtime_error("a link has an end that is not believed");
        row = found->second;
    }

    void collect(const traffic::BelievedGraph& belief, bool both_ways) {
        ends_.clear();
        if (belief.first_link.empty()) return;
        for (std::uint32_t row = 0; row < belief.vehicles.size(); ++row) {
            for (const traffic::BelievedLink& link : belief.links_of(row)) {
                if (!both_ways || link.neighbour >= row) ends_.push_back({row, link});
            }
        }
    }

    void restore(traffic::BelievedGraph& belief, bool both_ways) const {
        const std::size_t rows = belief.vehicles.size();
        belief.first_link.assign(rows + 1, 0);
        for (const End& end : ends_) {
            ++belief.first_link[end.row + 1];
            if (both_ways) ++belief.first_link[end.link.neighbour + 1];
        }
        for (std::size_t row = 0; row < rows; ++row)
            belief.first_link[row + 1] += belief.first_link[row];
        std::vector<std::uint32_t> next(belief.first_link.begin(), belief.first_link.end() - 1);
        belief.links.assign(belief.first_link.back(), {});
        for (const End& end : ends_) {
            const traffic::BelievedLink& link = end.link;
            belief.links[next[end.row]++] = link;
            if (both_ways)
                belief.links[next[link.neighbour]++] = {end.row, link.distance_m, link.probability};
        }
    }

    Names& names_;
    typename File::Rows rows_, vehicles_, links_;
    Column<double> time_s_{rows_, {"time_s", "s", "Time of what is believed"}};
    Column<std::uint32_t> own_states_{
        rows_,
        {"own_states", "1",
         "How many of the vehicles, counted from the end, are emergency vehicles' own states"}};
    Column<bool> has_signals_{rows_,
                              {"has_signals", "", "The believed signals differ from the observed ones"}};
    Column<bool> has_links_{rows_, {"has_links", "", "Links were looked for"}};
    Column<bool> both_ways_{rows_,
                            {"both_ways", "", "Each row of /links stands for both directions of a link"}};
    Column<std::uint32_t> vehicle_{vehicles_, vehicle_column};
    Column<traffic::VehicleClass> vehicle_class_{vehicles_, class_column, class_names};
    Column<float> age_s_{vehicles_, {"age_s", "s", "Age of the report that the belief rests on"}};
    Column<float> sigma_m_{vehicles_, {"sigma_m", "m", "Standard deviation of the position along the route"}};
    StateColumns<File> state_{vehicles_};
    Column<std::uint32_t> from_{links_, {"from", "", "Row in /vehicles"}};
    Column<std::uint32_t> to_{links_, {"to", "", "Row in /vehicles"}};
    Column<bool> as_positions_{
        links_, {"as_positions", "", "The distance equals that of the believed positions, bit for bit"}};
    Column<float> distance_m_{links_, {"distance_m", "m", "Believed distance; NaN: see as_positions"}};
    Column<float> probability_{
        links_, {"probability", "1", "Probability that the true distance is below the link radius"}};
    SignalTable<File> signals_;
    std::vector<End> ends_;
    std::unordered_map<core::VehicleKey, std::uint32_t> row_of_;
};

}  // namespace clearway::trace::detail
