// Readers of text: what users write, what other programs wrote, and what Clearway keeps of its runs.
#include <filesystem>

#include "core/json.hpp"
#include "core/strict_table.hpp"
#include "experiment/job.hpp"
#include "fuzz/readers.hpp"
#include "links/link_benchmark.hpp"
#include "results/detail/record_files.hpp"
#include "results/detail/signal_event_files.hpp"
#include "results/manifest.hpp"
#include "results/synthetic.hpp"
#include "roads/network.hpp"
#include "scenario/config.hpp"
#include "scenario/network_document.hpp"
#include "scenario/preemption.hpp"
#include "scenario_import/detail/left_out.hpp"
#include "scenario_import/osm/map_contents.hpp"
#include "scenario_import/sumo/configuration.hpp"
#include "scenario_import/sumo/demand_reader.hpp"
#include "study/config.hpp"

namespace clearway::fuzz {
namespace {

const std::vector<std::string> toml_words = {"[",
                                             "]",
                                             "[[",
                                             "]]",
                                             "{",
                                             "}",
                                             " = ",
                                             "\n",
                                             "\"",
                                             "'''",
                                             "\"\"\"",
                                             "\\u0000",
                                             "\\UFFFFFFFF",
                                             "nan",
                                             "-inf",
                                             "1e308",
                                             "0x7fffffffffffffff",
                                             "-9223372036854775808",
                                             "18446744073709551616",
                                             "1979-05-27T07:32:00Z",
                                             "true",
                                             ".",
                                             ",",
                                             "#"};
const std::vector<std::string> study_words = {
    "[factors]",    "factors",    "condition", "conditions", "scenarios",    "replications", "policies",
    "predictor",    "failure",    "seed",      "quick",      "plan",         "comparison",   "against",
    "demand.human", "4294967295", "range",     "step",       "from",         "to",           "= []",
    "= [[]]",       "= {}",       "0.1, 0.2",  "merge",      "intersection", "B10"};
const std::vector<std::string> json_words = {"{",       "}",          "[",    "]",     ":",   ",",
                                             "\"",      "null",       "true", "1e999", "-1",  "\\u0000",
                                             "\\ud800", "4294967296", "{}",   "[]",    "\"\""};
const std::vector<std::string> csv_words = {",",   "\"",  "\"\"", "\n",    "\r\n",
                                            "nan", "inf", "-0",   "1e999", ",,,,"};
const std::vector<std::string> xml_words = {"<",
                                            ">",
                                            "</",
                                            "/>",
                                            "<!--",
                                            "-->",
                                            "<![CDATA[",
                                            "]]>",
                                            "&amp;",
                                            "&#0;",
                                            "&#x110000;",
                                            "=\"\"",
                                            "\"",
                                            "<?xml ",
                                            "?>",
                                            "id",
                                            "from",
                                            "to",
                                            "shape=\"\"",
                                            "shape=\"nan,inf\"",
                                            "speed=\"-1\"",
                                            "length=\"1e999\"",
                                            "index=\"4294967296\"",
                                            "numLanes=\"-1\"",
                                            "state=\"rGyu\"",
                                            "duration=\"0\"",
                                            "period=\"exp(0)\"",
                                            "number=\"2147483648\"",
                                            "depart=\"triggered\"",
                                            "edges=\"\"",
                                            "probability=\"2\"",
                                            "begin=\"-9223372036854775808\"",
                                            "<!DOCTYPE a [<!ENTITY b \"c\">]>",
                                            "&b;"};

std::vector<std::string> joined(std::vector<std::string> both, const std::vector<std::string>& more) {
    both.insert(both.end(), more.begin(), more.end());
    return both;
}

void read_demand(const std::string& file) {
    scenario_import::detail::LeftOut left_out;
    scenario_import::detail::DemandReader reader({}, 1.0, left_out);
    const auto others = reader.read(file);
    reader.with_named(others);
    reader.finish();
}

std::vector<Reader> toml_readers() {
    const std::string study = source_file("studies/parts.toml");
    return {
        {"toml",
         [](std::string_view bytes) { core::parse_toml(std::string(bytes), "x.toml"); },
         {study, source_file("scenarios/bologna/scenario.toml")},
         toml_words},
        {"study",
         [](std::string_view bytes) { study::read_study(scratch_file("study.toml", bytes)); },
         {study, source_file("studies/dissertation.toml"), source_file("studies/cooperation.toml"),
          source_file("studies/ceilings_jam.toml"), source_file("studies/arterial_failure.toml")},
         joined(toml_words, study_words)},
        {"scenario",
         [](std::string_view bytes) {
             for (const char* name :
                  {"merge.nod.xml", "merge.edg.xml", "merge.con.xml", "rural.nod.xml", "rural.edg.xml"})
                 scratch_file(name, "");
             scenario::load(scratch_file("scenario.toml", bytes));
         },
         {source_file("scenarios/merge/scenario.toml"), source_file("scenarios/city/scenario.toml"),
          source_file("scenarios/rural/scenario.toml")},
         toml_words},
        {"link_benchmark",
         [](std::string_view bytes) { links::read_link_benchmark(scratch_file("benchmark.toml", bytes)); },
         {source_file("studies/links/eval_v1.toml"), source_file("studies/links/eval_v2.toml")},
         toml_words}};
}

std::vector<Reader> record_readers() {
    using namespace results::detail;
    const auto corpus = [](const char* name) {
        return source_file(std::string("tests/fuzz/corpus/") + name);
    };
    const results::RunRecord run = results::synthetic::record({"alpha", "baseline", 0});
    const std::string vehicles = vehicles_to_csv(run.vehicles);
    return {{"json",
             [](std::string_view bytes) { core::to_text(core::parse_object(std::string(bytes), "x.json")); },
             {corpus("manifest.json"), corpus("timing.json")},
             json_words},
            {"manifest",
             [](std::string_view bytes) { results::manifest_from_json(std::string(bytes), "manifest.json"); },
             {corpus("manifest.json")},
             json_words},
            {"run",
             [vehicles](std::string_view bytes) { run_from_json(std::string(bytes), vehicles, "run.json"); },
             {run_to_json(run, vehicles, "build")},
             json_words},
            {"job",
             [](std::string_view bytes) { experiment::read_job(scratch_file("job.json", bytes)); },
             {corpus("job.json")},
             json_words},
            {"timing",
             [](std::string_view bytes) { timing_from_json(std::string(bytes), "timing.json"); },
             {corpus("timing.json")},
             json_words},
            {"error",
             [](std::string_view bytes) { error_from_json(std::string(bytes), "error.json"); },
             {corpus("error.json")},
             json_words},
            {"vehicles",
             [](std::string_view bytes) { vehicles_from_csv(std::string(bytes), "vehicles.csv"); },
             {corpus("vehicles.csv")},
             csv_words},
            {"signal_events",
             [](std::string_view bytes) { signal_events_from_csv(std::string(bytes), "events.csv"); },
             {corpus("signal_events.csv")},
             csv_words},
            {"preemption",
             [](std::string_view bytes) {
                 std::vector<core::Problem> problems;
                 scenario::read_preemption_rows(scratch_file("preemption.csv", bytes), problems);
             },
             {corpus("preemption.csv")},
             csv_words}};
}

std::vector<Reader> xml_readers() {
    using namespace scenario_import::detail;
    const std::string crossing = source_file("tests/support/data/two_crossings.net.xml");
    const std::string footway = source_file("tests/support/data/footway.net.xml");
    return {{"network",
             [](std::string_view bytes) { roads::Network::read(scratch_file("x.net.xml", bytes)); },
             {crossing, footway},
             xml_words},
            {"network_document",
             [](std::string_view bytes) {
                 scenario::NetworkDocument document(scratch_file("x.net.xml", bytes));
                 document.without_newer_classes();
                 document.part_two_way_edges();
                 document.name_controllers();
                 document.limit_speed(core::MetresPerSecond(10.0));
                 document.text();
             },
             {crossing, footway},
             xml_words},
            {"demand",
             [](std::string_view bytes) { read_demand(scratch_file("x.rou.xml", bytes)); },
             {source_file("tests/fuzz/corpus/demand.rou.xml")},
             xml_words},
            {"configuration",
             [](std::string_view bytes) {
                 for (const char* name : {"town.osm", "demand.rou.xml", "preemption.csv"})
                     scratch_file(name, "");
                 read_configuration(scratch_file("x.sumocfg", bytes));
             },
             {source_file("tests/fuzz/corpus/town.sumocfg")},
             xml_words},
            {"map",
             [](std::string_view bytes) { read_map(scratch_file("x.osm", bytes)); },
             {source_file("tests/fuzz/corpus/town.osm")},
             xml_words}};
}

}  // namespace

std::vector<Reader> text_readers() {
    std::vector<Reader> all = toml_readers();
    for (const auto& more : {record_readers(), xml_readers()})
        all.insert(all.end(), more.begin(), more.end());
    return all;
}

}  // namespace clearway::fuzz
