#include "samples/graph_sample.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "samples/detail/sample_file.hpp"

namespace clearway::samples {
namespace {

using detail::append;
using detail::ByteReader;
using detail::cure_remake;

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
    : origin_(origin), bytes_(detail::file_start(graph_first_line, origin)) {}

void GraphSampleWriter::add(const GraphSample& sample) {
    if (const std::string wrong = fault(sample, origin_.features.width); !wrong.empty()) {
        throw std::logic_error("graph sample: " + wrong);
    }
    append(bytes_, sample.time_s);
    append(bytes_, sample.vehicle_count);
    append(bytes_, static_cast<std::uint32_t>(sample.observed_edges.size()));
    append(bytes_, static_cast<std::uint32_t>(sample.candidates.size()));
    for (float value : sample.features)
        append(bytes_, value);
    for (const ObservedEdge& edge : sample.observed_edges) {
        append(bytes_, edge.left);
        append(bytes_, edge.right);
    }
    for (const CandidatePair& pair : sample.candidates) {
        append(bytes_, pair.left);
        append(bytes_, pair.right);
        append(bytes_, pair.dead_reckoned_m);
        append(bytes_, pair.linked);
    }
    ++sample_count_;
}

void GraphSampleWriter::write(const std::filesystem::path& file) const {
    core::write_atomically(file, bytes_ + detail::file_end(bytes_, sample_count_));
}

GraphSampleFile read_graph_samples(const std::filesystem::path& file) {
    detail::SampleBytes bytes;
    detail::read_sample_bytes(file, graph_first_line, bytes);
    GraphSampleFile result;
    result.origin = bytes.origin;
    result.content_hash = bytes.content_hash;
    ByteReader reader(bytes.samples, file.string());
    while (!reader.empty()) {
        result.samples.push_back(read_sample(reader, result.origin.features.width));
        const std::string wrong = fault(result.samples.back(), result.origin.features.width);
        if (!wrong.empty()) {
            throw core::InputError({fmt::format("{}: sample {}", file.string(), result.samples.size() - 1),
                                    wrong, "", cure_remake});
        }
    }
    detail::check_sample_count(file, result.samples.size(), bytes.sample_count);
    return result;
}

std::vector<std::filesystem::path> find_graph_samples(const std::filesystem::path& folder) {
    return detail::find_files(folder, graph_sample_extension, "graph samples",
                              "Record them with `clearway dataset SCENARIO --samples --out DIR`, for `train "
                              "graphsage` with `--net graphsage`");
}

}  // namespace clearway::samples
