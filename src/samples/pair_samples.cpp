#include "samples/pair_samples.hpp"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/number.hpp"
#include "samples/detail/sample_file.hpp"

namespace clearway::samples {
namespace {

constexpr std::string_view first_words = "# clearway pair samples 2 ";
constexpr std::size_t most_pair_problems = 20;
constexpr const char* cure_record_pairs =
    "Record the pairs again with `clearway links dataset SCENARIO --samples --net logistic`";

std::string header_line() {
    return fmt::format("{},linked", fmt::join(prediction::pair_feature_names, ","));
}

SampleOrigin parse_origin(std::string_view line, const std::string& file) {
    if (!line.starts_with(first_words)) {
        throw core::InputError({file + ":1", "not a file of pair samples of this version",
                                fmt::format("a first line that begins `{}`", first_words),
                                cure_record_pairs});
    }
    SampleOrigin origin = detail::read_origin(line.substr(first_words.size()), file + ":1");
    const prediction::FeatureSchema schema = prediction::pair_feature_schema();
    if (origin.features != schema) {
        throw core::InputError(
            {file + ":1",
             fmt::format("features {} version {}", origin.features.name, origin.features.version),
             fmt::format("{} version {}", schema.name, schema.version), cure_record_pairs});
    }
    return origin;
}

/// Reads one row. Returns what is wrong with it, or an empty string.
std::string read_row(std::string_view line, PairSampleFile& samples) {
    prediction::PairFeatures features{};
    for (std::size_t column = 0; column <= prediction::pair_feature_count; ++column) {
        const std::size_t end = line.find(',');
        const bool is_last = column == prediction::pair_feature_count;
        if ((end == std::string_view::npos) != is_last) {
            return fmt::format("{} than {} values", is_last ? "more" : "fewer",
                               prediction::pair_feature_count + 1);
        }
        const std::string_view cell = line.substr(0, end);
        const float value = core::number_from<float>(cell).value_or(std::nanf(""));
        if (!std::isfinite(value))
            return fmt::format("value {}: `{}` is not a finite number", column + 1, cell.substr(0, 40));
        if (is_last) {
            if (value != 0.0F && value != 1.0F) return fmt::format("the label {} is neither 0 nor 1", value);
            samples.features.push_back(features);
            samples.linked.push_back(value == 1.0F ? 1 : 0);
            return {};
        }
        features[column] = value;
        line.remove_prefix(end + 1);
    }
    return {};
}

}  // namespace

void write_pair_samples(const std::filesystem::path& file, const PairSampleFile& samples) {
    SampleOrigin origin = samples.origin;
    origin.features = prediction::pair_feature_schema();
    std::string text = std::string(first_words) + detail::origin_line(origin) + header_line() + "\n";
    for (std::size_t pair = 0; pair < samples.features.size(); ++pair) {
        fmt::format_to(std::back_inserter(text), "{:.5g},{}\n", fmt::join(samples.features[pair], ","),
                       samples.linked[pair]);
    }
    core::write_atomically(file, text);
}

PairSampleFile read_pair_samples(const std::filesystem::path& file) {
    const std::string content = core::read_file(file);
    std::string_view text = content;
    PairSampleFile samples;
    samples.origin = parse_origin(core::take_line(text), file.string());
    if (const std::string_view header = core::take_line(text); header != header_line()) {
        throw core::InputError({file.string() + ":2", fmt::format("the columns `{}`", header.substr(0, 200)),
                                header_line(), cure_record_pairs});
    }
    std::vector<core::Problem> problems;
    for (std::size_t number = 3; !text.empty() && problems.size() < most_pair_problems; ++number) {
        const std::string wrong = read_row(core::take_line(text), samples);
        if (!wrong.empty())
            problems.push_back({fmt::format("{}:{}", file.string(), number), wrong, "", cure_record_pairs});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return samples;
}

std::vector<std::filesystem::path> find_pair_samples(const std::filesystem::path& folder) {
    return detail::find_files(
        folder, pair_sample_ending, "pair samples",
        "Record them with `clearway links dataset SCENARIO --samples --net logistic --out DIR`");
}

}  // namespace clearway::samples
