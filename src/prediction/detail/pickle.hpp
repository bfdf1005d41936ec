#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "prediction/weights.hpp"

namespace clearway::prediction::detail {

/// A storage of a tensor's values, as a pickle of PyTorch names it.
struct PickledStorage {
    std::string type;  ///< `FloatStorage`.
    std::string key;   ///< Its values stand in the member `data/<key>` of the archive.
    std::int64_t count = 0;
};

/// A tensor in it: values at `offset` + the sum of index times stride.
struct PickledTensor {
    PickledStorage storage;
    std::int64_t offset = 0;
    std::vector<std::int64_t> shape;
    std::vector<std::int64_t> strides;
};

/// What a pickle of a state dict is made of. References are places in `PickleDocument::values`, so that a
/// pickle which refers to itself does no harm.
struct PickleValue {
    using Reference = std::uint32_t;
    struct None {};
    struct Global {
        std::string module;
        std::string name;
    };
    struct Sequence {  ///< A tuple or a list.
        std::vector<Reference> items;
    };
    struct Dict {
        std::vector<std::pair<Reference, Reference>> items;
    };
    std::variant<None, bool, std::int64_t, double, std::string, Global, Sequence, Dict, PickledStorage,
                 PickledTensor>
        content;
};

/// What a pickle holds.
struct PickleDocument {
    std::deque<PickleValue> values;
    PickleValue::Reference top = 0;

    const PickleValue& at(PickleValue::Reference reference) const { return values[reference]; }
};

/// Reads a pickle of protocol 2 (PEP 307; opcodes by `pickletools`) as `torch.save` writes it for a state
/// dict. It is data here and never a program: of the globals only `collections.OrderedDict`, the rebuilding
/// of tensors and parameters and the storage types of `torch` are known, and what they make is made by this
/// function. Throws core::InputError, `source` naming the file, for any other global (with its name), an
/// opcode that no state dict needs, another protocol, and bytes that are cut off or make no sense.
PickleDocument read_pickle(std::string_view bytes, const std::string& source);

/// A dict of the tensors by name, as `torch.save` writes it; the values of tensor n are in `data/n` of the
/// archive.
std::string format_pickle(const std::vector<Tensor>& tensors);

}  // namespace clearway::prediction::detail
