#include "scenario_import/osm/map.hpp"

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/machine_failure.hpp"
#include "scenario/network_document.hpp"
#include "scenario_import/detail/packed_file.hpp"
#include "scenario_import/detail/source.hpp"
#include "scenario_import/detail/tool.hpp"
#include "scenario_import/osm/original_ids.hpp"

namespace clearway::scenario_import::detail {

namespace {

[[noreturn]] void refuse_map(const std::filesystem::path& map, const std::string& what,
                             const std::string& cure) {
    throw core::InputError(core::Problem{map.string(), what, "an OpenStreetMap extract with roads", cure});
}

/// Osmium reads XML only where the root states version 0.6; netconvert ignores the version. Sets it in
/// `piece`, the first of the map. Returns whether it was another or missing.
bool set_version(std::string& piece) {
    constexpr std::string_view root = "<osm";
    constexpr std::string_view name = " version=";
    constexpr std::string_view version = "0.6";
    const std::size_t open = piece.find(root);
    if (open == std::string::npos) return false;
    const std::size_t stated = piece.substr(0, piece.find('>', open)).find(name, open);
    if (stated == std::string::npos) {
        piece.insert(open + root.size(), fmt::format("{}\"{}\"", name, version));
        return true;
    }
    const std::size_t first = stated + name.size() + 1;
    const std::size_t close = piece.find(piece[first - 1], first);
    if (close == std::string::npos || piece.substr(first, close - first) == version) return false;
    piece.replace(first, close - first, version);
    return true;
}

/// Writes an unpacked copy of `map`, in XML, with the version that osmium requires. Returns whether `map`
/// needs one.
bool copy_with_version(const std::filesystem::path& map, const std::filesystem::path& copy) {
    PackedFile stream(map);
    std::string piece(std::size_t{1} << 16, '\0');
    piece.resize(stream.read(piece));
    if (!set_version(piece)) return false;
    std::ofstream out(copy, std::ios::binary);
    while (!piece.empty() && out) {
        out << piece;
        piece.resize(std::size_t{1} << 16);
        piece.resize(stream.read(piece));
    }
    out.close();
    if (!out) throw core::cut_short(copy);
    return true;
}

/// Runs osmium on maps. Osmium goes by file name extensions, so it gets symbolic links with the right ones.
class Osmium {
  public:
    Osmium(const std::vector<std::filesystem::path>& maps, const std::filesystem::path& folder,
           const OnProgress& on_progress)
        : maps_(maps), folder_(folder), on_progress_(on_progress) {
        for (std::size_t row = 0; row < maps.size(); ++row) {
            const std::string format = map_format(maps[row]);
            links_.push_back(folder / fmt::format("map-{}.osm", row));
            if (format != "osm.pbf" && copy_with_version(maps[row], links_.back())) continue;
            links_.back().replace_extension(format);
            std::filesystem::create_symlink(std::filesystem::absolute(maps[row]), links_.back());
        }
    }

    const std::vector<std::filesystem::path>& links() const { return links_; }
    std::filesystem::path file(const std::string& name) const { return folder_ / name; }

    /// Returns whether osmium succeeds; `complaint` says why not.
    bool works(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin() + 1, {"--overwrite", "--no-progress"});
        return succeeds({"osmium", std::move(arguments), log(), "reading the map", "osmium-tool"},
                        on_progress_);
    }
    std::string complaint() const { return detail::complaint(log()); }

    /// Throws core::InputError, naming the map to blame, when osmium fails.
    void run(std::vector<std::string> arguments) const {
        if (works(std::move(arguments))) return;
        const std::size_t row = blamed();
        std::string text = complaint();
        const std::string link = links_[row].string();
        for (std::size_t at = text.find(link); at != std::string::npos; at = text.find(link))
            text.replace(at, link.size(), maps_[row].filename().string());
        refuse_map(maps_[row], fmt::format("cannot be read as a map, osmium says:\n{}", text),
                   "it may be cut short: download it again");
    }

  private:
    std::filesystem::path log() const { return folder_ / "osmium.log"; }

    /// Of several maps, the first that osmium cannot read: osmium says what is wrong, but not always where.
    std::size_t blamed() const {
        if (maps_.size() == 1) return 0;
        for (std::size_t row = 0; row < maps_.size(); ++row)
            if (!works({"cat", "-o", file("tried.osm.pbf").string(), links_[row].string()})) return row;
        return 0;
    }

    const std::vector<std::filesystem::path>& maps_;
    const std::filesystem::path& folder_;
    const OnProgress& on_progress_;
    std::vector<std::filesystem::path> links_;
};

std::filesystem::path merged(const Osmium& osmium) {
    const std::filesystem::path whole = osmium.file("merged.osm.pbf");
    const auto merge_of = [&](const std::vector<std::filesystem::path>& files) {
        std::vector<std::string> arguments = {"merge", "-o", whole.string()};
        for (const std::filesystem::path& file : files)
            arguments.push_back(file.string());
        return arguments;
    };
    if (osmium.works(merge_of(osmium.links()))) return whole;
    if (osmium.complaint().find("out of order") == std::string::npos) {
        osmium.run(merge_of(osmium.links()));
        return whole;
    }
    // Overpass writes in the order of the query, often with the ways first.
    std::vector<std::filesystem::path> sorted;
    for (const std::filesystem::path& link : osmium.links()) {
        sorted.push_back(osmium.file(fmt::format("sorted-{}.osm.pbf", sorted.size())));
        osmium.run({"sort", "-s", "multipass", "-o", sorted.back().string(), link.string()});
    }
    osmium.run(merge_of(sorted));
    return whole;
}

/// The map with its objects numbered from 1: ids of OpenStreetMap reach 10^10, and osmium's sets of ids take
/// a bit for each possible one, up to a gigabyte for a small town. Nothing for a large map, whose numbers
/// would take as much, and for one that osmium cannot number. `index` receives the former ids.
std::optional<std::filesystem::path> numbered_anew(const Osmium& osmium, const std::filesystem::path& map,
                                                   const std::filesystem::path& index) {
    constexpr std::uintmax_t largest_bytes = 100'000'000;
    if (std::filesystem::file_size(map) > largest_bytes) return std::nullopt;
    std::filesystem::create_directories(index);
    const std::filesystem::path numbered = osmium.file("numbered.osm.pbf");
    const auto works_on = [&](const std::filesystem::path& input) {
        return osmium.works({"renumber", "-i", index.string(), "-o", numbered.string(), input.string()});
    };
    if (works_on(map)) return numbered;
    const std::filesystem::path sorted = osmium.file("sorted.osm.pbf");
    if (osmium.works({"sort", "-s", "multipass", "-o", sorted.string(), map.string()}) && works_on(sorted))
        return numbered;
    return std::nullopt;
}

/// Filters what an import needs out of a map.
void filter(const Osmium& osmium, const std::filesystem::path& map, const std::filesystem::path& extract) {
    osmium.run({"tags-filter", "-o", extract.string(), map.string(), "w/highway", "n/highway",
                "r/type=restriction", "nwr/amenity=hospital,fire_station", "nwr/emergency=ambulance_station",
                "nwr/driving_side"});
}

/// SUMO's road types, then those for towns, which replace its 100 km/h on main roads.
std::string type_files() {
    const char* const set = std::getenv("SUMO_HOME");
    const std::filesystem::path folder =
        std::filesystem::path(set != nullptr && *set != '\0' ? set : "/usr/share/sumo") / "data" / "typemap";
    std::string text;
    for (const char* const name : {"osmNetconvert.typ.xml", "osmNetconvertUrbanDe.typ.xml"}) {
        const std::filesystem::path file = folder / name;
        if (!std::filesystem::exists(file))
            throw core::EnvironmentError(fmt::format(
                "no file {}. Set SUMO_HOME to SUMO's folder (Debian: /usr/share/sumo)", file.string()));
        text += (text.empty() ? "" : ",") + file.string();
    }
    return text;
}

}  // namespace

Extract extract_roads(const std::vector<std::filesystem::path>& maps, const std::filesystem::path& folder,
                      const OnProgress& on_progress) {
    const Osmium osmium(maps, folder, on_progress);
    const std::filesystem::path whole = maps.size() > 1 ? merged(osmium) : osmium.links().front();
    Extract extract{osmium.file("extract.osm"), {}};
    const std::filesystem::path index = osmium.file("ids");
    if (const auto numbered = numbered_anew(osmium, whole, index)) {
        const std::filesystem::path found = osmium.file("found.osm");
        filter(osmium, *numbered, found);
        restore_ids(found, index, extract.file);
    } else {
        filter(osmium, whole, extract.file);
    }
    extract.contents = read_map(extract.file);
    if (!extract.contents.is_sorted) {
        const std::filesystem::path sorted = osmium.file("sorted.osm");
        osmium.run({"sort", "-o", sorted.string(), extract.file.string()});
        extract = {sorted, read_map(sorted)};
    }
    if (extract.contents.roads == 0)
        refuse_map(maps.front(), "is a map without roads", "choose another extract");
    if (extract.contents.nodes == 0)
        refuse_map(maps.front(), "has roads, but not their nodes, which give their positions",
                   "ask Overpass for them too: end the query with  out body; >; out skel qt;");
    return extract;
}

std::filesystem::path build_roads(const std::filesystem::path& map, const std::filesystem::path& extract,
                                  RoadPlan plan, const std::filesystem::path& folder,
                                  const OnProgress& on_progress) {
    const std::filesystem::path network = folder / "network.net.xml";
    const std::filesystem::path log = folder / "netconvert.log";
    std::vector<std::string> arguments = {
        "--osm-files", extract.string(), "--output-file", network.string(), "--type-files", type_files(),
        // Removes nodes that only bend a road, and pieces below 5 m from a change of name or limit: vehicles
        // are longer than these edges.
        "--geometry.remove", "--geometry.remove.min-length", "5", "--junctions.join", "--roundabouts.guess",
        "--ramps.guess", "--tls.guess-signals", "--tls.discard-simple", "--tls.join", "--tls.default-type",
        "static", "--no-turnarounds.except-deadend", "--keep-edges.by-vclass", "passenger,bus",
        "--remove-edges.isolated", "--output.street-names", "--junctions.corner-detail", "5",
        "--xml-validation", "never", "--aggregate-warnings", "3"};
    if (plan.side == DrivingSide::left) arguments.emplace_back("--lefthand");
    if (plan.footways == Footways::build)
        arguments.insert(arguments.end(), {"--osm.sidewalks", "--sidewalks.guess", "--crossings.guess"});
    const Tool tool{"netconvert", std::move(arguments), log, "building the network", "sumo"};
    if (succeeds(tool, on_progress)) {
        scenario::require_whole(network);
        return network;
    }
    const std::string reason = complaint(log);
    if (reason.find("No edges loaded") != std::string::npos)
        refuse_map(map, "has no road for cars", "choose an extract with roads for cars");
    refuse_map(map, fmt::format("netconvert cannot build a network from it:\n{}", reason),
               "choose another extract");
}

}  // namespace clearway::scenario_import::detail
