#include "results/record_difference.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/csv.hpp"

namespace clearway::results {
namespace {

class Finder {
  public:
    void cell(const std::string& column, const std::string& one, const std::string& other) {
        if (one != other) found.push_back({table, row, column, one, other});
    }
    template <class Struct>
    void fields(const Struct& one, const Struct& other) {
        core::for_each_field<Struct>([&](const auto& field) {
            cell(field.name, core::csv_cell(one.*field.member), core::csv_cell(other.*field.member));
        });
    }

    std::string table;
    std::string row;
    std::vector<CellDifference> found;
};

void compare_vehicles(Finder& finder, const std::vector<metrics::VehicleRow>& one,
                      const std::vector<metrics::VehicleRow>& other) {
    for (std::size_t i = 0; i < std::max(one.size(), other.size()); ++i) {
        const metrics::VehicleRow& shown = i < one.size() ? one[i] : other[i];
        finder.row = fmt::format("{} ({})", i + 1, shown.id);
        if (i >= one.size() || i >= other.size()) {
            finder.cell("(row)", i < one.size() ? "there" : "missing",
                        i < other.size() ? "there" : "missing");
            continue;
        }
        finder.cell("id", one[i].id, other[i].id);
        finder.cell("class", std::string(traffic::name(one[i].vehicle_class)),
                    std::string(traffic::name(other[i].vehicle_class)));
        finder.cell("kind", std::string(traffic::name(one[i].kind)),
                    std::string(traffic::name(other[i].kind)));
        finder.cell("outcome", std::string(metrics::name(one[i].outcome)),
                    std::string(metrics::name(other[i].outcome)));
        finder.fields(one[i], other[i]);
    }
}

}  // namespace

std::vector<CellDifference> differences(const RunRecord& one, const RunRecord& other) {
    Finder finder;
    finder.table = "provenance";
    finder.fields(one.provenance, other.provenance);
    finder.table = "metrics";
    finder.fields(one.metrics, other.metrics);
    finder.table = "vehicles";
    compare_vehicles(finder, one.vehicles, other.vehicles);
    return std::move(finder.found);
}

}  // namespace clearway::results
