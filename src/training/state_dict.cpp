#include "training/state_dict.hpp"

#include <bit>
#include <cassert>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "core/files.hpp"
#include "prediction/convolution_net.hpp"
#include "training/detail/zip_archive.hpp"

namespace clearway::training {
namespace {

static_assert(std::endian::native == std::endian::little, "storages of the archive are little-endian");

/// Opcodes of Python's pickle protocol 2, as `pickletools` names them.
class Pickle {
  public:
    Pickle() : bytes_("\x80\x02") {}  // PROTO 2

    void global(std::string_view module, std::string_view name) {
        bytes_ += fmt::format("c{}\n{}\n", module, name);
    }
    void mark() { bytes_ += '('; }
    void empty_dict() { bytes_ += '}'; }
    void empty_tuple() { bytes_ += ')'; }
    void tuple_from_mark() { bytes_ += 't'; }
    void reduce() { bytes_ += 'R'; }
    void persistent_id() { bytes_ += 'Q'; }
    void set_items_from_mark() { bytes_ += 'u'; }
    void new_false() { bytes_ += '\x89'; }
    void text(std::string_view value) {
        bytes_ += 'X';
        word(static_cast<std::uint32_t>(value.size()));
        bytes_ += value;
    }
    void integer(std::uint32_t value) {
        assert(value <= 0x7fffffffU);  // BININT is signed.
        bytes_ += 'J';
        word(value);
    }
    void tuple(const std::vector<std::uint32_t>& values) {
        mark();
        for (const std::uint32_t value : values)
            integer(value);
        tuple_from_mark();
    }
    void empty_ordered_dict() {
        global("collections", "OrderedDict");
        empty_tuple();
        reduce();
    }
    std::string finish() && { return std::move(bytes_) + '.'; }

  private:
    void word(std::uint32_t value) {
        char raw[4];
        std::memcpy(raw, &value, 4);
        bytes_.append(raw, 4);
    }
    std::string bytes_;
};

/// torch._utils._rebuild_tensor_v2(storage, offset, shape, strides, requires_grad, backward_hooks)
void add_tensor(Pickle& pickle, const prediction::Tensor& tensor, std::size_t storage) {
    std::vector<std::uint32_t> strides(tensor.shape.size(), 1);
    for (std::size_t axis = strides.size(); axis-- > 1;)
        strides[axis - 1] = strides[axis] * tensor.shape[axis];
    pickle.global("torch._utils", "_rebuild_tensor_v2");
    pickle.mark();
    pickle.mark();
    pickle.text("storage");
    pickle.global("torch", "FloatStorage");
    pickle.text(std::to_string(storage));
    pickle.text("cpu");
    pickle.integer(static_cast<std::uint32_t>(tensor.values.size()));
    pickle.tuple_from_mark();
    pickle.persistent_id();
    pickle.integer(0);
    pickle.tuple(tensor.shape);
    pickle.tuple(strides);
    pickle.new_false();
    pickle.empty_ordered_dict();
    pickle.tuple_from_mark();
    pickle.reduce();
}

std::string pickled(const StateDict& state) {
    Pickle pickle;
    pickle.empty_dict();
    pickle.mark();
    for (std::size_t storage = 0; storage < state.size(); ++storage) {
        pickle.text(state[storage].name);
        add_tensor(pickle, state[storage], storage);
    }
    pickle.set_items_from_mark();
    return std::move(pickle).finish();
}

const char* architecture_of(Convolution convolution) {
    using prediction::ConvolutionNet;
    using prediction::GraphConvolution;
    switch (convolution) {
        case Convolution::sage:
            return prediction::GraphSageNet::architecture;
        case Convolution::gcn:
            return ConvolutionNet::architecture(GraphConvolution::gcn);
        case Convolution::gat:
            return ConvolutionNet::architecture(GraphConvolution::gat);
    }
    throw std::logic_error("a convolution without its architecture");
}

}  // namespace

std::string format_pth(const StateDict& state, const std::string& stem) {
    detail::ZipArchive archive;
    archive.add(stem + "/data.pkl", pickled(state));
    for (std::size_t storage = 0; storage < state.size(); ++storage) {
        const std::vector<float>& values = state[storage].values;
        archive.add(fmt::format("{}/data/{}", stem, storage),
                    {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
    }
    archive.add(stem + "/version", "3\n");
    return std::move(archive).finish();
}

void write_pth(const std::filesystem::path& file, const StateDict& state) {
    core::write_atomically(file, format_pth(state, file.stem().string()));
}

prediction::Weights weights_from(const StateDict& state, const prediction::FeatureSchema& features,
                                 const prediction::GraphSageDimensions& dimensions, Convolution convolution) {
    prediction::Weights weights;
    weights.architecture = architecture_of(convolution);
    weights.features = features;
    weights.dimensions = {
        {"input", dimensions.input}, {"hidden", dimensions.hidden}, {"output", dimensions.output}};
    weights.tensors = state;
    return weights;
}

}  // namespace clearway::training
