#include "scenario/detail/measured_persons.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "core/error.hpp"
#include "roads/walkways.hpp"
#include "scenario/detail/xml_text.hpp"

namespace clearway::scenario::detail {

namespace {

constexpr const char* prefix = "person.";

struct MeasuredWalker {
    double depart_s = 0.0;
    std::string xml;
};

class PersonsReader {
  public:
    PersonsReader(const DemandContext& context, const PlannedDemand& demand)
        : context_(context), walkways_(context.network) {
        for (const PlannedVehicle& vehicle : demand.vehicles)
            taken_.insert(vehicle.id);
        for (const traffic::EmergencyDeparture& departure : demand.emergency)
            taken_.insert(departure.id);
    }

    void read(const std::filesystem::path& file) {
        const pugi::xml_document document = load_xml(file, "a SUMO route file");
        for (const pugi::xml_node element : document.document_element().children()) {
            const std::string_view name = element.name();
            if (name == "vType")
                take_type(element);
            else if (name == "person")
                take_person(element, file);
            else if (!name.empty())
                problem(file, element, fmt::format("is a <{}>", name), "<vType> and <person>");
        }
    }

    std::string finish() {
        if (!problems_.empty()) throw core::InputError(problems_);
        std::ranges::stable_sort(walkers_, {}, &MeasuredWalker::depart_s);
        std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<routes>\n" + types_xml_;
        for (const MeasuredWalker& walker : walkers_)
            xml += walker.xml;
        return xml + "</routes>\n";
    }

  private:
    void take_type(pugi::xml_node type) {
        types_.insert(type.attribute("id").value());
        rename(type, "id");
        types_xml_ += element_text(type);
    }

    void take_person(pugi::xml_node person, const std::filesystem::path& file) {
        const std::string id = person.attribute("id").value();
        const char* const depart_text = person.attribute("depart").value();
        char* end = nullptr;
        const double depart_s = std::strtod(depart_text, &end);
        if (end == depart_text || *end != '\0' || !(depart_s >= 0.0))
            return problem(file, person, fmt::format("depart is \"{}\"", depart_text), "a time in s");
        if (!ids_.insert(id).second) return problem(file, person, "occurs twice", "each id once");
        if (!types_.contains(person.attribute("type").value()))
            return problem(file, person,
                           fmt::format("type \"{}\" is not defined", person.attribute("type").value()),
                           "a <vType> above it in these files");
        if (const auto fault = fault_of(person))
            return problem(
                file, person, *fault,
                "<walk edges=\"...\"> over edges open to pedestrians that meet, <ride> with from and to, and "
                "<stop>");
        if (depart_s > context_.config.time.window_s) return;
        rename(person, "type");
        do {
            rename(person, "id");
        } while (!taken_.insert(person.attribute("id").value()).second);
        walkers_.push_back({depart_s, element_text(person)});
    }

    std::optional<std::string> fault_of(pugi::xml_node person) const {
        if (!person.child("walk") && !person.child("ride")) return "neither walks nor rides";
        for (const pugi::xml_node stage : person.children()) {
            const std::string_view name = stage.name();
            if (name == "stop") continue;
            if (name == "ride") {
                for (const char* const end : {"from", "to"})
                    if (auto fault = fault_of_edge(stage.attribute(end).value())) return fault;
                continue;
            }
            if (name != "walk") return fmt::format("has a <{}>", name);
            if (auto fault = fault_of_edges(stage.attribute("edges").value())) return fault;
        }
        return std::nullopt;
    }

    std::optional<std::string> fault_of_edge(const std::string& id) const {
        const auto edge = context_.network.find_edge(id);
        if (edge && !context_.network.edge(*edge).internal) return std::nullopt;
        return fmt::format("the network has no edge \"{}\"", id);
    }

    std::optional<std::string> fault_of_edges(const std::string& text) const {
        std::istringstream words(text);
        std::vector<core::EdgeIndex> edges;
        for (std::string word; words >> word;) {
            if (auto fault = fault_of_edge(word)) return fault;
            edges.push_back(*context_.network.find_edge(word));
        }
        if (edges.empty()) return "has a walk without edges";
        return walkways_.fault(edges);
    }

    static void rename(pugi::xml_node node, const char* attribute) {
        node.attribute(attribute).set_value(
            (prefix + std::string(node.attribute(attribute).value())).c_str());
    }

    void problem(const std::filesystem::path& file, pugi::xml_node element, std::string what,
                 std::string allowed) {
        problems_.push_back(
            {fmt::format("{}: {} \"{}\"", file.string(), element.name(), element.attribute("id").value()),
             std::move(what), std::move(allowed),
             "correct the file, or import the persons of a SUMO scenario anew"});
    }

    const DemandContext& context_;
    roads::Walkways walkways_;
    std::set<std::string> taken_;  ///< Ids of vehicles, and of persons as written to the file.
    std::set<std::string> ids_;
    std::set<std::string> types_;
    std::string types_xml_;
    std::vector<MeasuredWalker> walkers_;
    std::vector<core::Problem> problems_;
};

}  // namespace

std::string measured_persons_xml(const DemandContext& context, const PlannedDemand& demand) {
    PersonsReader reader(context, demand);
    for (const std::string& path : context.config.measured->persons)
        reader.read(resolve(context.config, path));
    return reader.finish();
}

}  // namespace clearway::scenario::detail
