#include "scenario_import/sumo/distribution.hpp"

#include <fmt/format.h>

#include "scenario_import/sumo/draw.hpp"

namespace clearway::scenario_import::detail {

std::vector<Element> Distributions::add(const Element& distribution, std::vector<std::string>* ids) {
    const std::string& own = distribution.text("id");
    std::vector<Member>& members = choices_[own];
    const std::vector<std::string> weights = words(distribution.text("probabilities"));
    for (const std::string& id : words(distribution.text(list_))) {
        const std::size_t row = members.size();
        members.push_back({id, row < weights.size() ? number(weights[row]) : std::nullopt});
    }
    std::vector<Element> defined;
    for (const Element& child : distribution.children) {
        if (child.name == "param") continue;
        const bool refers = child.has("refId");
        std::string id = child.text(refers ? "refId" : "id");
        if (id.empty()) id = fmt::format("{}#{}", own, members.size());
        members.push_back({id, number(child.text("probability"))});
        if (refers) continue;
        defined.push_back(child);
        defined.back().set("id", id);
        defined.back().place = distribution.place;
    }
    if (ids != nullptr)
        for (const Member& member : members)
            ids->push_back(member.id);
    return defined;
}

void Distributions::note_probability(const Element& member) {
    if (const auto probability = number(member.text("probability")))
        probabilities_[member.text("id")] = *probability;
}

std::vector<std::string> Distributions::members(const std::string& id) const {
    std::vector<std::string> ids;
    for (const Member& member : choices_.at(id))
        ids.push_back(member.id);
    return ids;
}

Element Distributions::element(const std::string& name, const std::string& id) const {
    std::vector<double> weights;
    for (const Member& member : choices_.at(id))
        weights.push_back(weight_of(member));
    Element element;
    element.name = name;
    element.set("id", id);
    element.set(list_, fmt::format("{}", fmt::join(members(id), " ")));
    element.set("probabilities", fmt::format("{:g}", fmt::join(weights, " ")));
    return element;
}

double Distributions::weight_of(const Member& member) const {
    if (member.weight) return *member.weight;
    const auto own = probabilities_.find(member.id);
    return own == probabilities_.end() ? 1.0 : own->second;
}

std::string Distributions::draw(const std::string& id, const std::string& user) const {
    const std::vector<Member>& members = choices_.at(id);
    if (members.empty()) return {};
    double sum = 0.0;
    for (const Member& member : members)
        sum += weight_of(member);
    double left = uniform(user, NamedDraw::member_of_distribution) * sum;
    for (std::size_t row = 0; row + 1 < members.size(); ++row) {
        if (left < weight_of(members[row])) return members[row].id;
        left -= weight_of(members[row]);
    }
    return members.back().id;
}

}  // namespace clearway::scenario_import::detail
