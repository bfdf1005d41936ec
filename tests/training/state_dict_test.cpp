// The own reader and writer of state dicts against those of libtorch.
#include "prediction/state_dict.hpp"

#include <gmock/gmock.h>
#include <torch/csrc/jit/serialization/pickle.h>
#include <torch/types.h>

#include "core/files.hpp"
#include "prediction/model_file.hpp"
#include "support/temporary_folder.hpp"
#include "training/comparison/torch_net.hpp"

namespace clearway::training {
namespace {

using ::testing::ElementsAre;

StateDict read_by_libtorch(const std::filesystem::path& file) {
    const std::string bytes = core::read_file(file);
    StateDict state;
    const c10::IValue value = torch::jit::pickle_load(std::vector<char>(bytes.begin(), bytes.end()));
    for (const auto& entry : value.toGenericDict()) {
        const torch::Tensor tensor = entry.value().toTensor().contiguous();
        state.push_back({entry.key().toStringRef(),
                         {tensor.sizes().begin(), tensor.sizes().end()},
                         {tensor.data_ptr<float>(), tensor.data_ptr<float>() + tensor.numel()}});
    }
    return state;
}

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
        prediction::write_pth(file, state);
        const std::vector<prediction::Tensor> read = prediction::read_model(predictor, file).tensors;
        ASSERT_EQ(read.size(), state.size()) << predictor;
        for (std::size_t at = 0; at < state.size(); ++at) {
            EXPECT_EQ(read[at].name, state[at].name);
            EXPECT_EQ(read[at].shape, state[at].shape) << state[at].name;
            EXPECT_EQ(read[at].values, state[at].values) << state[at].name;
        }
    }
}

TEST(StateDict, that_training_writes_is_read_by_libtorch) {
    const support::TemporaryFolder folder;
    const StateDict written = TorchNet({{2, 10, 5}, 3, 0.01}).state();
    prediction::write_pth(folder.path() / "GraphSAGENet.pth", written);
    const StateDict read = read_by_libtorch(folder.path() / "GraphSAGENet.pth");
    std::vector<std::string> names;
    for (std::size_t at = 0; at < read.size(); ++at) {
        names.push_back(read[at].name);
        EXPECT_EQ(read[at].shape, written[at].shape) << read[at].name;
        EXPECT_EQ(read[at].values, written[at].values) << read[at].name;
    }
    EXPECT_THAT(names, ElementsAre("graphsage.conv1.lin_l.weight", "graphsage.conv1.lin_l.bias",
                                   "graphsage.conv1.lin_r.weight", "graphsage.conv2.lin_l.weight",
                                   "graphsage.conv2.lin_l.bias", "graphsage.conv2.lin_r.weight",
                                   "nn.fc1.weight", "nn.fc1.bias", "nn.fc2.weight", "nn.fc2.bias"));
    EXPECT_THAT(read[0].shape, ElementsAre(10, 2));
    EXPECT_THAT(read[2].shape, ElementsAre(10, 2));
    EXPECT_THAT(read[3].shape, ElementsAre(5, 10));
    EXPECT_THAT(read[6].shape, ElementsAre(10, 5));
    EXPECT_THAT(read[8].shape, ElementsAre(1, 10));
    EXPECT_THAT(read[9].shape, ElementsAre(1));
}

TEST(StateDict, has_data_that_start_at_multiples_of_64) {
    const std::string bytes = prediction::format_pth(TorchNet({{2, 10, 5}, 3, 0.01}).state(), "net");
    const std::size_t member = bytes.find("net/data/0");
    ASSERT_NE(member, std::string::npos);
    const auto extra =
        static_cast<unsigned char>(bytes[member - 2]) + 256 * static_cast<unsigned char>(bytes[member - 1]);
    EXPECT_EQ((member + 10 + static_cast<std::size_t>(extra)) % 64, 0U);
}

}  // namespace
}  // namespace clearway::training
