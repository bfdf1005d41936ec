// Pickles by hand: each opcode, and what no writer of state dicts would write.
#include "prediction/detail/pickle.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"

namespace clearway::prediction::detail {
namespace {

using ::testing::HasSubstr;
using namespace std::string_literals;

const std::string begin = "\x80\x02"s;

std::string refusal(const std::string& bytes) {
    try {
        read_pickle(bytes, "x.pth");
    } catch (const core::InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "accepted";
    return "";
}

template <class Content>
Content top_of(const std::string& body) {
    const PickleDocument document = read_pickle(begin + body + ".", "x.pth");
    return std::get<Content>(document.at(document.top).content);
}

TEST(Pickle, ReadsPlainValues) {
    EXPECT_EQ(top_of<std::int64_t>("K\xff"s), 255);
    EXPECT_EQ(top_of<std::int64_t>("M\x01\x02"s), 513);
    EXPECT_EQ(top_of<std::int64_t>("J\xfe\xff\xff\xff"s), -2);
    EXPECT_EQ(top_of<std::int64_t>("\x8a\x00"s), 0);
    EXPECT_EQ(top_of<std::int64_t>("\x8a\x05\x00\x00\x00\x00\x01"s), std::int64_t{1} << 32);
    EXPECT_EQ(top_of<std::int64_t>("\x8a\x01\xff"s), -1);
    EXPECT_EQ(top_of<double>("G\x3f\xf8\0\0\0\0\0\0"s), 1.5);
    EXPECT_EQ(top_of<std::string>("X\x02\0\0\0ab"s), "ab");
    EXPECT_TRUE(top_of<bool>("\x88"));
    EXPECT_EQ(top_of<PickleValue::Sequence>("(K\1K\2t").items.size(), 2U);
    EXPECT_EQ(top_of<PickleValue::Sequence>("](K\1K\2eK\3a").items.size(), 3U);
    EXPECT_EQ(top_of<PickleValue::Dict>("}q\1(K\1K\2K\3K\4uK\5h\1s").items.size(), 3U);
    EXPECT_EQ(top_of<PickleValue::Dict>("ccollections\nOrderedDict\n)R}b").items.size(), 0U);
}

TEST(Pickle, RefusesWhatMakesNoSense) {
    for (const std::string& body : {"."s,
                                    "0."s,
                                    "(."s,
                                    "K\1K\1."s,
                                    "t."s,
                                    "K\1a."s,
                                    "}K\1s."s,
                                    "h\7."s,
                                    "j\1\0\0\0."s,
                                    "R."s,
                                    "Q."s,
                                    "K\1Q."s,
                                    "K\1K\1R."s,
                                    "ccollections\nOrderedDict\nK\1\x85R."s,
                                    "K\1}b."s,
                                    "(K\1}(K\1u."s,
                                    "\x8a\x09"s + std::string(9, '\1') + "."s,
                                    "ctorch\nFloatStorage\n)R."s,
                                    "ctorch._utils\n_rebuild_tensor_v2\n)R."s,
                                    "X\xff\xff\xff\xff"
                                    "ab."s,
                                    "c"s,
                                    "cos"s,
                                    "K"s,
                                    "K\1"s})
        EXPECT_THAT(refusal(begin + body), HasSubstr("x.pth: data.pkl: ")) << ::testing::PrintToString(body);
    EXPECT_THAT(refusal(""), HasSubstr("is cut off"));
    EXPECT_THAT(refusal("\x80\x05."), HasSubstr("protocol 5 (allowed: protocol 2)"));
    EXPECT_THAT(refusal("I1\n."), HasSubstr("does not start as a pickle"));
    EXPECT_THAT(refusal(begin + "\x93."), HasSubstr("has an opcode 0x93, which no state dict needs"));
    EXPECT_THAT(refusal(begin + std::string(2 << 20, 'N')), HasSubstr("1048576 at most"));
}

/// All ways of a pickle to name something: only what a state dict needs is known.
TEST(Pickle, KnowsNoOtherGlobals) {
    for (const char* const global : {"os\nsystem", "posix\nsystem", "builtins\neval", "builtins\ngetattr",
                                     "torch.storage\n_load_from_bytes", "torch\nload", "collections\nCounter",
                                     "torch._utils\n_rebuild_tensor", "__main__\nNet", "\n"})
        EXPECT_THAT(refusal(begin + "c" + global + "\n(X\1\0\0\0atR."s),
                    HasSubstr("was not loaded and not run"));
    // INST, OBJ, NEWOBJ, EXT1, PERSID and the like have no place at all.
    for (const char opcode :
         {'i', 'o', '\x81', '\x82', 'P', 'S', 'U', 'V', 'd', 'l', 'p', 'g', '\x8e', '\x92'})
        EXPECT_THAT(refusal(begin + opcode + "os\nsystem\n."), HasSubstr("has an opcode"));
}

TEST(Pickle, ThatRefersToItselfOrNestsDeeplyDoesNoHarm) {
    EXPECT_EQ(top_of<PickleValue::Dict>("}q\1K\1h\1s").items.size(), 1U);
    const std::string deep = ")" + std::string(500'000, '\x85');
    EXPECT_EQ(top_of<PickleValue::Sequence>(deep).items.size(), 1U);
    EXPECT_THAT(refusal(begin + std::string(500'000, '(')), HasSubstr("is cut off"));
}

}  // namespace
}  // namespace clearway::prediction::detail
