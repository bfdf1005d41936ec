// Nets that Python saved. write_pth.py makes the files; the expected values follow from its formula.
#include "prediction/model_file.hpp"

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/process.hpp"
#include "prediction/nets.hpp"
#include "prediction/predictor.hpp"
#include "prediction/state_dict.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::prediction {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The folder with the files, made once.
const std::filesystem::path& saved() {
    static const support::TemporaryFolder folder;
    static const bool is_made = [] {
        const core::Exit exit =
            core::run({"/usr/bin/python3",
                       {CLEARWAY_SOURCE "/tests/prediction/write_pth.py", folder.path().string()},
                       {},
                       folder.path() / "log.txt"});
        if (!exit.ok()) throw std::runtime_error(core::read_file(folder.path() / "log.txt"));
        return true;
    }();
    static_cast<void>(is_made);
    return folder.path();
}

std::string pth(const std::string& name) {
    return (saved() / (name + ".pth")).string();
}

float expected(std::size_t tensor, std::size_t value) {
    return static_cast<float>(100 * tensor + value) / 128.0F - 3.0F;
}

/// The message with which `predictor` refuses the file.
std::string refusal(const std::string& predictor, const std::string& file) {
    try {
        check_model(predictor, file);
    } catch (const core::InputError& error) {
        EXPECT_EQ(error.exit_code(), core::ExitCode::bad_input);
        EXPECT_THAT(error.what(), HasSubstr(file));
        return error.what();
    }
    ADD_FAILURE() << predictor << " takes " << file;
    return "";
}
std::string refused(const std::string& name) {
    return refusal("graphsage_as_published", pth(name));
}

TEST(StateDicts, OfThePublishedClassAreReadToTheBit) {
    const Weights weights = read_model("graphsage_as_published", pth("good"));
    EXPECT_EQ(weights.architecture, "graphsage_net");
    EXPECT_EQ(weights.features, as_published_attributes_schema());
    EXPECT_THAT(weights.dimensions,
                ElementsAre(Dimension{"input", 5}, Dimension{"hidden", 10}, Dimension{"output", 5}));
    ASSERT_EQ(weights.tensors.size(), 10U);
    const Weights shapes = testing::zero_net(as_published_attributes_schema(), 10, 5);
    for (std::size_t tensor = 0; tensor < 10; ++tensor) {
        const Tensor& read = weights.tensors[tensor];
        EXPECT_EQ(read.name, shapes.tensors[tensor].name);
        EXPECT_EQ(read.shape, shapes.tensors[tensor].shape) << read.name;
        ASSERT_EQ(read.values.size(), shapes.tensors[tensor].values.size()) << read.name;
        for (std::size_t value = 0; value < read.values.size(); ++value)
            ASSERT_EQ(read.values[value], expected(tensor, value)) << read.name << " " << value;
    }
    EXPECT_EQ(read_model("graphsage_as_published", pth("two_features")).features,
              as_published_position_schema());
    EXPECT_EQ(read_model("graphsage_corrected", pth("good")).features, corrected_schema());
}

TEST(StateDicts, AreTheSameHoweverTheyWereSaved) {
    const std::vector<Tensor> good = read_model("graphsage_as_published", pth("good")).tensors;
    for (const char* const name : {"plain_dict", "parameters", "half", "double", "cuda", "parallel",
                                   "seekable", "strided", "zip64_end"}) {
        const std::vector<Tensor> read = read_model("graphsage_as_published", pth(name)).tensors;
        ASSERT_EQ(read.size(), good.size()) << name;
        for (std::size_t tensor = 0; tensor < read.size(); ++tensor) {
            EXPECT_EQ(read[tensor].name, good[tensor].name) << name;
            EXPECT_EQ(read[tensor].shape, good[tensor].shape) << name << " " << read[tensor].name;
            EXPECT_EQ(read[tensor].values, good[tensor].values) << name << " " << read[tensor].name;
        }
    }
    // bfloat16 keeps 8 bits of each number.
    const std::vector<Tensor> rough = read_model("graphsage_as_published", pth("bfloat16")).tensors;
    for (std::size_t tensor = 0; tensor < rough.size(); ++tensor) {
        for (std::size_t value = 0; value < rough[tensor].values.size(); ++value)
            ASSERT_NEAR(rough[tensor].values[value], good[tensor].values[value],
                        std::abs(good[tensor].values[value]) / 128.0F);
    }
}

TEST(StateDicts, OfOtherConvolutionsDriveTheirPredictors) {
    for (const std::string name : {"gcn", "gat"}) {
        EXPECT_NO_THROW(check_model(name, pth(name)));
        EXPECT_THAT(
            refusal("graphsage_as_published", pth(name)),
            AllOf(HasSubstr(
                      "is not a state dict of the dissertation's GraphSAGENet: it lacks conv1.lin_l.weight"),
                  HasSubstr("it also has "), HasSubstr("conv1.lin.weight")));
        EXPECT_THAT(refusal(name, pth("good")), HasSubstr("it lacks conv1.lin.weight"));
    }
}

TEST(StateDicts, WithAForeignClassAreRefusedAndNeverRun) {
    EXPECT_THAT(refused("attack"),
                AllOf(HasSubstr("posix.system, which no state dict needs; it was not loaded and not run"),
                      HasSubstr("torch.save(model.state_dict(), file)")));
    EXPECT_FALSE(std::filesystem::exists(saved() / "was_run"));
    EXPECT_THAT(refused("whole_model"), HasSubstr("names __main__.GraphSAGENet"));
    EXPECT_THAT(refused("script"), HasSubstr("is a TorchScript program"));
}

TEST(StateDicts, OfOtherNetsAreRefusedNamingWhatDiffers) {
    EXPECT_THAT(refused("three_features"),
                AllOf(HasSubstr("the net takes 3 features of a vehicle"),
                      HasSubstr("2 (as_published_position) or 5 (as_published_attributes)")));
    EXPECT_THAT(refusal("graphsage_corrected", pth("two_features")),
                AllOf(HasSubstr("the net takes 2 features"), HasSubstr("5 (corrected)")));
    EXPECT_THAT(refused("missing_key"), HasSubstr("it lacks fc2.bias (allowed: conv1.lin_l.weight, "));
    EXPECT_THAT(refused("extra_key"), HasSubstr("it also has graphsage.conv3.bias"));
    EXPECT_THAT(refused("wide"), AllOf(HasSubstr("tensor nn.fc1.bias is 11"), HasSubstr("allowed: 10")));
    EXPECT_THAT(refused("checkpoint"), AllOf(HasSubstr("model_state_dict: is no tensor"),
                                             HasSubstr("Of a checkpoint, save the state dict alone")));
    EXPECT_THAT(refused("list"), HasSubstr("holds no dict"));
    EXPECT_THAT(refused("empty"), HasSubstr("holds 0 tensors"));
    EXPECT_THAT(refusal("graphsage", pth("good")),
                AllOf(HasSubstr("is a file of torch.save, which graphsage does not take"),
                      HasSubstr("graphsage_as_published, graphsage_corrected, gcn, gat")));
}

TEST(StateDicts, WithUnfitNumbersAreRefusedNamingTheTensor) {
    EXPECT_THAT(refused("not_a_number"), AllOf(HasSubstr("nn.fc1.bias: holds nan, its value 5 of 10"),
                                               HasSubstr("The training diverged")));
    EXPECT_THAT(refused("infinite_half"), HasSubstr("nn.fc1.bias: holds inf, its value 1 of 10"));
    EXPECT_THAT(refused("whole_numbers"), HasSubstr("nn.fc1.bias: holds whole numbers (LongStorage)"));
    for (const char* const name : {"out_of_storage", "before_storage", "huge"})
        EXPECT_THAT(refused(name), HasSubstr("values within their storage")) << name;
}

TEST(StateDicts, InOtherFormsAreRefusedWithTheCure) {
    EXPECT_THAT(refused("compressed"), HasSubstr("is compressed (method 8)"));
    EXPECT_THAT(refused("big_endian"), HasSubstr("has big-endian numbers"));
    EXPECT_THAT(refused("protocol_4"), AllOf(HasSubstr("protocol 4"), HasSubstr("without pickle_protocol")));
    EXPECT_THAT(refused("twice"), HasSubstr("holds twice/data/0 twice"));
    EXPECT_THAT(refused("damaged"), HasSubstr("damaged/data/3 is damaged: its checksum is "));
    EXPECT_THAT(refused("old"),
                AllOf(HasSubstr("has the format of torch before 1.6"), HasSubstr("or newer")));
    for (const char* const name : {"text", "nothing"})
        EXPECT_THAT(refused(name), HasSubstr("is no zip archive (allowed: an archive of torch.save)"))
            << name;
    EXPECT_THROW(check_model("graphsage_as_published", pth("none")), core::InputError);
}

TEST(StateDicts, CutOffAnywhereAreRefused) {
    const std::string whole = core::read_file(pth("good"));
    for (std::size_t length = 0; length < whole.size(); ++length)
        ASSERT_THROW(parse_pth(whole.substr(0, length), "cut.pth"), core::InputError) << length;
    try {
        parse_pth(whole.substr(0, whole.size() / 2), "cut.pth");
    } catch (const core::InputError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("cut.pth: is cut off"), HasSubstr("Save it again")));
    }
}

/// Every byte of it in turn set to others: refused, or read as something, and never anything else.
TEST(StateDicts, WithAnyByteChangedDoNoHarm) {
    const std::string whole = core::read_file(pth("good"));
    std::size_t refusals = 0;
    for (std::size_t at = 0; at < whole.size(); ++at) {
        for (const int change : {0x01, 0x80, 0xff}) {
            std::string changed = whole;
            changed[at] = static_cast<char>(changed[at] ^ change);
            try {
                parse_pth(changed, "changed.pth");
            } catch (const core::InputError&) {
                ++refusals;
            }
        }
    }
    EXPECT_GT(refusals, whole.size());
}

}  // namespace
}  // namespace clearway::prediction
