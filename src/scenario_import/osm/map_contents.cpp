#include "scenario_import/osm/map_contents.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "scenario/map_age.hpp"
#include "scenario_import/detail/element.hpp"

namespace clearway::scenario_import::detail {

namespace {

using roads::Coordinates;
using scenario::SiteKind;

constexpr double degree = std::numbers::pi / 180.0;

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

bool is_for_cars(std::string_view highway) {
    constexpr std::string_view link = "_link";
    if (highway.ends_with(link)) highway.remove_suffix(link.size());
    constexpr std::array classes = {"motorway", "trunk",        "primary",     "secondary",
                                    "tertiary", "unclassified", "residential", "living_street"};
    return core::contains(classes, highway);
}

/// Whether netconvert 1.15 understands a limit: a number, also with mph or km/h; a few words; the rule of a
/// country that it lists.
bool is_limit(const std::string& text) {
    constexpr std::array words = {"none", "no", "walk"};
    if (core::contains(words, text)) return true;
    constexpr std::array lands = {"AT", "AU", "BE", "CZ", "DE", "DK", "EE", "ES", "FR", "GB", "HU",
                                  "IT", "JP", "LT", "NO", "ON", "PT", "RO", "RS", "RU", "UK", "UZ"};
    if (text.size() > 3 && text[2] == ':') return core::contains(lands, text.substr(0, 2));
    return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0 &&
           text.find(';') == std::string::npos;
}

bool has_limit(const Element& way) {
    return std::ranges::any_of(std::array{"maxspeed", "maxspeed:forward", "maxspeed:backward"},
                               [&](const char* key) { return is_limit(tag(way, key)); });
}

/// Approximate distance along the ground, on a sphere.
double distance_km(const Coordinates& from, const Coordinates& to) {
    constexpr double earth_km = 6371.0;
    const double north = (to.latitude_deg - from.latitude_deg) * degree;
    const double east = std::remainder(to.longitude_deg - from.longitude_deg, 360.0) * degree *
                        std::cos(from.latitude_deg * degree);
    return earth_km * std::hypot(north, east);
}

struct PendingSite {
    std::size_t row;   ///< In MapContents::sites.
    std::string node;  ///< Node that represents it.
};

class MapReader {
  public:
    void take(const Element& element) {
        constexpr std::size_t letters_of_day = 10;
        const std::string day = element.text("timestamp").substr(0, letters_of_day);
        if (day > contents_.newest && scenario::begins_with_map_date(day)) contents_.newest = day;
        if (element.name == "node") take_node(element);
        if (element.name == "way") take_way(element);
        if (element.name == "relation") take_relation(element);
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
        contents_.nodes = nodes_.size();
        const auto count = static_cast<double>(std::max<std::size_t>(1, nodes_.size()));
        contents_.centre = {std::atan2(east_sum_, north_sum_) / degree, latitude_sum_ / count};
        return std::move(contents_);
    }

  private:
    enum class Rank : std::uint8_t { node, way, relation };

    void note_order(Rank rank) {
        if (rank < last_) contents_.is_sorted = false;
        last_ = rank;
    }

    void take_node(const Element& element) {
        note_order(Rank::node);
        const auto longitude = number(element.text("lon"));
        const auto latitude = number(element.text("lat"));
        if (!longitude || !latitude) return;
        const Coordinates place{*longitude, *latitude};
        // Mean on the circle, so that a town at the antimeridian does not get a mean longitude of 0.
        east_sum_ += std::sin(place.longitude_deg * degree);
        north_sum_ += std::cos(place.longitude_deg * degree);
        latitude_sum_ += place.latitude_deg;
        nodes_[element.text("id")] = place;
        if (tag(element, "highway") == "traffic_signals") contents_.signals.push_back(place);
        if (const auto kind = site_kind(element)) {
            contents_.sites.push_back({*kind, tag(element, "name"), place});
            known_.push_back(true);
        }
    }

    void take_way(const Element& element) {
        note_order(Rank::way);
        const auto first =
            std::ranges::find_if(element.children, [](const Element& child) { return child.name == "nd"; });
        if (first == element.children.end()) return;
        const std::string highway = tag(element, "highway");
        if (!highway.empty()) {
            ++contents_.roads;
            count_side(element, contents_.sides_of_roads);
        }
        if (is_for_cars(highway)) measure(element);
        first_node_[element.text("id")] = first->text("ref");
        if (const auto kind = site_kind(element))
            add_pending(*kind, tag(element, "name"), first->text("ref"));
    }

    void measure(const Element& way) {
        double length_km = 0.0;
        const Coordinates* last = nullptr;
        for (const Element& child : way.children) {
            if (child.name != "nd") continue;
            const auto node = nodes_.find(child.text("ref"));
            if (node == nodes_.end()) continue;
            if (last != nullptr) length_km += distance_km(*last, node->second);
            last = &node->second;
        }
        contents_.car_roads_km += length_km;
        if (has_limit(way)) return;
        contents_.unlimited_km += length_km;
        contents_.unlimited_classes.insert(tag(way, "highway"));
    }

    void take_relation(const Element& element) {
        note_order(Rank::relation);
        if (!tag(element, "boundary").empty()) count_side(element, contents_.sides_of_lands);
        const auto kind = site_kind(element);
        if (!kind) return;
        for (const Element& member : element.children) {
            if (member.name != "member" || member.text("type") != "way") continue;
            const auto way = first_node_.find(member.text("ref"));
            if (way != first_node_.end()) return add_pending(*kind, tag(element, "name"), way->second);
        }
    }

    static void count_side(const Element& element, SideTags& sides) {
        const std::string side = tag(element, "driving_side");
        if (side == "left") ++sides.left;
        if (side == "right") ++sides.right;
    }

    void add_pending(SiteKind kind, std::string name, std::string node) {
        pending_.push_back({contents_.sites.size(), std::move(node)});
        contents_.sites.push_back({kind, std::move(name), {}});
        known_.push_back(false);
    }

    MapContents contents_;
    Rank last_ = Rank::node;
    std::vector<bool> known_;  ///< By site: whether its place is known.
    std::vector<PendingSite> pending_;
    std::unordered_map<std::string, Coordinates> nodes_;       ///< By id.
    std::unordered_map<std::string, std::string> first_node_;  ///< By way.
    double east_sum_ = 0.0, north_sum_ = 0.0, latitude_sum_ = 0.0;
};

}  // namespace

MapContents read_map(const std::filesystem::path& extract) {
    MapReader reader;
    for_each_element(extract, [&](Element&& element) { reader.take(element); });
    return reader.finish();
}

}  // namespace clearway::scenario_import::detail
