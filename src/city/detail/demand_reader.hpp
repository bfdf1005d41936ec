#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "city/detail/element.hpp"
#include "city/import.hpp"
#include "core/error.hpp"

namespace clearway::city::detail {

/// A vehicle with the edges that it drives, or with the ends of a way that is still to be found.
struct RoadUser {
    std::string id;
    std::string type;  ///< Of `Demand::types`.
    double depart_s = 0.0;
    std::vector<std::string> edges;  ///< Of a trip: from, via ..., to.
    bool is_trip = false;
    Element element;    ///< `<vehicle>` with its stops, without route, type and departure.
    std::string place;  ///< `city.rou.xml:12`
};

/// Somebody who walks.
struct Person {
    std::string id;
    std::string type;  ///< Of `Demand::person_types`.
    double depart_s = 0.0;
    Element element;    ///< As `walking_person` makes it; walks have edges, or ends to find a way between.
    std::string place;  ///< `city.rou.xml:12`
};

/// The demand of route and additional files, one vehicle each, as SUMO would make them.
struct Demand {
    std::vector<RoadUser> vehicles;               ///< In the order of the files; flows in order of departure.
    std::map<std::string, Element> types;         ///< `<vType>` by id; those of distributions too.
    std::vector<Person> persons;                  ///< Likewise.
    std::map<std::string, Element> person_types;  ///< By id, all of class pedestrian.
    std::set<std::string> types_made_pedestrian;  ///< Of them, those that named no class.
    std::vector<std::filesystem::path> unsorted;  ///< Files whose vehicles do not stand by departure.
};

/// What cannot be used, counted by what it is, with the first few by name.
class LeftOut {
  public:
    void add(const std::string& what, const std::string& example);
    std::vector<std::string> lines() const;

  private:
    struct Count {
        std::size_t number = 0;
        std::vector<std::string> examples;
    };
    std::map<std::string, Count> counts_;
};

/// Times that flows without a begin or an end take.
struct FlowTimes {
    double begin_s = 0.0;
    double end_s = 3600.0;
};

/// Collects vehicles, trips, flows, persons who only walk, routes, types and their distributions from SUMO's
/// files. What only SUMO could draw while it runs (the member of a distribution, the departures of a flow by
/// probability) is drawn by the id of the vehicle or person. The rest is counted in `left_out`: persons who
/// ride, containers, vehicles that wait for them.
class DemandReader {
  public:
    DemandReader(FlowTimes times, LeftOut& left_out) : times_(times), left_out_(left_out) {}

    /// Reads the elements of demand of a file; answers the others, for example stops and signal programs.
    std::vector<Element> read(const std::filesystem::path& file);
    /// After all files. Throws core::InputError with every problem: ids that occur twice, unknown types and
    /// routes, departures that are no times.
    Demand finish();

  private:
    struct Choice {
        std::vector<std::string> ids;
        std::vector<double> weights;
    };
    /// A vehicle, trip or flow as it was read; routes and types may be defined after it.
    struct Pending {
        Element element;
        std::filesystem::path file;
    };

    bool take(Element& element, const std::filesystem::path& file);
    void take_type(const Element& element);
    void take_distribution(const Element& element, std::map<std::string, Choice>& choices);
    /// Takes the id and the departure in s of one vehicle or person of those that an element stands for.
    using Take = std::function<void(const std::string&, double)>;
    void resolve(const Pending& pending, const Take& take);
    void resolve_flow(const Pending& pending, const Take& take);
    void resolve_person(const Pending& pending);
    void add_person(const Pending& pending, const std::string& id, double depart_s);
    bool set_type(const Element& source, Person& person);
    bool set_edges(Element& walk, const Person& person);
    void add(const Pending& pending, const std::string& id, double depart_s);
    bool note_id(const std::string& id, const std::string& place, std::map<std::string, std::string>& places);
    bool set_way(const Element& source, RoadUser& vehicle);
    bool set_type(const Element& source, RoadUser& vehicle);
    const Element* find_route(std::string id, const std::string& user, const std::string& place);
    std::vector<double> departures(const Element& flow, const std::string& place);
    std::string chosen(const Choice& choice, const std::string& id) const;
    void problem(const std::string& place, const std::string& id, std::string what, std::string allowed = "");

    FlowTimes times_;
    LeftOut& left_out_;
    Demand demand_;
    std::vector<Pending> pending_;
    std::vector<Pending> pending_persons_;
    std::map<std::string, Element> routes_;
    std::map<std::string, Choice> type_choices_;
    std::map<std::string, Choice> route_choices_;
    std::map<std::string, std::string> places_;         ///< By vehicle id.
    std::map<std::string, std::string> person_places_;  ///< By person id.
    std::vector<core::Problem> problems_;
};

}  // namespace clearway::city::detail
