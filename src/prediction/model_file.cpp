#include "prediction/model_file.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "prediction/comparison/dissertation_net.hpp"
#include "prediction/comparison/features.hpp"
#include "prediction/state_dict.hpp"

namespace clearway::prediction {
namespace {

/// What a state dict is taken for.
struct StateDictKind {
    std::string_view predictor;
    std::string_view net;
    Convolution convolution = Convolution::sage;
    std::vector<FeatureSchema> features;
};

const std::vector<StateDictKind>& state_dict_kinds() {
    constexpr const char* published = "the dissertation's GraphSAGENet";
    static const std::vector<StateDictKind> kinds = {
        {"graphsage_as_published",
         published,
         Convolution::sage,
         {as_published_position_schema(), as_published_attributes_schema()}},
        {"graphsage_corrected", published, Convolution::sage, {corrected_schema()}},
        {"gcn", "GraphSAGENet with GCNConv", Convolution::gcn, {corrected_schema()}},
        {"gat", "GraphSAGENet with GATConv of one head", Convolution::gat, {corrected_schema()}}};
    return kinds;
}

const Tensor& matrix(const std::vector<Tensor>& tensors, std::string_view name, const std::string& source) {
    const Tensor& found = *std::ranges::find(tensors, name, &Tensor::name);
    if (found.shape.size() == 2) return found;
    throw core::InputError({source, fmt::format("{} has {} axes", name, found.shape.size()),
                            "2: outputs x inputs", "Use the state dict of that class"});
}

const FeatureSchema& features_of(const StateDictKind& kind, std::uint32_t inputs, const std::string& source) {
    const auto found = std::ranges::find(kind.features, inputs, &FeatureSchema::width);
    if (found != kind.features.end()) return *found;
    std::vector<std::string> allowed;
    for (const FeatureSchema& schema : kind.features)
        allowed.push_back(fmt::format("{} ({})", schema.width, schema.name));
    throw core::InputError({source, fmt::format("the net takes {} features of a vehicle", inputs),
                            fmt::format("{}, what {} gives it", fmt::join(allowed, " or "), kind.predictor),
                            "Train it on the features that docs/guides/your-net.md lists"});
}

Weights weights_from_pth(const std::string& predictor, std::string_view bytes, const std::string& source) {
    const auto kind = std::ranges::find(state_dict_kinds(), predictor, &StateDictKind::predictor);
    if (kind == state_dict_kinds().end())
        throw core::InputError(
            {source, fmt::format("is a file of torch.save, which {} does not take", predictor),
             fmt::format("a .weights file of clearway links train; files of torch.save for {}",
                         fmt::join(pth_predictors(), ", ")),
             "Choose the predictor that the net is for"});
    const std::vector<std::string> names = parameter_names(kind->convolution);
    std::vector<Tensor> tensors =
        renamed_parameters(parse_pth(bytes, source), names, std::string(kind->net), source);
    // The matrices {hidden, inputs} and {output, hidden} of both convolutions, before the four of the
    // decoder.
    const std::vector<std::uint32_t> first = matrix(tensors, names.front(), source).shape;
    const std::vector<std::uint32_t> second = matrix(tensors, names[(names.size() - 4) / 2], source).shape;
    Weights weights = net_weights(kind->convolution, features_of(*kind, first[1], source),
                                  {first[1], first[0], second[0]}, std::move(tensors));
    weights.source = source;
    weights.notes = {"read from a file of torch.save"};
    return weights;
}

}  // namespace

Weights read_model(const std::string& predictor, const std::string& file) {
    const std::string bytes = core::read_file(file);
    const std::string ending = std::filesystem::path(file).extension().string();
    if (is_pth(bytes)) return weights_from_pth(predictor, bytes, file);
    const bool is_text = bytes.starts_with("clearway-weights") || (ending != ".pth" && ending != ".pt");
    return is_text ? parse_weights(bytes, file) : weights_from_pth(predictor, bytes, file);
}

std::vector<std::string> pth_predictors() {
    std::vector<std::string> names;
    for (const StateDictKind& kind : state_dict_kinds())
        names.emplace_back(kind.predictor);
    return names;
}

}  // namespace clearway::prediction
