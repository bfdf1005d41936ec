// The own reader of state dicts against what libtorch writes.
#include "prediction/state_dict.hpp"

#include <gmock/gmock.h>
#include <torch/csrc/jit/serialization/pickle.h>
#include <torch/types.h>

#include "prediction/model_file.hpp"
#include "support/temporary_folder.hpp"
#include "training/state_dict.hpp"

namespace clearway::training {
namespace {

/// PyTorch's own writer of archives: sizes behind the data, a zip64 end, its padding.
TEST(StateDict, of_libtorch_is_read_to_the_bit) {
    const StateDict state = TorchNet({{5, 10, 5}, 7, 0.01}).state();
    c10::Dict<std::string, torch::Tensor> dict;
    for (const prediction::Tensor& tensor : state) {
        const std::vector<std::int64_t> shape(tensor.shape.begin(), tensor.shape.end());
        dict.insert(tensor.name, torch::tensor(tensor.values).reshape(shape));
    }
    // The first as a transposed view of another storage, as tied or sliced parameters are.
    const torch::Tensor turned = dict.at(state.front().name).t().contiguous().t();
    ASSERT_FALSE(turned.is_contiguous());
    dict.insert_or_assign(state.front().name, turned);
    const std::vector<char> bytes = torch::jit::pickle_save(dict);
    const std::vector<prediction::Tensor> read =
        prediction::parse_pth(std::string(bytes.begin(), bytes.end()), "libtorch.pth");
    ASSERT_EQ(read.size(), state.size());
    for (std::size_t at = 0; at < state.size(); ++at) {
        EXPECT_EQ(read[at].name, state[at].name);
        EXPECT_EQ(read[at].shape, state[at].shape) << state[at].name;
        EXPECT_EQ(read[at].values, state[at].values) << state[at].name;
    }
}

TEST(StateDict, that_training_writes_is_read_to_the_bit) {
    const support::TemporaryFolder folder;
    for (const auto& [convolution, predictor] : {std::pair(Convolution::sage, "graphsage_corrected"),
                                                 {Convolution::gcn, "gcn"},
                                                 {Convolution::gat, "gat"}}) {
        const StateDict state = TorchNet({{5, 10, 5}, 3, 0.01, convolution}).state();
        const std::string file = (folder.path() / (std::string(predictor) + ".pth")).string();
        write_pth(file, state);
        const std::vector<prediction::Tensor> read = prediction::read_model(predictor, file).tensors;
        ASSERT_EQ(read.size(), state.size()) << predictor;
        for (std::size_t at = 0; at < state.size(); ++at) {
            EXPECT_EQ(read[at].name, state[at].name);
            EXPECT_EQ(read[at].shape, state[at].shape) << state[at].name;
            EXPECT_EQ(read[at].values, state[at].values) << state[at].name;
        }
    }
}

}  // namespace
}  // namespace clearway::training
