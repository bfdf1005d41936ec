#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prediction/weights.hpp"

namespace clearway::prediction {

// Parameters of nets as PyTorch keeps them in files, without PyTorch.

/// Whether `bytes` start as files of `torch.save` do, of this format or the one before torch 1.6.
bool is_pth(std::string_view bytes);

/// The parameters of such a file, in its order: single, half, bfloat16 and double precision as single (double
/// is rounded). A pickle is data here; nothing that it names is ever run. Throws core::InputError, `source`
/// naming the file, for what is no state dict, is cut off or damaged, names a foreign class, has values that
/// are not finite or whole numbers, or places them out of their storage.
std::vector<Tensor> parse_pth(std::string_view bytes, const std::string& source);

/// Bytes of a file that Python's `torch.load` turns into a state dict, as
/// `torch.save(dict(model.state_dict()), file)` would write it: an uncompressed zip archive with a pickle of
/// protocol 2 (a dict of tensors) and one member per tensor. Only names that `torch.load` allows with
/// `weights_only=True` occur in it. Equal tensors give equal bytes: the times in the archive are constant.
///
/// libtorch's own ways are no substitute: `torch::save` writes a TorchScript archive, from which `torch.load`
/// makes a module, and `torch::pickle_save` marks its dict with a function that newer versions of
/// `torch.load` refuse. A dict and not an OrderedDict, because libtorch reads an OrderedDict as None.
std::string format_pth(const std::vector<Tensor>& tensors, const std::string& stem);
/// Whole or not at all. Throws core::EnvironmentError.
void write_pth(const std::filesystem::path& file, const std::vector<Tensor>& tensors);

/// The tensors under `names`, those of model files (`graphsage.conv1.lin_l.weight`), in the file's order.
/// What stands in a file before `conv1.lin_l.weight` is up to the author of the class (`graphsage.`,
/// `encoder.`, `module.`), a dot between. Throws core::InputError naming what is missing and what is no
/// parameter of the net; `net` names it (`GraphSAGENet`).
std::vector<Tensor> renamed_parameters(std::vector<Tensor> tensors, std::span<const std::string> names,
                                       const std::string& net, const std::string& source);

}  // namespace clearway::prediction
