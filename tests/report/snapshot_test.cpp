// The whole report of a small frozen study, held to the page in frozen_report.html (without its style sheet).
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include "report/frozen_study.hpp"
#include "report/page.hpp"
#include "report/read_facts.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string page_of_the_frozen_study() {
    const support::TemporaryFolder folder;
    const tests::FrozenStudy study(folder.path() / "study");
    std::string page = tests::without_script(tests::page_of(read_facts(folder.path() / "study")));
    const std::string before_source = "script-src '";
    const std::size_t source = page.find(before_source) + before_source.size();
    page.replace(source, page.find('\'', source) - source, "SCRIPT");
    const std::size_t style = page.find("<style>");
    page.erase(style, page.find("</style>") - style);
    // The manifest's hash changes with its format, of which the report knows nothing.
    const std::string before_hash = "<dt>Hash of the manifest</dt><dd>";
    const std::size_t hash = page.find(before_hash) + before_hash.size();
    return page.replace(hash, page.find("</dd>", hash) - hash, "HASH");
}

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

TEST(Snapshot, of_the_frozen_study_is_as_it_was) {
    const std::filesystem::path frozen = CLEARWAY_SOURCE_DIR "/tests/report/frozen_report.html";
    const std::filesystem::path now = CLEARWAY_BINARY_DIR "/tests/report/frozen_report.html";
    const std::string page = page_of_the_frozen_study();
    std::ofstream(now) << page;
    std::istringstream expected(text_of(frozen));
    std::istringstream actual(page);
    std::string expected_line;
    std::string actual_line;
    for (int line = 1; std::getline(actual, actual_line); ++line) {
        std::getline(expected, expected_line);
        ASSERT_EQ(actual_line, expected_line)
            << "line " << line << ". If the change is meant, look at the page and accept it:\n  cp "
            << now.string() << " " << frozen.string();
    }
    EXPECT_FALSE(std::getline(expected, expected_line)) << "the page ends early, before: " << expected_line;
}

TEST(Snapshot, shows_every_section_and_lets_no_name_out) {
    const std::string page = page_of_the_frozen_study();
    for (const char* const id : {"overview", "verdict", "tables", "differences", "travel-time", "cost",
                                 "journeys", "enough", "calibration", "outcomes", "reproduce"})
        EXPECT_THAT(page, HasSubstr("<section id=\"" + std::string(id) + "\">"));
    EXPECT_THAT(page, HasSubstr("helped</span>: EV travel time"));
    EXPECT_THAT(page, HasSubstr("ran without safety checks</span>: EV travel time"));
    EXPECT_THAT(page, HasSubstr("Long &amp; &lt;b&gt;Short&lt;/b&gt; Street (north_in)"));
    for (const char* const evil : {"<script", "<img", "<b>", "nan"})
        EXPECT_THAT(page, Not(HasSubstr(evil)));
}

}  // namespace
}  // namespace clearway::report
