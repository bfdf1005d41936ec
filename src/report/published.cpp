#include "report/published.hpp"

#include <array>

#include <fmt/format.h>

namespace clearway::report {
namespace {

struct Row {
    std::string_view scenario;
    std::string_view condition;
    double emergency_waiting_time_s;
    double depart_delay_s;
    double average_waiting_time_s;
};

// Chapter 7 of the dissertation, TABLES II, III and IV, as printed there.
constexpr std::array<Row, 9> dissertation_rows = {{
    {"merge", "baseline", 7.2, 1.2, 12.8},
    {"merge", "graph_simulation", 5.5, 0.0, 10.2},
    {"merge", "graph_graphsage", 6.1, 0.3, 11.1},
    {"intersection", "baseline", 9.2, 2.4, 15.8},
    {"intersection", "graph_simulation", 3.5, 0.2, 3.2},
    {"intersection", "graph_graphsage", 3.8, 0.5, 3.1},
    {"city", "baseline", 12.2, 2.6, 20.8},
    {"city", "graph_simulation", 4.8, 0.4, 8.1},
    {"city", "graph_graphsage", 4.9, 0.8, 9.6},
}};

constexpr std::array<PublishedTable, 3> dissertation_tables = {{
    {"merge", "TABLE II. PERFORMANCE ON MERGE", "Fig. 1"},
    {"intersection", "TABLE III. PERFORMANCE ON INTERSECTION", "Fig. 2"},
    {"city", "TABLE IV. PERFORMANCE ON CITY NETWORK", "Fig. 3"},
}};

}  // namespace

std::optional<PublishedTable> published_table(std::string_view scenario) {
    for (const PublishedTable& table : dissertation_tables) {
        if (table.scenario == scenario) return table;
    }
    return std::nullopt;
}

std::string published_caption(const ScenarioFacts& scenario) {
    const auto table = published_table(scenario.published_as);
    if (!table) return "";
    const bool is_variant = scenario.name != scenario.published_as;
    return is_variant ? fmt::format("{} (here: {})", table->caption, scenario.name)
                      : std::string(table->caption);
}

std::optional<double> published_value(std::string_view scenario, std::string_view condition,
                                      Measure measure) {
    const std::string_view published_row =
        condition == "graph_graphsage_as_published" ? "graph_graphsage" : condition;
    for (const Row& row : dissertation_rows) {
        if (row.scenario != scenario || row.condition != published_row) continue;
        if (measure == Measure::emergency_waiting_time) return row.emergency_waiting_time_s;
        if (measure == Measure::emergency_depart_delay) return row.depart_delay_s;
        if (measure == Measure::waiting_time) return row.average_waiting_time_s;
    }
    return std::nullopt;
}

bool is_published(Measure measure) {
    return measure == Measure::emergency_waiting_time || measure == Measure::emergency_depart_delay ||
           measure == Measure::waiting_time;
}

}  // namespace clearway::report
