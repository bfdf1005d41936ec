// Files of SUMO that would exhaust the stack, the memory or the patience.
#include <gmock/gmock.h>
#include <zlib.h>

#include "sumo_line.hpp"
#include "support/repeated.hpp"

namespace clearway::scenario_import {
namespace {

using support::repeated;
using testing::AllOf;
using testing::HasSubstr;

class BadSumoFiles : public SumoScenario {
  protected:
    ImportRequest configured(const std::string& begin, const std::string& more = "") const {
        line_network();
        write("line.rou.xml", "<routes>" + cars(20) + "</routes>");
        return request({write("line.sumocfg",
                              "<configuration><net-file value='line.net.xml'/>"
                              "<route-files value='line.rou.xml'/>" +
                                  begin + more + "</configuration>")});
    }
    static constexpr std::size_t levels = 200000;
};

TEST_F(BadSumoFiles, with_many_levels_are_named) {
    const std::string deep = repeated("<param>", levels) + repeated("</param>", levels);
    const std::string network = core::read_file(line_network());
    const auto deep_network =
        write("deep.net.xml", network.substr(0, network.rfind("</net>")) + deep + "</net>");
    EXPECT_THAT(refusal(request({deep_network})),
                AllOf(HasSubstr("deep.net.xml"), HasSubstr("at most 200 levels")));
    EXPECT_THAT(refusal(line_with(cars(20) + "<vehicle id='deep' depart='9'>" + deep + "</vehicle>")),
                AllOf(HasSubstr("line.rou.xml"), HasSubstr("at most 200 levels")));
    EXPECT_THAT(refusal(configured("", deep)),
                AllOf(HasSubstr("line.sumocfg"), HasSubstr("at most 200 levels")));
}

TEST_F(BadSumoFiles, whose_network_would_write_files_are_refused) {
    const std::string network = core::read_file(line_network());
    const auto diary = write("diary.txt", "dear diary");
    const auto writing =
        write("writing.net.xml", network.substr(0, network.rfind("</net>")) + "<edgeData id='d' file='" +
                                     diary.string() + "'/></net>");
    EXPECT_THAT(
        refusal(request({writing})),
        AllOf(HasSubstr("writing.net.xml: <edgeData> lets SUMO write files"), HasSubstr(diary.string())));
    EXPECT_EQ(core::read_file(diary), "dear diary");
}

TEST_F(BadSumoFiles, with_impossible_times_are_named) {
    for (const char* const begin : {"-9223372036854775808", "1e18", "-1", "noon"})
        EXPECT_THAT(refusal(configured(fmt::format("<begin value='{}'/>", begin))),
                    AllOf(HasSubstr("line.sumocfg: begin"), HasSubstr(begin), HasSubstr("0 to 1e+09 s")));
    EXPECT_THAT(refusal(line_with(cars(20) + car("late", 1e18))),
                AllOf(HasSubstr("line.rou.xml"), HasSubstr("depart"), HasSubstr("0 to 1e+09")));
    EXPECT_THAT(
        refusal(line_with(cars(20) + "<flow id='f' from='first' to='second' begin='1e18' number='2'/>")),
        HasSubstr("begins at 1e+18 s"));
}

TEST_F(BadSumoFiles, with_too_many_departures_are_named) {
    for (const char* const rate :
         {"number='4294967295' end='0'", "period='1e-9'", "period='exp(1e9)'", "vehsPerHour='1e15'"})
        EXPECT_THAT(
            refusal(line_with(cars(20) + "<flow id='f' from='first' to='second' begin='0' " + rate + "/>")),
            AllOf(HasSubstr("flow \"f\""), HasSubstr("at most 4320000")))
            << rate;
}

TEST_F(BadSumoFiles, packed_blanks_are_refused_before_they_fill_the_memory) {
    const auto bomb = folder() / "bomb.net.xml.gz";
    gzFile stream = gzopen(bomb.c_str(), "wb1");
    ASSERT_NE(stream, nullptr);
    const std::string blanks(std::size_t{1} << 20, ' ');
    gzputs(stream, "<net>");
    for (int mebibyte = 0; mebibyte < 520; ++mebibyte)
        gzwrite(stream, blanks.data(), static_cast<unsigned>(blanks.size()));
    gzputs(stream, "</net>");
    gzclose(stream);
    EXPECT_THAT(refusal(request({bomb})),
                AllOf(HasSubstr("bomb.net.xml.gz"), HasSubstr("more than 512 MiB unpacked")));
}

TEST_F(BadSumoFiles, a_trial_run_that_never_ends_is_ended) {
    std::filesystem::create_directories(folder() / "bin");
    const auto sumo = write("bin/sumo", "#!/bin/sh\nexec sleep 1000\n");
    std::filesystem::permissions(sumo, std::filesystem::perms::owner_all);
    ImportRequest endless = line_with(cars(20));
    endless.program_limit_s = 1.0;
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", ((folder() / "bin").string() + ":" + path).c_str(), 1);
    EXPECT_THAT(refusal(endless), AllOf(HasSubstr("does not end within 1 s"), HasSubstr("speedDev"),
                                        HasSubstr("--program-limit")));
    ::setenv("PATH", path.c_str(), 1);
}

}  // namespace
}  // namespace clearway::scenario_import
