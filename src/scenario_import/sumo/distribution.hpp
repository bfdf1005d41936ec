#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

/// The `<vTypeDistribution>` or `<routeDistribution>` of a scenario. SUMO draws their members while it runs;
/// here the id of who has one draws.
class Distributions {
  public:
    /// `list` is the attribute that names members, `vTypes` or `routes`.
    explicit Distributions(const char* list) : list_(list) {}

    /// Takes a distribution. Answers the members that are defined in it, each with an id, one that is made
    /// where it has none; `ids` gets the ids of all members, in their order.
    std::vector<Element> add(const Element& distribution, std::vector<std::string>* ids = nullptr);
    /// What a member counts where its distribution does not say: attribute `probability` of its own.
    void note_probability(const Element& member);
    bool holds(const std::string& id) const { return choices_.contains(id); }
    /// The member of distribution `id` that is `user`'s; empty when it has none.
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
