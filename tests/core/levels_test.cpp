#include <string>

#include <gmock/gmock.h>

#include "core/json.hpp"
#include "core/strict_table.hpp"
#include "core/xml_stream.hpp"
#include "support/message_of.hpp"
#include "support/repeated.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::core {
namespace {

using support::message_of;
using support::repeated;
using testing::AllOf;
using testing::HasSubstr;

/// Counts elements.
struct Counter : XmlHandler {
    std::size_t elements = 0;
    void start(std::string_view, const XmlAttributes&, unsigned long) override { ++elements; }
    void end(std::string_view) override {}
};

std::string nested_elements(std::size_t levels) {
    return "<a>\n" + repeated("<b>", levels - 1) + repeated("</b>", levels - 1) + "</a>";
}

TEST(Levels, OfXmlHaveALimitThatNamesFileAndLine) {
    const support::TemporaryFolder folder;
    Counter counter;
    stream_xml(folder.write("ok.xml", nested_elements(most_xml_levels)), counter);
    EXPECT_EQ(counter.elements, static_cast<std::size_t>(most_xml_levels));
    for (const std::size_t levels : {most_xml_levels + 1UL, 200000UL}) {
        const auto file = folder.write("deep.xml", nested_elements(levels));
        EXPECT_THAT(message_of([&] { stream_xml(file, counter); }),
                    AllOf(HasSubstr("deep.xml:2: has more than 200 levels of elements"),
                          HasSubstr("at most 200 levels"), HasSubstr("right file")));
    }
}

TEST(Levels, OfTomlKeysHaveALimitThatNamesFileAndLine) {
    const std::string key = repeated("a.", 49) + "a";
    EXPECT_NO_THROW(parse_toml(key + " = 1", "study.toml"));
    for (const std::string& deep :
         {"x = 1\n" + repeated("a.", 100000) + "a = 1", "x = 1\n[" + repeated("\"a\" . ", 100000) + "a]",
          "x = 1\n[[" + repeated("a.", 50) + "a]]", "x = 1\ny = {" + repeated("a.", 100000) + "a = 1}"})
        EXPECT_THAT(message_of([&] { parse_toml(deep, "study.toml"); }),
                    AllOf(HasSubstr("study.toml:2: has a key of more than 50 levels"), HasSubstr("Correct")));
}

TEST(Levels, OfTomlValuesHaveALimitThatNamesFileAndLine) {
    EXPECT_NO_THROW(parse_toml("x = " + repeated("[", 50) + repeated("]", 50), "study.toml"));
    for (const std::string& deep :
         {"\nx = " + repeated("[", 100000), "\nx = " + repeated("{a=", 100000) + "1"})
        EXPECT_THAT(message_of([&] { parse_toml(deep, "study.toml"); }),
                    HasSubstr("study.toml:2: has a value of more than 50 levels"));
}

TEST(Levels, OfTomlDoNotCountInTextsAndComments) {
    const std::string brackets = repeated("[.", 200);
    const std::string text = "# " + brackets + "\na = \"\\\"" + brackets + "\" # " + brackets + "\nb = '" +
                             brackets + "\\'\nc = \"\"\"\n" + brackets + "\"\" \\\"\"\"\"\nd = '''\n" +
                             brackets + "'''\ne = \"\"\"a\"\"\"\"\"\nf = [1.5, 2.5]\n";
    const toml::table table = parse_toml(text, "study.toml");
    EXPECT_EQ(table.size(), 6U);
}

TEST(Levels, OfJsonHaveALimitThatNamesTheFile) {
    const auto nested = [](std::size_t levels) {
        return repeated(R"({"a":)", levels) + "1" + repeated("}", levels);
    };
    EXPECT_NO_THROW(parse_object(nested(100), "manifest.json"));
    EXPECT_NO_THROW(parse_object(R"({"a": ")" + repeated("[", 200) + R"(\"[", "b": []})", "manifest.json"));
    for (const std::string& deep : {nested(101), nested(1000000), R"({"a":)" + repeated("[", 1000000)})
        EXPECT_THAT(message_of([&] { parse_object(deep, "manifest.json"); }),
                    AllOf(HasSubstr("manifest.json: has more than 100 levels"), HasSubstr("at most 100")));
}

TEST(Json, DoesNotEndAtACharacterZero) {
    for (const std::string& text :
         {std::string("{}\0 and more", 11), std::string("{}\0", 3), std::string(9, '\0')})
        EXPECT_THAT(message_of([&] { parse_object(text, "run.json"); }), HasSubstr("is not a JSON object"));
}

}  // namespace
}  // namespace clearway::core
