#pragma once

#include <filesystem>
#include <string>

#include "prediction/weights.hpp"
#include "training/torch_net.hpp"

namespace clearway::training {

/// Bytes of a file that Python's `torch.load` turns into a state dict, as
/// `torch.save(dict(model.state_dict()), file)` would write it: an uncompressed zip archive with a pickle of
/// protocol 2 (a dict of tensors) and one member per tensor. Only names that `torch.load` allows with
/// `weights_only=True` occur in it. Equal states give equal bytes: the times in the archive are constant.
///
/// libtorch's own ways are no substitute: `torch::save` writes a TorchScript archive, from which `torch.load`
/// makes a module, and `torch::pickle_save` marks its dict with a function that newer versions of
/// `torch.load` refuse. A dict and not an OrderedDict, because libtorch reads an OrderedDict as None.
std::string format_pth(const StateDict& state, const std::string& stem);

/// Whole or not at all. Throws core::EnvironmentError.
void write_pth(const std::filesystem::path& file, const StateDict& state);

/// The same parameters as a model file for `prediction::GraphSageNet`, or for `prediction::ConvolutionNet`.
prediction::Weights weights_from(const StateDict& state, const prediction::FeatureSchema& features,
                                 const prediction::GraphSageDimensions& dimensions,
                                 Convolution convolution = Convolution::sage);

}  // namespace clearway::training
