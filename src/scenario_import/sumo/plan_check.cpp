#include "scenario_import/sumo/plan_check.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "roads/walkways.hpp"
#include "scenario_import/sumo/person_plan.hpp"
#include "scenario_import/sumo/ways.hpp"

namespace clearway::scenario_import::detail {

namespace {

/// What is wrong, in words; nothing if all is well.
using Fault = std::optional<std::string>;

template <std::size_t count>
Fault fault_of_position(const Element& element, const char* name,
                        const std::array<const char*, count>& words) {
    const std::string& text = element.text(name);
    if (text.empty() || number(text) || core::contains(words, text)) return std::nullopt;
    return fmt::format("{} is \"{}\"", name, text);
}

Fault fault_of_positive(const Element& element, const char* name) {
    const std::string& text = element.text(name);
    if (text.empty() || number(text).value_or(0.0) > 0.0) return std::nullopt;
    return fmt::format("{} is \"{}\"", name, text);
}

Fault fault_of_time(const Element& element, const char* name) {
    const std::string& text = element.text(name);
    if (text.empty() || time_s(text).value_or(-1.0) >= 0.0) return std::nullopt;
    return fmt::format("{} is \"{}\"", name, text);
}

/// Numbers and words that SUMO rejects when it loads a plan.
Fault fault_of_values(const Element& stage) {
    constexpr std::array arrivals = {"random", "max"};
    constexpr std::array sides = {"random", "random_free", "free", "right", "center", "left"};
    constexpr std::array<const char*, 0> none = {};
    for (const Fault& fault :
         {fault_of_position(stage, "arrivalPos", arrivals), fault_of_position(stage, "departPosLat", sides),
          fault_of_position(stage, "startPos", none), fault_of_position(stage, "endPos", none),
          stage.name == "walk" ? fault_of_positive(stage, "duration") : fault_of_time(stage, "duration"),
          fault_of_positive(stage, "speed"), fault_of_time(stage, "until")})
        if (fault) return fault;
    return std::nullopt;
}

/// Where the stops of additional files are.
class StopPlaces {
  public:
    /// Edges from which a stop can be reached, its own first.
    using Edges = std::vector<core::EdgeIndex>;

    StopPlaces(const roads::Network& network, const std::vector<Element>& additional) {
        for (const Element& element : additional) {
            if (!core::contains(stop_kinds, element.name)) continue;
            Edges edges;
            add_edge(network, element.text("lane"), edges);
            for (const Element& child : element.children)
                if (child.name == "access" && !edges.empty()) add_edge(network, child.text("lane"), edges);
            if (!edges.empty()) edges_[{element.name, element.text("id")}] = std::move(edges);
        }
    }

    /// Null when there is no such stop on an edge of the network.
    const Edges* find(const char* kind, const std::string& id) const {
        const auto found = edges_.find({kind, id});
        return found == edges_.end() ? nullptr : &found->second;
    }

  private:
    static void add_edge(const roads::Network& network, const std::string& lane, Edges& edges) {
        if (const auto found = network.find_lane(lane)) edges.push_back(network.lane(*found).edge);
    }
    std::map<std::pair<std::string, std::string>, Edges> edges_;
};

/// Follows the plan of one person from stage to stage, by the rules of SUMO 1.15.
class PlanCheck {
  public:
    PlanCheck(const roads::Network& network, const roads::Walkways& walkways, const StopPlaces& stops)
        : network_(network), walkways_(walkways), stops_(stops) {}

    /// Fills in what the plan leaves implicit. Returns what is wrong with it.
    Fault settle(Element& person) {
        at_.reset();
        constexpr std::array departures = {"random", "random_free", "free", "base", "last"};
        if (auto fault = fault_of_position(person, "departPos", departures)) return fault;
        if (auto fault = fault_of_positive(person, "speedFactor")) return fault;
        for (Element& stage : person.children) {
            if (auto fault = fault_of_values(stage)) return fault;
            if (auto fault = stage.name == "walk"   ? settle_walk(stage)
                             : stage.name == "ride" ? settle_ride(stage)
                                                    : settle_stop(stage))
                return fault;
        }
        return std::nullopt;
    }

  private:
    Fault settle_walk(Element& walk) {
        const StopPlaces::Edges* stop = nullptr;
        if (const char* const kind = named_stop(walk)) {
            stop = stops_.find(kind, walk.text(kind));
            if (stop == nullptr) return no_stop(walk, kind);
        }
        return walk.has("edges") ? check_edges(walk, stop) : settle_ends(walk, stop);
    }

    Fault check_edges(Element& walk, const StopPlaces::Edges* stop) {
        std::vector<core::EdgeIndex> edges;
        for (const std::string& id : words(walk.text("edges"))) {
            const auto edge = find_edge(id);
            if (!edge) return no_edge(id);
            edges.push_back(*edge);
        }
        if (edges.empty()) return "has a walk without edges";
        if (auto fault = walkways_.fault(edges)) return fault;
        if (auto fault = fault_of_start(edges.front())) return fault;
        if (stop != nullptr && std::ranges::find(*stop, edges.back()) == stop->end())
            return fmt::format("its walk ends at edge \"{}\", its stop is on \"{}\"", id_of(edges.back()),
                               id_of(stop->front()));
        at_ = stop != nullptr ? stop->front() : edges.back();
        walk.remove("from");
        walk.remove("to");
        return std::nullopt;
    }

    Fault settle_ends(Element& walk, const StopPlaces::Edges* stop) {
        if (!walk.has("from") && at_) walk.set("from", id_of(*at_));
        if (!walk.has("to") && stop != nullptr) {
            const auto reached =
                std::ranges::find_if(*stop, [&](core::EdgeIndex edge) { return walkways_.open(edge); });
            walk.set("to", id_of(reached == stop->end() ? stop->front() : *reached));
        }
        for (const char* const name : {"from", "to"}) {
            if (!walk.has(name)) return fmt::format("has a walk without edges and without a \"{}\"", name);
            if (auto fault = fault_of_end(walk.text(name))) return fault;
        }
        if (auto fault = fault_of_start(*network_.find_edge(walk.text("from")))) return fault;
        at_ = stop != nullptr ? stop->front() : *network_.find_edge(walk.text("to"));
        return std::nullopt;
    }

    /// The ride gets `from` and `to`.
    Fault settle_ride(Element& ride) {
        if (!ride.has("from") && at_) ride.set("from", id_of(*at_));
        if (const char* const kind = named_stop(ride)) {
            const StopPlaces::Edges* const stop = stops_.find(kind, ride.text(kind));
            if (stop == nullptr) return no_stop(ride, kind);
            ride.set("to", id_of(stop->front()));
        }
        for (const char* const name : {"from", "to"}) {
            if (!ride.has(name)) return fmt::format("has a ride without a \"{}\"", name);
            if (!find_edge(ride.text(name))) return no_edge(ride.text(name));
        }
        if (at_ && id_of(*at_) != ride.text("from"))
            return fmt::format("rides from edge \"{}\" after it came to \"{}\"", ride.text("from"),
                               id_of(*at_));
        at_ = find_edge(ride.text("to"));
        return std::nullopt;
    }

    Fault settle_stop(Element& stop) {
        std::optional<core::EdgeIndex> edge;
        if (const char* const kind = named_stop(stop)) {
            const StopPlaces::Edges* const place = stops_.find(kind, stop.text(kind));
            if (place == nullptr) return no_stop(stop, kind);
            edge = place->front();
        } else {
            stop.set("friendlyPos", "true");  // SUMO aborts at a position past the end of the lane.
            if (const auto lane = network_.find_lane(stop.text("lane")))
                edge = network_.lane(*lane).edge;
            else if (!stop.has("lane"))
                edge = find_edge(stop.text("edge"));
            if (!edge)
                return fmt::format("the network has no {} \"{}\"", stop.has("lane") ? "lane" : "edge",
                                   stop.text(stop.has("lane") ? "lane" : "edge"));
        }
        if (at_ && *at_ != *edge)
            return fmt::format("stops at edge \"{}\" after a walk to \"{}\"", id_of(*edge), id_of(*at_));
        at_ = edge;
        return std::nullopt;
    }

    std::optional<core::EdgeIndex> find_edge(const std::string& id) const {
        const auto edge = network_.find_edge(id);
        return edge && !network_.edge(*edge).internal ? edge : std::nullopt;
    }
    static Fault no_edge(const std::string& id) { return fmt::format("the network has no edge \"{}\"", id); }
    Fault fault_of_end(const std::string& id) const {
        const auto edge = find_edge(id);
        return edge ? walkways_.fault(std::array{*edge}) : no_edge(id);
    }

    /// A walk starts on the edge where the previous stage ended, or at that edge's end.
    Fault fault_of_start(core::EdgeIndex start) const {
        if (!at_ || *at_ == start) return std::nullopt;
        const roads::Edge& next = network_.edge(start);
        const std::string& junction = network_.edge(*at_).to_junction;
        if (next.from_junction == junction || next.to_junction == junction) return std::nullopt;
        return fmt::format("walks on from edge \"{}\" after it came to \"{}\"", next.id, id_of(*at_));
    }

    static Fault no_stop(const Element& stage, const char* kind) {
        return fmt::format("there is no {} \"{}\" on the network", kind, stage.text(kind));
    }

    const std::string& id_of(core::EdgeIndex edge) const { return network_.edge(edge).id; }

    const roads::Network& network_;
    const roads::Walkways& walkways_;
    const StopPlaces& stops_;
    std::optional<core::EdgeIndex> at_;  ///< Where the last stage ended.
};

}  // namespace

std::vector<core::Problem> take_out_bad_persons(Demand& demand, const roads::Network& network,
                                                const std::vector<Element>& additional, LeftOut& left_out) {
    std::vector<core::Problem> problems;
    const roads::Walkways walkways(network);
    const StopPlaces stops(network, additional);
    PlanCheck check(network, walkways, stops);
    std::erase_if(demand.persons, [&](Person& person) {
        const Fault fault = check.settle(person.element);
        if (!fault) return false;
        left_out.add("persons who cannot walk as planned", fmt::format("{}: {}", person.id, *fault));
        if (problems.size() < named_problems)
            problems.push_back({fmt::format("{}: person \"{}\"", person.place, person.id), *fault,
                                "edges open to pedestrians that meet at sidewalks or crossings",
                                "correct the plan, or leave such persons out with --leave-out-bad-vehicles"});
        return true;
    });
    return problems;
}

}  // namespace clearway::scenario_import::detail
