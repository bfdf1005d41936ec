#include "prediction/net_rows.hpp"

#include <cassert>
#include <cmath>

namespace clearway::prediction {

void message_graph_from(std::span<const std::uint32_t> sources, std::span<const std::uint32_t> targets,
                        std::size_t row_count, MessageGraph& graph) {
    assert(sources.size() == targets.size());
    graph.first.assign(row_count + 1, 0);
    graph.source.resize(sources.size());
    for (const std::uint32_t target : targets) {
        assert(target < row_count);
        ++graph.first[target + 1];
    }
    for (std::size_t row = 0; row < row_count; ++row) {
        graph.first[row + 1] += graph.first[row];
    }
    for (std::size_t edge = 0; edge < sources.size(); ++edge) {
        graph.source[graph.first[targets[edge]]++] = sources[edge];
    }
    // Each start was moved to the end of its row, which is the start of the next one.
    for (std::size_t row = row_count; row > 0; --row) {
        graph.first[row] = graph.first[row - 1];
    }
    graph.first[0] = 0;
}

float probability_from_logit(float logit) {
    return 1.0F / (1.0F + std::exp(-logit));
}

Kernel best_kernel() {
    return __builtin_cpu_supports("avx2") ? Kernel::avx2 : Kernel::scalar;
}

}  // namespace clearway::prediction
