#include <cmath>

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "report/read_facts.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::report {
namespace {

using ::testing::HasSubstr;

std::string error_of(const support::TemporaryFolder& folder) {
    try {
        static_cast<void>(read_losses(folder.path()));
    } catch (const core::InputError& error) {
        return error.what();
    }
    return {};
}

TEST(Losses, are_read_with_the_name_of_the_held_out_part) {
    const support::TemporaryFolder folder;
    folder.write("losses.csv", "epoch,train_loss_nat,validation_loss_nat\n0,0.7,0.75\n1,0.5,\n");
    const LossCurve curve = read_losses(folder.path());
    EXPECT_EQ(curve.held_out, "validation");
    EXPECT_THAT(curve.epoch, ::testing::ElementsAre(0.0, 1.0));
    EXPECT_DOUBLE_EQ(curve.test[0], 0.75);
    EXPECT_TRUE(std::isnan(curve.test[1]));
}

TEST(Losses, are_shown_with_what_they_hide) {
    const support::TemporaryFolder folder;
    folder.write("losses.csv", "epoch,train_loss_nat,test_loss_nat\n0,0.7,0.75\n");
    folder.write("summary.json",
                 R"({"pairs":"candidates","constant_test_loss_nat":0.6912,"test":{"auc":0.517,"ap":0.4}})");
    const LossCurve curve = read_losses(folder.path());
    EXPECT_EQ(curve.title, "GraphSAGE, as published; list of candidate pairs");
    EXPECT_EQ(curve.constant_loss, 0.6912);
    EXPECT_EQ(curve.note,
              "Loss of the best constant answer on the test pairs: 0.691. AUC on the test pairs: 0.52 "
              "(chance: 0.5).");
}

TEST(Losses, of_true_links_only_have_no_auc) {
    const support::TemporaryFolder folder;
    folder.write("losses.csv", "epoch,train_loss_nat,test_loss_nat\n0,0.7,0.75\n");
    folder.write("summary.json",
                 R"({"pairs":"true-links","constant_test_loss_nat":0.0,"test":{"auc":null}})");
    EXPECT_THAT(read_losses(folder.path()).note, HasSubstr("No AUC"));
}

TEST(Losses, of_a_corrected_training_are_named_so) {
    const support::TemporaryFolder folder;
    folder.write("losses.csv", "epoch,train_loss_nat,validation_loss_nat\n0,0.7,0.75\n");
    folder.write("summary.json", R"({"mode":"corrected"})");
    EXPECT_EQ(read_losses(folder.path()).title, "GraphSAGE, corrected inputs; validated on unseen seeds");
    folder.write("summary.json", R"({"mode":3,"pairs":null,"test":"x"})");
    EXPECT_EQ(read_losses(folder.path()).note, "");
    folder.write("summary.json", "[1");
    EXPECT_THAT(error_of(folder), HasSubstr("is not a JSON object"));
}

TEST(Losses, that_are_damaged_are_refused_with_file_and_line) {
    const support::TemporaryFolder folder;
    folder.write("losses.csv", "epoch,train,test\n0,0.7,0.75\n");
    EXPECT_THAT(error_of(folder), HasSubstr("losses.csv:1: unknown columns"));
    folder.write("losses.csv", "epoch,train_loss_nat,test_loss_nat\n0,0.7,0.75\n1,0.6\n");
    EXPECT_THAT(error_of(folder), HasSubstr("losses.csv:3: 2 cells"));
    folder.write("losses.csv", "epoch,train_loss_nat,test_loss_nat\n0,<b>,0.75\n");
    EXPECT_THAT(error_of(folder), HasSubstr("losses.csv:2: '<b>' is not a number"));
}

TEST(Picture, of_a_network_is_safe) {
    EXPECT_TRUE(
        is_safe_picture("<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"network\" viewBox=\"0 0 9 "
                        "9\"><title>on top</title>\n"
                        "<style>.network polyline{fill:none;stroke:currentColor}</style><polyline "
                        "points=\"1,2 3,4\"/></svg>\n"));
}

TEST(Picture, that_could_act_or_load_is_not_safe) {
    for (const char* const evil :
         {"<svg><script>alert(1)</script></svg>", "<svg onload=\"alert(1)\"></svg>",
          "<svg><g/ONCLICK = 'x'/></svg>", "<svg><a href=\"x\"></a></svg>",
          "<svg><style>@import 'x'</style></svg>", "<svg><rect fill=\"url(http://x)\"/></svg>",
          "<svg><foreignObject><p>x</p></foreignObject></svg>", "<svg></svg><p>x</p>",
          "<svg></svg><svg></svg>", "<svg></svg><b></svg>", "<svg><!-- </svg>", "no picture", ""}) {
        EXPECT_FALSE(is_safe_picture(evil)) << evil;
    }
}

}  // namespace
}  // namespace clearway::report
