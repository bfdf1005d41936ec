#include "samples/repair_sample.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "core/error.hpp"
#include "samples/detail/sample_file.hpp"

namespace clearway::samples {
namespace {

using detail::append;
using detail::append_all;
using detail::ByteReader;
using detail::cure_remake;
using prediction::common_width;

constexpr std::string_view repair_first_line = "clearway repair samples 2\n";
constexpr std::size_t receiver_width = prediction::node_width - prediction::common_width;

static_assert(sizeof(prediction::RowPair) == 8);
static_assert(sizeof(prediction::Path) == 8 * prediction::path_points);

bool all_finite(const std::vector<float>& numbers) {
    return std::ranges::all_of(numbers, [](float number) { return std::isfinite(number); });
}

bool all_below(const std::vector<std::uint32_t>& numbers, std::uint32_t end) {
    return std::ranges::all_of(numbers, [end](std::uint32_t number) { return number < end; });
}

/// What is wrong with a sample, or empty.
std::string repair_fault(const RepairSample& sample) {
    const prediction::RepairInputs& inputs = sample.inputs;
    const std::size_t rows = inputs.rows;
    if (inputs.nodes.size() != rows * prediction::node_width || inputs.x_m.size() != rows ||
        inputs.y_m.size() != rows || inputs.place_sigma_m.size() != rows) {
        return fmt::format("features that do not fit {} vehicles", rows);
    }
    if (inputs.first_edge.size() != inputs.receivers.size() + 1 || inputs.first_edge.front() != 0 ||
        inputs.first_edge.back() != inputs.source.size() || !std::ranges::is_sorted(inputs.first_edge) ||
        inputs.edges.size() != inputs.source.size() * prediction::edge_width) {
        return "edges that do not fit their receivers";
    }
    if (inputs.pair_features.size() != inputs.pairs.size() * prediction::pair_width ||
        sample.linked.size() != inputs.pairs.size() || sample.rule.size() != inputs.pairs.size()) {
        return "pairs that do not fit their features or labels";
    }
    if (sample.true_displacement_m.size() != inputs.receivers.size()) {
        return "true displacements that do not fit the receivers";
    }
    if (!all_below(inputs.source, inputs.rows)) return "an edge from a vehicle that does not exist";
    const bool pairs_fit = std::ranges::all_of(
        inputs.pairs, [&](prediction::RowPair pair) { return pair.left < pair.right && pair.right < rows; });
    if (!pairs_fit) return "a pair of vehicles that do not exist";
    const bool receivers_fit =
        std::ranges::all_of(inputs.receivers, [&](const prediction::Receiver& receiver) {
            return receiver.row < rows && receiver.reach_m > 0.0F && std::isfinite(receiver.reach_m) &&
                   std::isfinite(receiver.displacement_m);
        });
    if (!receivers_fit) return "a receiver that does not exist or has no reach";
    if (std::ranges::any_of(sample.linked, [](std::uint8_t label) { return label > 1; })) {
        return "a label other than 0 and 1";
    }
    if (!std::isfinite(inputs.radius_m) || inputs.radius_m <= 0.0F)
        return "a link radius that is not positive";
    if (!all_finite(inputs.nodes) || !all_finite(inputs.edges) || !all_finite(inputs.pair_features) ||
        !all_finite(sample.rule) || !all_finite(sample.true_displacement_m)) {
        return "a number that is not finite";
    }
    return {};
}

RepairSample read_repair_sample(ByteReader& reader) {
    RepairSample sample;
    prediction::RepairInputs& inputs = sample.inputs;
    sample.time_s = reader.next<double>();
    inputs.radius_m = reader.next<float>();
    inputs.rows = reader.next_count(sizeof(float));
    const auto receivers = reader.next_count(sizeof(std::uint32_t));
    const auto edges = reader.next_count(sizeof(std::uint32_t));
    const auto pairs = reader.next_count(sizeof(prediction::RowPair));
    std::vector<float> common, own;
    reader.next_all(inputs.rows * common_width, common);
    reader.next_all(inputs.rows, inputs.x_m);
    reader.next_all(inputs.rows, inputs.y_m);
    reader.next_all(inputs.rows, inputs.place_sigma_m);
    inputs.nodes.assign(std::size_t{inputs.rows} * prediction::node_width, 0.0F);
    for (std::size_t row = 0; row < inputs.rows; ++row) {
        std::copy_n(&common[row * common_width], common_width, &inputs.nodes[row * prediction::node_width]);
    }
    inputs.receivers.resize(receivers);
    for (prediction::Receiver& receiver : inputs.receivers) {
        receiver.row = reader.next<std::uint32_t>();
        receiver.displacement_m = reader.next<float>();
        receiver.reach_m = reader.next<float>();
        sample.true_displacement_m.push_back(reader.next<float>());
        receiver.path = reader.next<prediction::Path>();
        reader.next_all(receiver_width, own);
        if (receiver.row < inputs.rows) {
            std::ranges::copy(own, &inputs.nodes[receiver.row * prediction::node_width + common_width]);
        }
    }
    reader.next_all(receivers + std::size_t{1}, inputs.first_edge);
    reader.next_all(edges, inputs.source);
    reader.next_all(edges * std::size_t{prediction::edge_width}, inputs.edges);
    reader.next_all(pairs, inputs.pairs);
    reader.next_all(pairs * std::size_t{prediction::pair_width}, inputs.pair_features);
    reader.next_all(pairs, sample.linked);
    reader.next_all(pairs, sample.rule);
    return sample;
}

}  // namespace

RepairSampleWriter::RepairSampleWriter(const SampleOrigin& origin)
    : SampleFileWriter(repair_first_line, origin) {}

void RepairSampleWriter::add(const RepairSample& sample) {
    std::string& bytes = bytes_of_sample(repair_fault(sample));
    const prediction::RepairInputs& inputs = sample.inputs;
    append(bytes, sample.time_s);
    append(bytes, inputs.radius_m);
    append(bytes, inputs.rows);
    append(bytes, static_cast<std::uint32_t>(inputs.receivers.size()));
    append(bytes, static_cast<std::uint32_t>(inputs.source.size()));
    append(bytes, static_cast<std::uint32_t>(inputs.pairs.size()));
    const std::span<const float> nodes = inputs.nodes;
    for (std::size_t row = 0; row < inputs.rows; ++row) {
        append_all(bytes, nodes.subspan(row * prediction::node_width, common_width));
    }
    append_all<float>(bytes, inputs.x_m);
    append_all<float>(bytes, inputs.y_m);
    append_all<float>(bytes, inputs.place_sigma_m);
    for (std::size_t at = 0; at < inputs.receivers.size(); ++at) {
        const prediction::Receiver& receiver = inputs.receivers[at];
        append(bytes, receiver.row);
        append(bytes, receiver.displacement_m);
        append(bytes, receiver.reach_m);
        append(bytes, sample.true_displacement_m[at]);
        append(bytes, receiver.path);
        append_all(bytes,
                   nodes.subspan(receiver.row * prediction::node_width + common_width, receiver_width));
    }
    append_all<std::uint32_t>(bytes, inputs.first_edge);
    append_all<std::uint32_t>(bytes, inputs.source);
    append_all<float>(bytes, inputs.edges);
    append_all<prediction::RowPair>(bytes, inputs.pairs);
    append_all<float>(bytes, inputs.pair_features);
    append_all<std::uint8_t>(bytes, sample.linked);
    append_all<float>(bytes, sample.rule);
}

RepairSampleFile read_repair_samples(const std::filesystem::path& file) {
    detail::SampleBytes bytes;
    detail::read_sample_bytes(file, repair_first_line, bytes);
    const prediction::FeatureSchema wanted = prediction::repair_schema();
    const prediction::FeatureSchema& found = bytes.origin.features;
    if (found != wanted) {
        throw core::InputError(
            {file.string(),
             fmt::format("features {} {} ({} numbers)", found.name, found.version, found.width),
             fmt::format("{} {} ({} numbers)", wanted.name, wanted.version, wanted.width), cure_remake});
    }
    RepairSampleFile result;
    detail::read_all(file, bytes, read_repair_sample, repair_fault, result);
    return result;
}

}  // namespace clearway::samples
