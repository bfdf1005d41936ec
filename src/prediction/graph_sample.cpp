#include "prediction/graph_sample.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"

namespace clearway::prediction {
namespace {

static_assert(std::endian::native == std::endian::little, "sample files are little-endian");

constexpr std::string_view first_line = "clearway graph samples 1\n";
constexpr std::uint32_t most_features = 256;
constexpr const char* cure_remake = "Record the samples again with `clearway dataset SCENARIO --samples`";

template <class Number>
void append(std::string& bytes, Number number) {
    char raw[sizeof(Number)];
    std::memcpy(raw, &number, sizeof(Number));
    bytes.append(raw, sizeof(Number));
}

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

std::string header(const GraphSampleOrigin& origin) {
    const nlohmann::ordered_json json = {{"scenario", origin.scenario},
                                         {"failure", origin.failure},
                                         {"feature_name", origin.features.name},
                                         {"feature_version", origin.features.version},
                                         {"feature_count", origin.features.width},
                                         {"study_seed", origin.study_seed},
                                         {"replication", origin.replication},
                                         {"link_radius_m", origin.link_radius_m}};
    return json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
}

/// Reads numbers from the front of a buffer; throws core::InputError at its end.
class ByteReader {
  public:
    ByteReader(std::string_view bytes, std::string where) : bytes_(bytes), where_(std::move(where)) {}

    bool empty() const { return bytes_.empty(); }

    template <class Number>
    Number next() {
        Number number;
        std::memcpy(&number, take(sizeof(Number)).data(), sizeof(Number));
        return number;
    }

    /// Checked before anything is allocated for it, so that a damaged count cannot exhaust the memory.
    std::uint32_t next_count(std::size_t bytes_each) {
        const auto count = next<std::uint32_t>();
        if (std::size_t{count} * bytes_each > bytes_.size()) end_reached();
        return count;
    }

  private:
    std::string_view take(std::size_t size) {
        if (size > bytes_.size()) end_reached();
        const std::string_view taken = bytes_.substr(0, size);
        bytes_.remove_prefix(size);
        return taken;
    }

    [[noreturn]] void end_reached() const {
        throw core::InputError({where_, "a sample ends before its data", "", cure_remake});
    }

    std::string_view bytes_;
    std::string where_;
};

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

GraphSampleOrigin read_origin(std::string_view line, const std::string& where) {
    try {
        const nlohmann::json json = nlohmann::json::parse(line);
        GraphSampleOrigin origin;
        json.at("scenario").get_to(origin.scenario);
        json.at("failure").get_to(origin.failure);
        json.at("feature_name").get_to(origin.features.name);
        json.at("feature_version").get_to(origin.features.version);
        json.at("feature_count").get_to(origin.features.width);
        json.at("study_seed").get_to(origin.study_seed);
        json.at("replication").get_to(origin.replication);
        json.at("link_radius_m").get_to(origin.link_radius_m);
        if (origin.features.width == 0 || origin.features.width > most_features) {
            throw core::InputError({where + ":2: feature_count",
                                    fmt::format("{} features", origin.features.width),
                                    fmt::format("1 to {}", most_features), cure_remake});
        }
        return origin;
    } catch (const nlohmann::json::exception& error) {
        throw core::InputError({where + ":2", error.what(), "", cure_remake});
    }
}

/// Splits off the last line and checks its hash against the bytes before it. Returns the number of samples.
std::size_t check_end(std::string_view& bytes, const std::string& where, std::string& hash) {
    const std::size_t start = bytes.empty() ? std::string_view::npos : bytes.rfind('\n', bytes.size() - 2);
    const std::string last(start == std::string_view::npos ? std::string_view{} : bytes.substr(start + 1));
    char digits[33] = {};
    unsigned long count = 0;
    if (!last.ends_with('\n') || std::sscanf(last.c_str(), "end %lu %32[0-9a-f]\n", &count, digits) != 2) {
        throw core::InputError({where, "its last line is missing: it was cut short", "", cure_remake});
    }
    bytes = bytes.substr(0, start);
    hash = core::content_hash(bytes);
    if (hash != digits) {
        throw core::InputError({where,
                                fmt::format("its content hashes to {}, its last line says {}", hash, digits),
                                "", "It was changed or damaged. " + std::string(cure_remake)});
    }
    return count;
}

}  // namespace

GraphSampleWriter::GraphSampleWriter(const GraphSampleOrigin& origin) : origin_(origin) {
    if (origin.features.width == 0 || origin.features.width > most_features) {
        throw std::logic_error(fmt::format("graph samples of {} features", origin.features.width));
    }
    bytes_ = std::string(first_line) + header(origin);
}

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
    core::write_atomically(file,
                           bytes_ + fmt::format("\nend {} {}\n", sample_count_, core::content_hash(bytes_)));
}

GraphSampleFile read_graph_samples(const std::filesystem::path& file) {
    const std::string content = core::read_file(file);
    const std::string where = file.string();
    std::string_view bytes = content;
    if (!bytes.starts_with(first_line)) {
        throw core::InputError({where + ":1", "not a file of graph samples of this version",
                                fmt::format("first line `{}`", first_line.substr(0, first_line.size() - 1)),
                                cure_remake});
    }
    GraphSampleFile result;
    const std::size_t count = check_end(bytes, where, result.content_hash);
    bytes.remove_prefix(first_line.size());
    const std::size_t line_end = std::min(bytes.find('\n'), bytes.size());
    result.origin = read_origin(bytes.substr(0, line_end), where);
    bytes.remove_prefix(std::min(line_end + 1, bytes.size()));

    ByteReader reader(bytes, where);
    while (!reader.empty()) {
        result.samples.push_back(read_sample(reader, result.origin.features.width));
        const std::string wrong = fault(result.samples.back(), result.origin.features.width);
        if (!wrong.empty()) {
            throw core::InputError(
                {fmt::format("{}: sample {}", where, result.samples.size() - 1), wrong, "", cure_remake});
        }
    }
    if (result.samples.size() != count) {
        throw core::InputError(
            {where, fmt::format("{} samples, its last line says {}", result.samples.size(), count), "",
             cure_remake});
    }
    return result;
}

std::vector<std::filesystem::path> find_graph_samples(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (entry.path().extension() == graph_sample_extension) files.push_back(entry.path());
    }
    if (error || files.empty()) {
        throw core::InputError({folder.string(), error ? error.message() : "holds no file of graph samples",
                                fmt::format("a folder with *{} files", graph_sample_extension),
                                "Record them with `clearway dataset SCENARIO --samples --out DIR`"});
    }
    std::ranges::sort(files);
    return files;
}

}  // namespace clearway::prediction
