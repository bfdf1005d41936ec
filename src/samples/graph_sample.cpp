#include "samples/graph_sample.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "samples/detail/sample_file.hpp"

namespace clearway::samples {
namespace {

using detail::append;
using detail::ByteReader;

constexpr std::string_view graph_first_line = "clearway graph samples 1\n";

/// What is wrong with a sample, or empty.
std::string fault(const GraphSample& sample, std::uint32_t feature_count) {
    if (!std::isfinite(sample.time_s)) return "the time is not finite";
    if (sample.features.size() != std::size_t{sample.vehicle_count} * feature_count) {
        return fmt::format("{} feature values for {} vehicles of {} features", sample.features.size(),
                           sample.vehicle_count, feature_count);
    }
    if (!std::ranges::all_of(sample.features, [](float value) { return std::isfinite(value); })) {
        return "a feature is not finite";
    }
    for (const ObservedEdge& edge : sample.observed_edges) {
        if (edge.left >= edge.right || edge.right >= sample.vehicle_count) {
            return fmt::format("observed edge {} - {} in a sample of {} vehicles", edge.left, edge.right,
                               sample.vehicle_count);
        }
    }
    for (const CandidatePair& pair : sample.candidates) {
        if (pair.left >= pair.right || pair.right >= sample.vehicle_count) {
            return fmt::format("candidate {} - {} in a sample of {} vehicles", pair.left, pair.right,
                               sample.vehicle_count);
        }
        if (!std::isfinite(pair.dead_reckoned_m) || pair.dead_reckoned_m < 0) {
            return fmt::format("a dead-reckoned distance of {} m", pair.dead_reckoned_m);
        }
        if (pair.linked > 1) return fmt::format("the label {}", pair.linked);
    }
    return {};
}

GraphSample read_sample(ByteReader& reader, std::uint32_t feature_count) {
    GraphSample sample;
    sample.time_s = reader.next<double>();
    sample.vehicle_count = reader.next_count(sizeof(float) * feature_count);
    const auto edge_count = reader.next_count(8);
    const auto candidate_count = reader.next_count(13);
    sample.features.resize(std::size_t{sample.vehicle_count} * feature_count);
    for (float& value : sample.features)
        value = reader.next<float>();
    sample.observed_edges.resize(edge_count);
    for (ObservedEdge& edge : sample.observed_edges) {
        edge.left = reader.next<std::uint32_t>();
        edge.right = reader.next<std::uint32_t>();
    }
    sample.candidates.resize(candidate_count);
    for (CandidatePair& pair : sample.candidates) {
        pair.left = reader.next<std::uint32_t>();
        pair.right = reader.next<std::uint32_t>();
        pair.dead_reckoned_m = reader.next<float>();
        pair.linked = reader.next<std::uint8_t>();
    }
    return sample;
}

}  // namespace

GraphSampleWriter::GraphSampleWriter(const SampleOrigin& origin)
    : SampleFileWriter(graph_first_line, origin), feature_count_(origin.features.width) {}

void GraphSampleWriter::add(const GraphSample& sample) {
    std::string& bytes = bytes_of_sample(fault(sample, feature_count_));
    append(bytes, sample.time_s);
    append(bytes, sample.vehicle_count);
    append(bytes, static_cast<std::uint32_t>(sample.observed_edges.size()));
    append(bytes, static_cast<std::uint32_t>(sample.candidates.size()));
    for (float value : sample.features)
        append(bytes, value);
    for (const ObservedEdge& edge : sample.observed_edges) {
        append(bytes, edge.left);
        append(bytes, edge.right);
    }
    for (const CandidatePair& pair : sample.candidates) {
        append(bytes, pair.left);
        append(bytes, pair.right);
        append(bytes, pair.dead_reckoned_m);
        append(bytes, pair.linked);
    }
}

GraphSampleFile read_graph_samples(const std::filesystem::path& file) {
    detail::SampleBytes bytes;
    detail::read_sample_bytes(file, graph_first_line, bytes);
    const std::uint32_t width = bytes.origin.features.width;
    GraphSampleFile result;
    detail::read_all(
        file, bytes, [&](ByteReader& reader) { return read_sample(reader, width); },
        [&](const GraphSample& sample) { return fault(sample, width); }, result);
    return result;
}

std::vector<std::filesystem::path> find_graph_samples(const std::filesystem::path& folder) {
    return detail::find_files(
        folder, graph_sample_extension, "graph samples",
        "Record them with `clearway links dataset SCENARIO --samples --out DIR`, for `train "
        "graphsage` with `--net graphsage`");
}

}  // namespace clearway::samples
