#include "scenario_import/detail/source.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/near_file.hpp"
#include "core/open_file.hpp"
#include "scenario/map_age.hpp"
#include "scenario_import/detail/element.hpp"
#include "scenario_import/detail/packed_file.hpp"

namespace clearway::scenario_import::detail {

namespace {

constexpr const char* what_is_read =
    ".osm, .osm.gz, .osm.bz2, .osm.pbf, .net.xml, .net.xml.gz, .sumocfg, or route and additional files";

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what,
                         const std::string& cure) {
    throw core::InputError(core::Problem{file.string(), what, what_is_read, cure});
}

/// The name of the first element, in lower case; `!doctype html` for a web page; empty if there is none.
std::string first_element(std::string_view text) {
    while (true) {
        const std::size_t open = text.find('<');
        if (open == std::string_view::npos) return {};
        text.remove_prefix(open + 1);
        if (text.starts_with("!--")) {
            const std::size_t end = text.find("-->");
            if (end == std::string_view::npos) return {};
            text.remove_prefix(end);
        } else if (text.starts_with('!')) {
            const std::string declaration = lower(text.substr(0, text.find('>')));
            if (declaration.starts_with("!doctype html")) return declaration;
        } else if (!text.starts_with('?')) {
            return lower(text.substr(0, text.find_first_of(" \t\r\n/>")));
        }
    }
}

/// The beginning of a file, unpacked.
std::string head_of(PackedFile& stream) {
    std::string head(std::size_t{1} << 16, '\0');
    head.resize(stream.read(head));
    return head;
}

bool is_pbf(std::string_view head) {
    constexpr std::size_t block_header = 32;
    return head.substr(0, block_header).find("OSMHeader") != std::string_view::npos;
}

/// The last bytes of a file, unpacked.
std::string end_of(const std::filesystem::path& file) {
    constexpr std::size_t enough = 4096;
    PackedFile stream(file);
    std::string end;
    if (stream.packing() == Packing::none) {
        const std::uintmax_t size = std::filesystem::file_size(file);
        core::OpenFile plain(file);
        plain.skip(size - std::min<std::uintmax_t>(size, enough));
        plain.read([&](std::string_view piece) { end += piece; });
        return end;
    }
    std::array<char, 1 << 16> buffer{};
    while (const std::size_t count = stream.read(buffer)) {
        end.append(buffer.data(), count);
        if (end.size() > enough) end.erase(0, end.size() - enough);
    }
    return end;
}

bool is_one_of(const std::string& element, std::initializer_list<std::string_view> names) {
    return core::contains(names, element);
}

/// `give one of its files: hello.sumocfg, ...`: what looks like the start of an import.
std::string sources_in(const std::filesystem::path& folder) {
    constexpr std::array endings = {".sumocfg", ".osm",     ".osm.gz",    ".osm.bz2",
                                    ".osm.pbf", ".net.xml", ".net.xml.gz"};
    constexpr std::size_t most = 5;
    std::vector<std::string> names;
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable)) {
        const std::string name = entry.path().filename().string();
        if (std::ranges::any_of(endings, [&](const char* ending) { return name.ends_with(ending); }))
            names.push_back(name);
    }
    if (names.empty()) return "give a file";
    std::ranges::sort(names);
    const std::size_t more = names.size() > most ? names.size() - most : 0;
    names.resize(names.size() - more);
    return fmt::format("give one of its files: {}{}", core::listed(names), more > 0 ? ", ..." : "");
}

bool has_name_of_configuration(const std::filesystem::path& file) {
    const std::string extension = lower(file.extension().string());
    return extension == ".sumocfg" || extension == ".cfg";
}

}  // namespace

SourceKind kind_of(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file))
        refuse(file, "does not exist", core::did_you_mean_file(file, "check the path"));
    if (std::filesystem::is_directory(file))
        throw core::InputError(
            {file.string(), "is a folder", "a map, a network or a SUMO configuration", sources_in(file)});
    PackedFile stream(file);
    std::string head = head_of(stream);
    if (head.empty()) refuse(file, "is empty", "download it again");
    if (is_pbf(head)) return SourceKind::map;
    const bool is_utf_16 = head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff");
    if (is_utf_16) std::erase(head, '\0');
    if (head.starts_with("PK\x03\x04"))
        refuse(file, "is a zip archive", "unpack it and give the file inside");
    const std::size_t start = head.find_first_not_of(" \t\r\n\xef\xbb\xbf\xff\xfe");
    if (start != std::string::npos && (head[start] == '{' || head[start] == '['))
        refuse(file, "is JSON", "ask the service for OSM XML");
    const std::string element = first_element(head);
    if (element.starts_with("!doctype html") || element == "html")
        refuse(file, "is a web page (HTML), not a map",
               "the download failed: open the file in a browser to see why, and download it again");
    if (is_one_of(element, {"nodes", "edges", "connections", "types"}))
        refuse(file, fmt::format("is plain XML (<{}>), of which netconvert makes a network", element),
               "make it, and import that: netconvert --node-files X.nod.xml --edge-files X.edg.xml "
               "--output-file X.net.xml");
    if (element == "osm" && is_utf_16)
        refuse(file, "is a map in UTF-16", "save it as UTF-8: iconv -f UTF-16 -t UTF-8 OLD > NEW");
    if (element == "osm") return SourceKind::map;
    if (element == "net") return SourceKind::network;
    // SUMO ignores the root element of these files; only its children matter.
    if (is_one_of(element, {"routes", "trips", "flows", "vehicles", "persons", "demand"}))
        return SourceKind::routes;
    if (is_one_of(element, {"additional", "additionals", "add", "a", "tllogics", "tls", "pois", "polys",
                            "shapes", "tazs", "vtypes", "stops", "detectors", "rerouters", "vehicletypes"}))
        return SourceKind::additional;
    if (element == "configuration" || element == "sumoconfiguration" || has_name_of_configuration(file))
        return SourceKind::configuration;
    refuse(file,
           element.empty() ? "is neither XML nor a map" : fmt::format("has the root element <{}>", element),
           "");
}

std::string map_format(const std::filesystem::path& map) {
    PackedFile stream(map);
    const Packing packing = stream.packing();
    if (is_pbf(head_of(stream))) {
        if (packing == Packing::none) return "osm.pbf";
        refuse(map, "is a PBF file that is compressed again", "unpack it");
    }
    if (packing == Packing::none) return "osm";
    return packing == Packing::gzip ? "osm.gz" : "osm.bz2";
}

std::string overpass_remark(const std::filesystem::path& map) {
    constexpr std::string_view mark = "<remark>";
    const std::string end = end_of(map);
    const std::size_t open = end.rfind(mark);
    if (open == std::string::npos) return {};
    const std::size_t first = end.find_first_not_of(" \t\r\n", open + mark.size());
    const std::size_t close = end.find("</remark>", open);
    if (first == std::string::npos || close == std::string::npos || first >= close) return {};
    const std::size_t last = end.find_last_not_of(" \t\r\n", close - 1);
    return end.substr(first, last + 1 - first);
}

std::string stated_map_date(const std::filesystem::path& map) {
    constexpr std::size_t letters_of_day = 10;
    PackedFile stream(map);
    std::string head = head_of(stream);
    head.resize(std::min({head.size(), head.find("<node"), head.find("<way")}));
    // Of Overpass, in <meta>, and of osmconvert, in <osm>.
    for (const std::string_view name : {"osm_base=", " timestamp="}) {
        const std::size_t found = head.find(name);
        if (found == std::string::npos) continue;
        const std::string day = head.substr(std::min(head.size(), found + name.size() + 1), letters_of_day);
        if (scenario::begins_with_map_date(day)) return day;
    }
    return {};
}

void refuse_bomb(const std::filesystem::path& file) {
    constexpr std::uintmax_t harmless = 100'000'000;
    constexpr std::uintmax_t largest_ratio = 250;  // Maps and routes: 10 to 40.
    PackedFile stream(file);
    if (stream.packing() == Packing::none) return;
    const std::uintmax_t packed = std::filesystem::file_size(file);
    std::array<char, 1 << 16> buffer{};
    std::uintmax_t unpacked = 0;
    while (const std::size_t count = stream.read(buffer)) {
        unpacked += count;
        if (unpacked > harmless && unpacked > largest_ratio * packed)
            refuse(file,
                   fmt::format("unpacks to more than {} times its {} bytes, which no map does", largest_ratio,
                               packed),
                   "do not trust its source");
    }
}

}  // namespace clearway::scenario_import::detail
