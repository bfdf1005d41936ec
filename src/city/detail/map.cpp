#include "city/detail/map.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>

#include <fmt/format.h>

#include "city/detail/element.hpp"
#include "city/detail/tool.hpp"
#include "core/error.hpp"

namespace clearway::city::detail {

namespace {

using scenario::SiteKind;

std::string tag(const Element& element, std::string_view key) {
    for (const Element& child : element.children)
        if (child.name == "tag" && child.text("k") == key) return child.text("v");
    return {};
}

std::optional<SiteKind> site_kind(const Element& element) {
    const std::string amenity = tag(element, "amenity");
    if (amenity == "hospital") return SiteKind::hospital;
    if (tag(element, "emergency") == "ambulance_station") return SiteKind::ambulance_station;
    if (amenity == "fire_station") return SiteKind::fire_station;
    return std::nullopt;
}

/// Places of nodes, by their ids, which a site or a road stands for.
using Nodes = std::unordered_map<std::string, roads::Coordinates>;

struct PendingSite {
    std::size_t row;   ///< In MapContents::sites.
    std::string node;  ///< That stands for it.
};

class MapReader {
  public:
    void take(const Element& element) {
        if (element.name == "node") take_node(element);
        if (element.name == "way") take_way(element);
        if (element.name == "relation") take_relation(element);
        const std::string side = tag(element, "driving_side");
        if (side == "left" || side == "right") contents_.driving_side = side;
    }

    MapContents finish() {
        for (const PendingSite& site : pending_) {
            const auto node = nodes_.find(site.node);
            if (node != nodes_.end()) {
                contents_.sites[site.row].place = node->second;
                known_[site.row] = true;
            }
        }
        std::vector<MapSite> placed;
        for (std::size_t row = 0; row < contents_.sites.size(); ++row)
            if (known_[row]) placed.push_back(std::move(contents_.sites[row]));
        contents_.sites = std::move(placed);
        const auto count = static_cast<double>(std::max<std::size_t>(1, nodes_.size()));
        contents_.centre = {longitude_sum_ / count, latitude_sum_ / count};
        return std::move(contents_);
    }

  private:
    void take_node(const Element& element) {
        const auto longitude = number(element.text("lon"));
        const auto latitude = number(element.text("lat"));
        if (!longitude || !latitude) return;
        const roads::Coordinates place{*longitude, *latitude};
        longitude_sum_ += place.longitude_deg;
        latitude_sum_ += place.latitude_deg;
        nodes_[element.text("id")] = place;
        if (const auto kind = site_kind(element)) {
            contents_.sites.push_back({*kind, tag(element, "name"), place});
            known_.push_back(true);
        }
    }

    void take_way(const Element& element) {
        const auto first =
            std::ranges::find_if(element.children, [](const Element& child) { return child.name == "nd"; });
        if (first == element.children.end()) return;
        if (!tag(element, "highway").empty()) ++contents_.roads;
        first_node_[element.text("id")] = first->text("ref");
        if (const auto kind = site_kind(element))
            add_pending(*kind, tag(element, "name"), first->text("ref"));
    }

    void take_relation(const Element& element) {
        const auto kind = site_kind(element);
        if (!kind) return;
        for (const Element& member : element.children) {
            if (member.name != "member" || member.text("type") != "way") continue;
            const auto way = first_node_.find(member.text("ref"));
            if (way != first_node_.end()) return add_pending(*kind, tag(element, "name"), way->second);
        }
    }

    void add_pending(SiteKind kind, std::string name, std::string node) {
        pending_.push_back({contents_.sites.size(), std::move(node)});
        contents_.sites.push_back({kind, std::move(name), {}});
        known_.push_back(false);
    }

    MapContents contents_;
    std::vector<bool> known_;  ///< By site: its place is known.
    std::vector<PendingSite> pending_;
    Nodes nodes_;
    std::unordered_map<std::string, std::string> first_node_;  ///< By way.
    double longitude_sum_ = 0.0, latitude_sum_ = 0.0;
};

[[noreturn]] void refuse(const std::filesystem::path& map, const std::string& what, const std::string& cure) {
    throw core::InputError(core::Problem{map.string(), what, "an OpenStreetMap extract with roads", cure});
}

void run_osmium(std::vector<std::string> arguments, const std::filesystem::path& map,
                const std::filesystem::path& log, const OnProgress& on_progress) {
    arguments.insert(arguments.begin() + 1, {"--overwrite", "--no-progress"});
    if (!succeeds({"osmium", std::move(arguments), log, "reading the map", "osmium-tool"}, on_progress))
        refuse(map, fmt::format("cannot be read as a map, osmium says:\n{}", complaint(log)),
               "it may be cut short: download it again");
}

}  // namespace

std::filesystem::path extract_roads(const std::vector<std::filesystem::path>& maps,
                                    const std::filesystem::path& folder, const OnProgress& on_progress) {
    const std::filesystem::path log = folder / "osmium.log";
    std::filesystem::path whole = maps.front();
    if (maps.size() > 1) {
        whole = folder / "merged.osm.pbf";
        std::vector<std::string> arguments = {"merge", "-o", whole.string()};
        for (const std::filesystem::path& map : maps)
            arguments.push_back(map.string());
        run_osmium(std::move(arguments), maps.front(), log, on_progress);
    }
    const std::filesystem::path extract = folder / "extract.osm";
    run_osmium({"tags-filter", "-o", extract.string(), whole.string(), "w/highway", "n/highway",
                "r/type=restriction", "nwr/amenity=hospital,fire_station", "nwr/emergency=ambulance_station",
                "nwr/driving_side"},
               maps.front(), log, on_progress);
    return extract;
}

MapContents read_map(const std::filesystem::path& extract) {
    MapReader reader;
    for_each_element(extract, [&](Element&& element) { reader.take(element); });
    return reader.finish();
}

std::filesystem::path build_roads(const std::filesystem::path& map, const std::filesystem::path& extract,
                                  RoadPlan plan, const std::filesystem::path& folder,
                                  const OnProgress& on_progress) {
    const std::filesystem::path network = folder / "network.net.xml";
    const std::filesystem::path log = folder / "netconvert.log";
    std::vector<std::string> arguments = {
        "--osm-files", extract.string(), "--output-file", network.string(),
        // Nodes that only bend a road, and pieces below 5 m that a change of
        // name or limit cuts off: vehicles are longer than these edges.
        "--geometry.remove", "--geometry.remove.min-length", "5", "--junctions.join", "--roundabouts.guess",
        "--ramps.guess", "--tls.guess-signals", "--tls.discard-simple", "--tls.join", "--tls.default-type",
        "static", "--no-turnarounds.except-deadend", "--keep-edges.by-vclass", "passenger,bus",
        "--remove-edges.isolated", "--output.street-names", "--junctions.corner-detail", "5",
        "--xml-validation", "never", "--aggregate-warnings", "3"};
    if (plan.side == DrivingSide::left) arguments.emplace_back("--lefthand");
    if (plan.footways == Footways::build)
        arguments.insert(arguments.end(), {"--osm.sidewalks", "--sidewalks.guess", "--crossings.guess"});
    const Tool tool{"netconvert", std::move(arguments), log, "building the network", "sumo"};
    if (succeeds(tool, on_progress)) return network;
    const std::string reason = complaint(log);
    if (reason.find("No edges loaded") != std::string::npos)
        refuse(map, "has no road for cars", "choose an extract with roads for cars");
    refuse(map, fmt::format("netconvert makes no network of it:\n{}", reason), "choose another extract");
}

}  // namespace clearway::city::detail
