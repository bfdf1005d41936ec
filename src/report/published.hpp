#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "report/facts.hpp"

namespace clearway::report {

/// The dissertation's TABLES II to IV, each cell from one unseeded run. They are shown beside the results in
/// columns of their own and are not used in computations.
struct PublishedTable {
    std::string_view scenario;
    std::string_view caption;  ///< `TABLE II. PERFORMANCE ON MERGE`.
    std::string_view figure;   ///< Of the network: `Fig. 1`.
};

/// The table of a scenario; empty if the dissertation has none.
std::optional<PublishedTable> published_table(std::string_view scenario);

/// The caption of the table that belongs to `scenario`, with the scenario's own name if it is a variant;
/// empty if the dissertation has none.
std::string published_caption(const ScenarioFacts& scenario);

/// The cell of a condition by its name (`baseline`, `graph_simulation`, `graph_graphsage`), s. Empty if the
/// dissertation has none. Its one row of GraphSAGE also belongs to `graph_graphsage_as_published`, because
/// that is the net which it used.
std::optional<double> published_value(std::string_view scenario, std::string_view condition, Measure measure);

/// Whether the tables of the dissertation have this column.
bool is_published(Measure measure);

}  // namespace clearway::report
