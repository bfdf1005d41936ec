#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prediction/weights.hpp"

namespace clearway::prediction {

// Nets that were trained with PyTorch in Python, without PyTorch: a file of
// `torch.save(model.state_dict(), file)` becomes a model file.

/// Whether `bytes` start as files of `torch.save` do, of this format or the one before torch 1.6.
bool is_pth(std::string_view bytes);

/// The parameters of such a file, in its order: single, half, bfloat16 and double precision as single (double
/// is rounded). A pickle is data here; nothing that it names is ever run. Throws core::InputError, `source`
/// naming the file, for what is no state dict, is cut off or damaged, names a foreign class, has values that
/// are not finite or whole numbers, or places them out of their storage.
std::vector<Tensor> parse_pth(std::string_view bytes, const std::string& source);

/// A parameter of a net by the end of its name, and what it is called in a model file.
struct ParameterName {
    std::string_view ending;  ///< `conv1.lin_l.weight`.
    std::string_view name;    ///< `graphsage.conv1.lin_l.weight`.
};

/// The tensors under the names of model files. What stands before an ending is up to the author of the class
/// (`graphsage.`, `encoder.`, `module.`), a dot between. Throws core::InputError naming what is missing and
/// what is no parameter of the net; `net` names it (`GraphSAGENet`).
std::vector<Tensor> renamed_parameters(std::vector<Tensor> tensors, std::span<const ParameterName> names,
                                       const std::string& net, const std::string& source);

}  // namespace clearway::prediction
