#include "prediction/weights.hpp"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <optional>
#include <type_traits>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"

namespace clearway::prediction {
namespace {

constexpr std::string_view magic = "clearway-weights";
constexpr std::size_t value_limit = 20'000'000;

std::string shape_text(const std::vector<std::uint32_t>& shape) {
    return fmt::format("{}", fmt::join(shape, " x "));
}

std::size_t value_count(const std::vector<std::uint32_t>& shape) {
    std::size_t product = 1;
    for (const std::uint32_t size : shape) {
        product = std::min(product * size, value_limit + 1);
    }
    return product;
}

void append_values(const Tensor& tensor, std::string& text) {
    const std::size_t row = tensor.shape.empty() ? 1 : tensor.shape.back();
    char buffer[32];
    for (std::size_t at = 0; at < tensor.values.size(); ++at) {
        const auto end = std::to_chars(buffer, buffer + sizeof buffer, tensor.values[at]);
        text.append(buffer, end.ptr);
        text += (at + 1) % row == 0 ? '\n' : ' ';
    }
}

/// Walks over the lines of a weights text and says where a problem stands.
class Reader {
  public:
    Reader(std::string_view text, const std::string& source) : rest_(text), source_(source) {}

    /// The next line, without its break; nothing at the end.
    std::optional<std::string_view> line() {
        if (rest_.empty()) return std::nullopt;
        const std::size_t stop = rest_.find('\n');
        const std::string_view found = rest_.substr(0, stop);
        rest_.remove_prefix(stop == std::string_view::npos ? rest_.size() : stop + 1);
        ++number_;
        return found;
    }

    [[noreturn]] void fail(const std::string& what, const std::string& allowed = "") const {
        throw core::InputError({fmt::format("{}:{}", source_, number_), what, allowed,
                                "export the net again with `clearway links train`"});
    }

  private:
    std::string_view rest_;
    std::string source_;
    std::size_t number_ = 0;
};

/// Cuts the first word off `line`.
std::string_view next_word(std::string_view& line) {
    const std::size_t start = std::min(line.find_first_not_of(" \r"), line.size());
    line.remove_prefix(start);
    const std::string_view word = line.substr(0, line.find_first_of(" \r"));
    line.remove_prefix(word.size());
    return word;
}

template <class Number>
Number parse_number(std::string_view word, const Reader& reader) {
    Number value{};
    const auto end = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool fits = !word.empty() && end.ec == std::errc{} && end.ptr == word.data() + word.size();
    if constexpr (std::is_integral_v<Number>) {
        if (!fits) reader.fail(fmt::format("'{}' is not a number", word), "a whole number, 0 or more");
    } else {
        if (!fits || !std::isfinite(value))
            reader.fail(fmt::format("'{}' is not a finite number", word), "a decimal number");
    }
    return value;
}

Tensor parse_tensor(std::string_view rest, Reader& reader) {
    Tensor tensor;
    tensor.name = next_word(rest);
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
        tensor.shape.push_back(parse_number<std::uint32_t>(word, reader));
    }
    const std::size_t count = value_count(tensor.shape);
    if (tensor.name.empty() || tensor.shape.empty() || count == 0 || count > value_limit) {
        reader.fail("a tensor without a name or with an impossible shape", "tensor NAME SIZE [SIZE]");
    }
    tensor.values.reserve(count);
    const std::size_t row = tensor.shape.back();
    while (tensor.values.size() < count) {
        std::optional<std::string_view> line = reader.line();
        if (!line) reader.fail(fmt::format("the file ends inside tensor {}", tensor.name));
        const std::size_t before = tensor.values.size();
        for (std::string_view word = next_word(*line); !word.empty(); word = next_word(*line)) {
            tensor.values.push_back(parse_number<float>(word, reader));
        }
        if (tensor.values.size() - before != row) {
            reader.fail(
                fmt::format("{} values in a row of tensor {}", tensor.values.size() - before, tensor.name),
                fmt::format("{} values", row));
        }
    }
    return tensor;
}

void check_magic(Reader& reader) {
    std::optional<std::string_view> line = reader.line();
    const std::string allowed = fmt::format("{} {}", magic, weights_format_version);
    if (!line || next_word(*line) != magic) reader.fail("not a weights file", allowed);
    const std::string_view version = next_word(*line);
    if (version != std::to_string(weights_format_version)) {
        reader.fail(fmt::format("the file has format version {}, this program reads version {}", version,
                                weights_format_version),
                    allowed);
    }
}

template <class Items>
void refuse_twice(const Items& items, const Reader& reader) {
    for (std::size_t at = 0; at + 1 < items.size(); ++at) {
        if (items[at].name == items.back().name)
            reader.fail(fmt::format("{} is listed twice", items.back().name));
    }
}

RadiusRange parse_radii(std::string_view line, const Reader& reader) {
    RadiusRange range;
    range.least_m = parse_number<float>(next_word(line), reader);
    range.most_m = parse_number<float>(next_word(line), reader);
    if (range.least_m <= 0.0 || range.most_m < range.least_m)
        reader.fail(fmt::format("link radii from {} to {} m", range.least_m, range.most_m),
                    "link_radius LEAST MOST, above 0 and ascending");
    return range;
}

/// Parses one line after the first. False at `end`.
bool parse_item(std::string_view line, Reader& reader, Weights& weights) {
    const std::string_view word = next_word(line);
    if (word == "end") return false;
    if (word == "architecture") {
        weights.architecture = next_word(line);
    } else if (word == "features") {
        weights.features.name = next_word(line);
        weights.features.version = parse_number<std::uint32_t>(next_word(line), reader);
        weights.features.width = parse_number<std::uint32_t>(next_word(line), reader);
    } else if (word == "dimension") {
        const std::string name(next_word(line));
        weights.dimensions.push_back({name, parse_number<std::uint32_t>(next_word(line), reader)});
        refuse_twice(weights.dimensions, reader);
    } else if (word == "inputs") {
        weights.inputs.push_back({std::string(next_word(line)), {}});
        for (std::string_view name = next_word(line); !name.empty(); name = next_word(line))
            weights.inputs.back().inputs.emplace_back(name);
        refuse_twice(weights.inputs, reader);
    } else if (word == "link_radius") {
        weights.link_radius = parse_radii(line, reader);
    } else if (word == "note") {
        weights.notes.emplace_back(line.empty() ? line : line.substr(1));
    } else if (word == "tensor") {
        weights.tensors.push_back(parse_tensor(line, reader));
        refuse_twice(weights.tensors, reader);
    } else {
        reader.fail(fmt::format("'{}' is unknown here", word),
                    "architecture, features, dimension, inputs, link_radius, note, tensor, end");
    }
    return true;
}

std::string schema_text(const FeatureSchema& schema) {
    return fmt::format("{} version {} ({} inputs)", schema.name, schema.version, schema.width);
}

}  // namespace

std::string text(const RadiusRange& range) {
    return range.least_m == range.most_m ? fmt::format("{} m", range.least_m)
                                         : fmt::format("{} to {} m", range.least_m, range.most_m);
}

std::uint32_t Weights::dimension(std::string_view name) const {
    const auto found = std::ranges::find(dimensions, name, &Dimension::name);
    if (found == dimensions.end()) {
        throw core::InputError(
            {source, fmt::format("dimension {} is missing", name), "", "use another model file"});
    }
    return found->value;
}

const Tensor& Weights::tensor(std::string_view name, const std::vector<std::uint32_t>& shape) const {
    const auto found = std::ranges::find(tensors, name, &Tensor::name);
    if (found == tensors.end()) {
        throw core::InputError(
            {source, fmt::format("tensor {} is missing", name), "", "use another model file"});
    }
    if (found->shape != shape) {
        throw core::InputError({source, fmt::format("tensor {} is {}", name, shape_text(found->shape)),
                                shape_text(shape), "use another model file"});
    }
    return *found;
}

void Weights::require(std::string_view wanted_architecture, const FeatureSchema& wanted_features) const {
    std::vector<core::Problem> problems;
    if (architecture != wanted_architecture) {
        problems.push_back({source, fmt::format("the net is a {}", architecture),
                            std::string(wanted_architecture), "use a model file of this predictor"});
    }
    if (features != wanted_features) {
        problems.push_back({source,
                            fmt::format("the net was trained on features {}, this program computes {}",
                                        schema_text(features), schema_text(wanted_features)),
                            schema_text(wanted_features),
                            "train it again, or use a model file of this version"});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

void Weights::require_inputs(std::span<const InputNames> wanted) const {
    constexpr const char* cure = "train it again, or use a model file of this version";
    for (const auto& [kind, names] : wanted) {
        const auto found = std::ranges::find(inputs, kind, &InputNames::name);
        if (found == inputs.end() || found->inputs == names) continue;
        const auto [own, other] = std::ranges::mismatch(found->inputs, names);
        if (own == found->inputs.end() || other == names.end())
            throw core::InputError({source, fmt::format("{} inputs of a {}", found->inputs.size(), kind),
                                    fmt::format("{}", names.size()), cure});
        throw core::InputError(
            {source, fmt::format("input {} of a {} is {}", own - found->inputs.begin() + 1, kind, *own),
             *other, cure});
    }
}

void Weights::require_link_radius(double radius_m) const {
    if (link_radius.contains(radius_m)) return;
    throw core::InputError({source, fmt::format("links below {} m", radius_m),
                            fmt::format("{}, for which the model was trained", text(link_radius)),
                            "Choose another radius, a model trained for it, or predictor car_following or "
                            "route_rule, which need no training"});
}

void Weights::require_tensors(std::size_t wanted) const {
    if (tensors.size() == wanted) return;
    throw core::InputError({source, fmt::format("{} tensors", tensors.size()),
                            fmt::format("{} for its dimensions", wanted), "use another model file"});
}

std::string format_weights(const Weights& weights) {
    std::string text = fmt::format("{} {}\narchitecture {}\nfeatures {} {} {}\n", magic,
                                   weights_format_version, weights.architecture, weights.features.name,
                                   weights.features.version, weights.features.width);
    for (const Dimension& dimension : weights.dimensions) {
        text += fmt::format("dimension {} {}\n", dimension.name, dimension.value);
    }
    for (const InputNames& names : weights.inputs) {
        text += fmt::format("inputs {} {}\n", names.name, fmt::join(names.inputs, " "));
    }
    if (weights.link_radius != RadiusRange{})
        text += fmt::format("link_radius {} {}\n", weights.link_radius.least_m, weights.link_radius.most_m);
    for (const std::string& note : weights.notes) {
        assert(note.find('\n') == std::string::npos);
        text += fmt::format("note {}\n", note);
    }
    for (const Tensor& tensor : weights.tensors) {
        assert(tensor.values.size() == value_count(tensor.shape));
        text += fmt::format("tensor {} {}\n", tensor.name, fmt::join(tensor.shape, " "));
        append_values(tensor, text);
    }
    return text + "end\n";
}

Weights parse_weights(std::string_view text, const std::string& source) {
    Reader reader(text, source);
    check_magic(reader);
    Weights weights;
    weights.source = source;
    while (true) {
        const std::optional<std::string_view> line = reader.line();
        if (!line) reader.fail("the file is cut off: no end line");
        if (!parse_item(*line, reader, weights)) break;
    }
    return weights;
}

void write_weights(const std::filesystem::path& file, const Weights& weights) {
    core::write_atomically(file, format_weights(weights));
}

Weights read_weights(const std::filesystem::path& file) {
    return parse_weights(core::read_file(file), file.string());
}

}  // namespace clearway::prediction
