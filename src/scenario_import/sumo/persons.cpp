#include "scenario_import/sumo/persons.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "core/files.hpp"
#include "scenario_import/sumo/stop.hpp"
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
        findings.changes.push_back(fmt::format("of {} the {} that depart from {:.0f} s to {:.0f} s are taken",
                                               core::counted(all, "person"), persons.size(), window.begin_s,
                                               window.end_s()));
}

void trim_plans(std::vector<Person>& persons, double end_s, Import& import) {
    const auto trimmed = std::ranges::count_if(persons, [&](Person& person) { return trim(person, end_s); });
    if (trimmed > 0)
        import.findings.changes.push_back(
            fmt::format("the plans of {} end with the last walk or ride that a run can see",
                        core::counted(static_cast<std::size_t>(trimmed), "person")));
    std::erase_if(persons, [&](const Person& person) {
        if (!person.element.children.empty()) return false;
        import.left_out.add("persons who depart after the end of a run", person.id);
        return true;
    });
}

/// The vehicles that persons can ride with.
class Rides {
  public:
    Rides(const std::vector<RoadUser>& vehicles, const std::vector<Element>& additional) {
        const StopEdges places(additional);
        for (const RoadUser& vehicle : vehicles) {
            Ride ride{vehicle.id, vehicle.element.text("line"), {}};
            for (const Element& child : vehicle.element.children)
                if (is_stop(child)) ride.edges.push_back(places.edge_of(child));
            if (ride.edges.empty()) continue;
            ride.edges.push_back(vehicle.edges.back());
            rides_.push_back(std::move(ride));
        }
    }

    /// Whether one of them takes a person along.
    bool take(const Element& stage) const {
        const std::vector<std::string> lines = words(stage.text("lines"));
        return std::ranges::any_of(rides_, [&](const Ride& ride) {
            const auto on = std::ranges::find(ride.edges, stage.text("from"));
            return (lines.empty() || std::ranges::any_of(lines,
                                                         [&](const std::string& line) {
                                                             return line == "ANY" || ride.answers_to(line);
                                                         })) &&
                   on != ride.edges.end() &&
                   std::find(on + 1, ride.edges.end(), stage.text("to")) != ride.edges.end();
        });
    }
    /// Number of those that answer to one of `lines`; an empty text stands for any line.
    std::size_t count(const std::set<std::string>& lines) const {
        return static_cast<std::size_t>(std::ranges::count_if(rides_, [&](const Ride& ride) {
            return std::ranges::any_of(lines, [&](const std::string& line) {
                return line.empty() ? !ride.line.empty() : ride.answers_to(line);
            });
        }));
    }

  private:
    struct Ride {
        std::string id;
        std::string line;
        std::vector<std::string> edges;  ///< Of its stops, then the last of its route.

        bool answers_to(const std::string& word) const { return word == id || word == line; }
    };
    std::vector<Ride> rides_;
};

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

void check_rides(Import& import, Demand& demand, const std::vector<Element>& additional,
                 const Window& window) {
    const Rides rides(demand.vehicles, additional);
    std::erase_if(demand.persons, [&](const Person& person) {
        const auto waits = [&](const Element& stage) { return stage.name == "ride" && !rides.take(stage); };
        if (!window.holds(person.depart_s) || std::ranges::none_of(person.element.children, waits))
            return false;
        import.left_out.add("persons whose vehicle does not come in that time", person.id);
        return true;
    });
    if (const std::size_t emptier = rides.count(demand.lines_of_left_out); emptier > 0)
        import.findings.changes.push_back(
            fmt::format("{} may wait less at stops than in the scenario, because passengers are left out",
                        core::counted(emptier, "vehicle")));
}

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
