#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace clearway::prediction {

// What the nets of this module are given beside numbers: rows that send messages, and pairs of rows.

/// Where messages come from, in CSR form by receiver: row i receives from source[first[i]] ... source[first[i
/// + 1] - 1]. A source that stands twice counts twice in the mean, as in PyTorch Geometric.
struct MessageGraph {
    std::vector<std::uint32_t> first = {0};
    std::vector<std::uint32_t> source;
};

/// From an edge list as PyTorch Geometric has it: a message flows from `sources[e]` to `targets[e]`. Keeps
/// the order of the list within a row. Indices must be below `row_count`.
void message_graph_from(std::span<const std::uint32_t> sources, std::span<const std::uint32_t> targets,
                        std::size_t row_count, MessageGraph& graph);

/// Two rows whose link is scored. The score does not depend on their order.
struct RowPair {
    std::uint32_t left = 0;
    std::uint32_t right = 0;
    auto operator<=>(const RowPair&) const = default;
};

/// The logistic function: the probability for a logit.
float probability_from_logit(float logit);

/// Which machine code runs. Both give the same bits: they add in one order and round after every operation.
enum class Kernel { scalar, avx2 };
/// The fastest that this processor has.
Kernel best_kernel();

}  // namespace clearway::prediction
