#include "prediction/model_file.hpp"

#include <algorithm>
#include <filesystem>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "prediction/convolution_net.hpp"
#include "prediction/features.hpp"
#include "prediction/graphsage.hpp"
#include "prediction/state_dict.hpp"

namespace clearway::prediction {
namespace {

constexpr ParameterName graphsage_names[] = {{"conv1.lin_l.weight", "graphsage.conv1.lin_l.weight"},
                                             {"conv1.lin_l.bias", "graphsage.conv1.lin_l.bias"},
                                             {"conv1.lin_r.weight", "graphsage.conv1.lin_r.weight"},
                                             {"conv2.lin_l.weight", "graphsage.conv2.lin_l.weight"},
                                             {"conv2.lin_l.bias", "graphsage.conv2.lin_l.bias"},
                                             {"conv2.lin_r.weight", "graphsage.conv2.lin_r.weight"},
                                             {"fc1.weight", "nn.fc1.weight"},
                                             {"fc1.bias", "nn.fc1.bias"},
                                             {"fc2.weight", "nn.fc2.weight"},
                                             {"fc2.bias", "nn.fc2.bias"}};
constexpr ParameterName gcn_names[] = {{"conv1.lin.weight", "gcn.conv1.lin.weight"},
                                       {"conv1.bias", "gcn.conv1.bias"},
                                       {"conv2.lin.weight", "gcn.conv2.lin.weight"},
                                       {"conv2.bias", "gcn.conv2.bias"},
                                       {"fc1.weight", "nn.fc1.weight"},
                                       {"fc1.bias", "nn.fc1.bias"},
                                       {"fc2.weight", "nn.fc2.weight"},
                                       {"fc2.bias", "nn.fc2.bias"}};
constexpr ParameterName gat_names[] = {{"conv1.lin.weight", "gat.conv1.lin.weight"},
                                       {"conv1.att_src", "gat.conv1.att_src"},
                                       {"conv1.att_dst", "gat.conv1.att_dst"},
                                       {"conv1.bias", "gat.conv1.bias"},
                                       {"conv2.lin.weight", "gat.conv2.lin.weight"},
                                       {"conv2.att_src", "gat.conv2.att_src"},
                                       {"conv2.att_dst", "gat.conv2.att_dst"},
                                       {"conv2.bias", "gat.conv2.bias"},
                                       {"fc1.weight", "nn.fc1.weight"},
                                       {"fc1.bias", "nn.fc1.bias"},
                                       {"fc2.weight", "nn.fc2.weight"},
                                       {"fc2.bias", "nn.fc2.bias"}};

/// What a state dict is taken for. The first name is that of the matrix {hidden, inputs}.
struct StateDictKind {
    std::string_view predictor;
    std::string_view net;
    const char* architecture = nullptr;
    std::span<const ParameterName> names;
    std::string_view second;  ///< Name of the matrix {output, hidden}.
    std::vector<FeatureSchema> features;
};

const std::vector<StateDictKind>& state_dict_kinds() {
    static const std::vector<StateDictKind> kinds = {
        {"graphsage_as_published",
         "the dissertation's GraphSAGENet",
         GraphSageNet::architecture,
         graphsage_names,
         "graphsage.conv2.lin_l.weight",
         {as_published_position_schema(), as_published_attributes_schema()}},
        {"graphsage_corrected",
         "the dissertation's GraphSAGENet",
         GraphSageNet::architecture,
         graphsage_names,
         "graphsage.conv2.lin_l.weight",
         {corrected_schema()}},
        {"gcn",
         "GraphSAGENet with GCNConv",
         ConvolutionNet::architecture(GraphConvolution::gcn),
         gcn_names,
         "gcn.conv2.lin.weight",
         {corrected_schema()}},
        {"gat",
         "GraphSAGENet with GATConv of one head",
         ConvolutionNet::architecture(GraphConvolution::gat),
         gat_names,
         "gat.conv2.lin.weight",
         {corrected_schema()}}};
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
        throw core::InputError({source,
                                fmt::format("is a file of torch.save, which {} does not take", predictor),
                                fmt::format("a .weights file of clearway train; files of torch.save for {}",
                                            fmt::join(pth_predictors(), ", ")),
                                "Choose the predictor that the net is for"});
    Weights weights;
    weights.source = source;
    weights.tensors =
        renamed_parameters(parse_pth(bytes, source), kind->names, std::string(kind->net), source);
    const std::vector<std::uint32_t>& first = matrix(weights.tensors, kind->names.front().name, source).shape;
    const std::vector<std::uint32_t>& second = matrix(weights.tensors, kind->second, source).shape;
    weights.architecture = kind->architecture;
    weights.features = features_of(*kind, first[1], source);
    weights.dimensions = {{"input", first[1]}, {"hidden", first[0]}, {"output", second[0]}};
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
