#pragma once

#include <cstddef>

#include "core/fields.hpp"
#include "traffic/belief.hpp"

namespace clearway::policy::detail {

/// When the dissertation's policies act, and which links they see.
struct EdgeRule {
    std::size_t min_edges = 1;
    double link_threshold = 0.5;

    bool has_sufficient_edges(const traffic::BelievedGraph& belief) const {
        return belief.link_count() > 0 && belief.link_count() >= min_edges;
    }
    bool counts(const traffic::BelievedLink& link) const { return link.probability >= link_threshold; }

    static constexpr void fields(const auto& table) {
        using C = EdgeRule;
        using core::Field;
        table(Field{"min_edges", "1", &C::min_edges, 0.0, 1e6, "Acts only on a graph with this many links",
                    "4.3: \"sufficient edges\", no number given"},
              Field{"link_threshold", "1", &C::link_threshold, 0.0, 1.0,
                    "A link counts if its probability is at least this", "even odds"});
    }
};

}  // namespace clearway::policy::detail
