#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clearway::prediction {

/// Which function made the inputs of a net (prediction/features.hpp): a name, a version that grows when the
/// numbers change, and the number of inputs per vehicle.
struct FeatureSchema {
    std::string name;
    std::uint32_t version = 0;
    std::uint32_t width = 0;
    bool operator==(const FeatureSchema&) const = default;
};

/// A named array of parameters, row-major. Shape of a matrix: {outputs, inputs}, of a vector: {outputs}, as
/// PyTorch stores them.
struct Tensor {
    std::string name;
    std::vector<std::uint32_t> shape;
    std::vector<float> values;
};

/// A size of a net, for example `hidden 10`.
struct Dimension {
    std::string name;
    std::uint32_t value = 0;
    bool operator==(const Dimension&) const = default;
};

/// Names of the numbers that a net is given, in order: of a `node`, an `edge`, a `pair`.
struct InputNames {
    std::string name;
    std::vector<std::string> inputs;
    bool operator==(const InputNames&) const = default;
};

/// Link radii for which a model was trained, m.
struct RadiusRange {
    double least_m = 50.0;
    double most_m = 50.0;
    bool contains(double radius_m) const { return radius_m >= least_m && radius_m <= most_m; }
    bool operator==(const RadiusRange&) const = default;
};
/// `50 m`, or `25 to 300 m`.
std::string text(const RadiusRange& range);

/// A trained net as a file: what it is, for which inputs, and its tensors under PyTorch Geometric's names
/// (`graphsage.conv1.lin_l.weight` ... `nn.fc2.bias`). The text format `clearway-weights 1`, one item per
/// line:
///
///     clearway-weights 1
///     architecture graphsage_net
///     features corrected 1 5
///     dimension input 5
///     inputs node cos_x sin_x cos_y sin_y freshness     (may be absent)
///     link_radius 25 300                                (m; without it 50 50)
///     note trained on merge, intersection and city, seeds 1 to 8
///     tensor graphsage.conv1.lin_l.weight 10 5
///     0.1 -0.25 ...            (one line for each row of a matrix, one line for a vector)
///     end
///
/// Numbers are the shortest decimal text that reads back as the same float, so a file is exact and
/// reproducible.
struct Weights {
    std::string architecture;
    FeatureSchema features;
    std::vector<Dimension> dimensions;
    std::vector<InputNames> inputs;  ///< May be absent.
    RadiusRange link_radius;
    std::vector<std::string> notes;  ///< Where the net comes from; one line each, without line breaks.
    std::vector<Tensor> tensors;

    /// Value of a dimension. Throws core::InputError naming it when the file has none.
    std::uint32_t dimension(std::string_view name) const;
    /// The tensor `name`. Throws core::InputError naming it and both shapes when it is missing or shaped
    /// otherwise.
    const Tensor& tensor(std::string_view name, const std::vector<std::uint32_t>& shape) const;
    /// Throws core::InputError naming both when the net is of another architecture or was trained on other
    /// features.
    void require(std::string_view wanted_architecture, const FeatureSchema& wanted_features) const;

    /// Throws core::InputError, naming the first input that differs, when the file names other inputs, or the
    /// same in another order. Passes files without names.
    void require_inputs(std::span<const InputNames> wanted) const;

    /// Throws core::InputError when the model was not trained for links of this radius.
    void require_link_radius(double radius_m) const;

    /// Throws core::InputError when there are more or fewer tensors: one that no layer reads means another
    /// net.
    void require_tensors(std::size_t wanted) const;

    std::string source = "weights";  ///< The file, for messages. Not written.
};

inline constexpr std::uint32_t weights_format_version = 1;

/// The text of a weights file. Asserts that names and notes have no line breaks and that values fill their
/// shapes.
std::string format_weights(const Weights& weights);
/// The reverse; `source` names the text in messages. Throws core::InputError with the line for anything that
/// is not exactly the format: another version (naming both), a value that is not a finite number, missing or
/// surplus values, a name twice, no `end`.
Weights parse_weights(std::string_view text, const std::string& source);

/// Atomic. Throws core::EnvironmentError when the file cannot be written.
void write_weights(const std::filesystem::path& file, const Weights& weights);
/// Throws core::InputError when the file is missing or not of the format.
Weights read_weights(const std::filesystem::path& file);

}  // namespace clearway::prediction
