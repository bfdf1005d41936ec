#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/left_out.hpp"
#include "scenario_import/import.hpp"
#include "scenario_import/sumo/distribution.hpp"
#include "scenario_import/sumo/flow.hpp"

namespace clearway::scenario_import::detail {

/// The departures that a scenario takes, in times of the route files.
struct Window {
    double begin_s = 0.0;
    double length_s = 0.0;

    double end_s() const { return begin_s + length_s; }
    bool holds(double depart_s) const { return depart_s >= begin_s && depart_s < end_s(); }
};

/// A vehicle with the edges that it drives, or with the ends of a route that is still to be found.
struct RoadUser {
    std::string id;
    std::string type;  ///< Of `Demand::types`.
    double depart_s = 0.0;
    double later_s = 0.0;            ///< As `Departure::later_s`.
    std::vector<std::string> edges;  ///< Of a trip: its ends and vias, once `complete_trips` has run.
    bool is_trip = false;
    /// A trip between two edges without vias, of which SUMO can find the way again when it departs.
    bool is_routed_at_departure = false;
    /// For a trip: `<trip>` with its ends, which are edges, zones or junctions.
    Element trip;
    Element element;    ///< `<vehicle>` with its stops, without route, type and departure.
    std::string place;  ///< `city.rou.xml:12`
};

/// A person who walks, and rides with vehicles of the same files.
struct Person {
    std::string id;
    std::string type;  ///< Of `Demand::person_types`.
    double depart_s = 0.0;
    /// As `travelling_person` makes it; walks have edges, or ends between which a route is to be found.
    Element element;
    std::string place;  ///< `city.rou.xml:12`
};

/// The demand of route and additional files, one vehicle each, as SUMO would make them.
struct Demand {
    std::vector<RoadUser> vehicles;               ///< In the order of the files; flows in order of departure.
    std::map<std::string, Element> types;         ///< `<vType>` by id; those of distributions too.
    std::vector<Person> persons;                  ///< In the same order.
    std::map<std::string, Element> person_types;  ///< By id; all of class pedestrian.
    /// Lines or vehicles that persons who are left out would take; empty text: any vehicle with a line.
    std::set<std::string> lines_of_left_out;
    std::set<std::string> types_made_pedestrian;  ///< Of these, those that named no class.
    std::vector<std::filesystem::path> unsorted;  ///< Files whose vehicles are not ordered by departure.
    std::set<std::string> types_made_older;       ///< Of `types`, those with a class that SUMO 1.15 lacks.
    bool names_vehicles = false;                  ///< Vehicles that are left out count too.
    std::vector<std::string> changes;             ///< Differences between the demand and the files, in words.
};

/// Collects vehicles, trips, flows, persons, routes, types and their distributions from SUMO's
/// files. What SUMO would draw while it runs (members of distributions, departures of flows by probability,
/// extra copies by scale) is drawn here, keyed by the id of the vehicle or person. The rest is counted in
/// `left_out`: persons who may ride or take taxis, containers, vehicles that wait for them.
class DemandReader {
  public:
    /// `scale` is SUMO's option: number of copies of each vehicle and person.
    DemandReader(FlowTimes times, double scale, LeftOut& left_out)
        : times_(times), scale_(scale), left_out_(left_out) {}

    /// Reads the demand elements of a file; returns the others, for example stops and signal programs.
    std::vector<Element> read(const std::filesystem::path& file);
    /// `elements` with what they name: routes and their distributions, behind the stops that these may name
    /// and before all else; in place of distributions of types, their members. After all files.
    std::vector<Element> with_named(std::vector<Element> elements) const;
    /// After all files. Throws core::InputError with every problem: ids that occur twice, unknown types and
    /// routes, departures that are not times.
    Demand finish();

  private:
    /// A vehicle, trip or flow as it was read; routes and types may be defined after it.
    struct Pending {
        Element element;
        std::filesystem::path file;
    };

    bool take(Element& element, const std::filesystem::path& file);
    void take_type(const Element& element);
    void take_distribution(const Element& element, Distributions& distributions);
    /// Takes the id and departure of one of the vehicles or persons that an element stands for.
    using Take = std::function<void(const std::string&, const Departure&)>;
    void resolve(const Pending& pending, const Take& take);
    void resolve_flow(const Pending& pending, const Take& take);
    std::string type_of(const Element& source, const char* otherwise, const std::string& id) const;
    void undefined_type(const std::string& type, const std::string& id, const std::string& place);
    double scale_of_type(const Element& source, const std::string& id) const;
    void report_types();
    void resolve_person(const Pending& pending);
    void add_person(const Pending& pending, const std::string& id, double depart_s);
    bool set_type(const Element& source, Person& person);
    bool set_edges(Element& walk, const Person& person);
    void add(const Pending& pending, const std::string& id, const Departure& departure);
    bool note_id(const std::string& id, const std::string& place, std::map<std::string, std::string>& places);
    bool set_way(const Element& source, RoadUser& vehicle);
    void set_trip(const Element& source, RoadUser& vehicle);
    std::optional<Element> inline_route(const Element& source, const RoadUser& vehicle);
    bool set_type(const Element& source, RoadUser& vehicle);
    std::vector<Element> routes_of_rerouters(const std::vector<Element>& elements) const;
    const Element* find_route(std::string id, const std::string& user, const std::string& place);
    void problem(const std::string& place, const std::string& id, std::string what, std::string allowed = "");

    FlowTimes times_;
    double scale_;
    LeftOut& left_out_;
    Demand demand_;
    std::vector<Pending> pending_;
    std::vector<Pending> pending_persons_;
    std::map<std::string, Element> routes_;
    std::map<std::string, double> type_scales_;         ///< For types that state one.
    std::map<std::string, std::string> newer_classes_;  ///< By type, if it had one.
    Distributions type_choices_{"vTypes"};
    Distributions route_choices_{"routes"};
    std::size_t renamed_ = 0;                    ///< Number of vehicles that had ids of Clearway's own.
    std::map<std::string, std::string> places_;  ///< By vehicle id.
    std::map<std::string, std::string> person_places_;  ///< By person id.
    std::vector<core::Problem> problems_;
    std::set<std::string> named_problems_;
};

/// `bus` for `bus.12`: a problem that all vehicles of a flow share is reported once.
std::string without_number(const std::string& id);

}  // namespace clearway::scenario_import::detail
