#include "scenario_import/sumo/persons.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/files.hpp"
#include "scenario_import/sumo/walks.hpp"

namespace clearway::scenario_import::detail {

namespace {

bool is_stop(const Element& stage) {
    return stage.name == "stop";
}

/// Cuts the part of a plan that a run cannot show: everything from a stop that is sure to last beyond
/// `end_s`, and stops at the end. Otherwise a run would wait for people at work. Returns whether anything was
/// cut.
bool trim(Person& person, double end_s) {
    std::vector<Element>& plan = person.element.children;
    const std::size_t before = plan.size();
    double earliest_s = person.depart_s;
    const auto lasting = std::ranges::find_if(plan, [&](const Element& stage) {
        if (!is_stop(stage)) return false;
        earliest_s += time_s(stage.text("duration")).value_or(0.0);
        earliest_s = std::max(earliest_s, time_s(stage.text("until")).value_or(0.0));
        return earliest_s > end_s;
    });
    plan.erase(lasting, plan.end());
    while (!plan.empty() && is_stop(plan.back()))
        plan.pop_back();
    return plan.size() < before;
}

void keep_window(const Window& window, std::vector<Person>& persons, Findings& findings) {
    const std::size_t all = persons.size();
    std::erase_if(persons, [&](const Person& person) { return !window.holds(person.depart_s); });
    if (persons.size() < all)
        findings.changes.push_back(
            fmt::format("of {} persons the {} that depart from {:.0f} s to {:.0f} s are taken", all,
                        persons.size(), window.begin_s, window.end_s()));
}

void trim_plans(std::vector<Person>& persons, double end_s, Import& import) {
    const auto trimmed = std::ranges::count_if(persons, [&](Person& person) { return trim(person, end_s); });
    if (trimmed > 0)
        import.findings.changes.push_back(
            fmt::format("the plans of {} persons end with the last walk that a run can see", trimmed));
    std::erase_if(persons, [&](const Person& person) {
        if (!person.element.children.empty()) return false;
        import.left_out.add("persons who depart after the end of a run", person.id);
        return true;
    });
}

/// The types that are in use.
std::string types_xml(const Demand& demand, Findings& findings) {
    std::set<std::string> used;
    for (const Person& person : demand.persons)
        used.insert(person.type);
    std::string xml;
    for (const std::string& id : used) {
        xml += demand.person_types.at(id).xml();
        if (demand.types_made_pedestrian.contains(id))
            findings.changes.push_back(fmt::format("type \"{}\" of persons gets the class pedestrian", id));
    }
    return xml;
}

}  // namespace

void add_persons(Import& import, Demand& demand, const roads::Network& network, const Window& window,
                 scenario::ScenarioConfig& config) {
    std::vector<Person>& persons = demand.persons;
    keep_window(window, persons, import.findings);
    trim_plans(persons, window.begin_s + config.time.horizon_s, import);
    find_walks(import, persons, network, import.scenario / config.network.file);
    if (persons.empty()) return;
    std::ranges::stable_sort(persons, {}, &Person::depart_s);
    std::string xml = types_xml(demand, import.findings);
    for (Person& person : persons)
        xml += departing_xml(std::move(person.element), window.begin_s,
                             {person.id, person.type, person.depart_s});
    import.findings.persons = persons.size();
    config.measured->persons = {"persons.rou.xml"};
    core::write_atomically(import.scenario / config.measured->persons.front(), file_text("routes", xml));
}

}  // namespace clearway::scenario_import::detail
