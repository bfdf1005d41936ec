#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

/// The `<vTypeDistribution>`s or `<routeDistribution>`s of a scenario. SUMO draws their members while it
/// runs; here the draw is keyed by the id of the user.
class Distributions {
  public:
    /// `list` is the attribute that names members, `vTypes` or `routes`.
    explicit Distributions(const char* list) : list_(list) {}

    /// Takes a distribution. Returns the members that are defined in it; those without an id get one. `ids`
    /// receives the ids of all members, in order.
    std::vector<Element> add(const Element& distribution, std::vector<std::string>* ids = nullptr);
    /// Notes a member's own attribute `probability`: its weight if the distribution states none.
    void note_probability(const Element& member);
    bool holds(const std::string& id) const { return choices_.contains(id); }
    /// Ids of the members of distribution `id`, in order.
    std::vector<std::string> members(const std::string& id) const;
    /// Distribution `id` as an element `name` that refers to its members by id.
    Element element(const std::string& name, const std::string& id) const;
    /// The member of distribution `id` drawn for `user`; empty when it has none.
    std::string draw(const std::string& id, const std::string& user) const;

  private:
    struct Member {
        std::string id;
        std::optional<double> weight;
    };
    double weight_of(const Member& member) const;

    const char* list_;
    std::map<std::string, std::vector<Member>> choices_;
    std::map<std::string, double> probabilities_;
};

}  // namespace clearway::scenario_import::detail
