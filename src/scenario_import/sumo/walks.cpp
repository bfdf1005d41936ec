#include "scenario_import/sumo/walks.hpp"

#include <functional>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "core/files.hpp"
#include "roads/walkways.hpp"
#include "scenario_import/detail/tool.hpp"

namespace clearway::scenario_import::detail {

namespace {

/// From, to, and the positions there if they are numbers. Equal walks share a route.
using WalkKey = std::tuple<std::string, std::string, std::string, std::string>;

const std::string& number_text(const std::string& text) {
    static const std::string none;
    return number(text) ? text : none;
}

/// Visits the walks of a person that have only ends, no edges.
void for_each_open_walk(Element& person, const std::function<void(Element&, const WalkKey&)>& take) {
    std::string position = number_text(person.text("departPos"));
    for (Element& stage : person.children) {
        if (stage.name == "stop") continue;
        const std::string arrival = number_text(stage.text("arrivalPos"));
        if (stage.name == "walk" && stage.has("from"))
            take(stage, {stage.text("from"), stage.text("to"), position, arrival});
        position = arrival;
    }
}

std::string walk_xml(std::size_t row, const WalkKey& key) {
    const auto& [from, to, depart, arrival] = key;
    Element walk;
    walk.name = "walk";
    walk.attributes = {{"from", from}, {"to", to}};
    if (!arrival.empty()) walk.set("arrivalPos", arrival);
    Element person;
    person.name = "person";
    person.attributes = {{"id", std::to_string(row)}, {"depart", "0"}};
    if (!depart.empty()) person.set("departPos", depart);
    person.children = {walk};
    return person.xml();
}

/// Fills in the edges that duarouter finds.
void ask_duarouter(const Import& import, const std::filesystem::path& network_file,
                   std::map<WalkKey, std::string>& ways) {
    std::string xml = "<routes>\n";
    std::vector<std::string*> rows;
    for (auto& [key, way] : ways) {
        xml += walk_xml(rows.size(), key);
        rows.push_back(&way);
    }
    const std::filesystem::path walks = import.work / "walks.xml";
    const std::filesystem::path found = import.work / "walked.xml";
    const std::filesystem::path log = import.work / "walks.log";
    core::write_atomically(walks, xml + "</routes>\n");
    const Tool tool{
        "duarouter",
        {"--net-file", network_file.string(), "--route-files", walks.string(), "--output-file",
         found.string(), "--ignore-errors", "--no-warnings", "--no-step-log", "--xml-validation", "never"},
        log,
        "finding walking routes",
        "sumo"};
    if (!succeeds(tool, import.on_progress))
        throw core::InputError(core::Problem{"the walks", fmt::format("duarouter says:\n{}", complaint(log)),
                                             "walks between edges of the network", ""});
    for_each_element(found, [&](Element&& person) {
        if (person.name != "person" || person.children.empty()) return;
        *rows.at(std::stoul(person.text("id"))) = person.children.front().text("edges");
    });
}

}  // namespace

void find_walks(Import& import, std::vector<Person>& persons, const roads::Network& network,
                const std::filesystem::path& network_file) {
    std::map<WalkKey, std::string> ways;
    for (Person& person : persons)
        for_each_open_walk(person.element, [&](Element&, const WalkKey& key) { ways[key]; });
    if (ways.empty()) return;
    ask_duarouter(import, network_file, ways);
    const roads::Walkways walkways(network);
    for (auto& [key, way] : ways) {
        std::vector<core::EdgeIndex> edges;
        for (const std::string& id : words(way))
            if (const auto edge = network.find_edge(id)) edges.push_back(*edge);
        if (walkways.fault(edges)) way.clear();
    }
    std::erase_if(persons, [&](Person& person) {
        bool walks = true;
        for_each_open_walk(person.element, [&](Element& walk, const WalkKey& key) {
            walk.set("edges", ways.at(key));
            walks &= !walk.text("edges").empty();
            walk.remove("from");
            walk.remove("to");
        });
        if (!walks) import.left_out.add("persons without a walking route between their ends", person.id);
        return !walks;
    });
}

}  // namespace clearway::scenario_import::detail
