#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace clearway::scenario {

/// Two ambulance stations: `east` is nearer to `place` in a straight line, but its way leads round by
/// `detour`; `west` is there first by `straight`, which an incident may close. `island` leads nowhere.
inline void write_called_roads(
    const std::function<std::filesystem::path(const std::string&, const std::string&)>& write) {
    write("called.nod.xml",
          "<nodes><node id=\"a\" x=\"0\" y=\"0\"/><node id=\"b\" x=\"300\" y=\"0\"/>"
          "<node id=\"m\" x=\"1000\" y=\"0\"/><node id=\"p\" x=\"1000\" y=\"600\"/>"
          "<node id=\"e\" x=\"1600\" y=\"0\"/><node id=\"f\" x=\"1300\" y=\"0\"/>"
          "<node id=\"d\" x=\"1300\" y=\"-900\"/><node id=\"i\" x=\"0\" y=\"900\"/>"
          "<node id=\"j\" x=\"400\" y=\"900\"/></nodes>\n");
    write("called.edg.xml",
          "<edges><edge id=\"west\" from=\"a\" to=\"b\" speed=\"20\"/>"
          "<edge id=\"straight\" from=\"b\" to=\"m\" speed=\"20\"/>"
          "<edge id=\"east\" from=\"e\" to=\"f\" speed=\"20\"/>"
          "<edge id=\"detour\" from=\"f\" to=\"d\" speed=\"20\"/>"
          "<edge id=\"back\" from=\"d\" to=\"m\" speed=\"20\"/>"
          "<edge id=\"place\" from=\"m\" to=\"p\" speed=\"20\"/>"
          "<edge id=\"island\" from=\"i\" to=\"j\" speed=\"20\"/></edges>\n");
}

inline constexpr const char* called_head =
    "name = \"called\"\nversion = \"test\"\n[network]\nnodes = \"called.nod.xml\"\n"
    "edges = \"called.edg.xml\"\n[time]\nwarm_up_s = 10.0\nwindow_s = 60.0\nhorizon_s = 600.0\n"
    "[demand]\nhuman = 4\n[[flow]]\nfrom = \"west\"\nto = \"place\"\n"
    "[[emergency_site]]\nkind = \"ambulance_station\"\nedge = \"west\"\nname = \"West\"\n"
    "[[emergency_site]]\nkind = \"ambulance_station\"\nedge = \"east\"\nunits = 2\n";

}  // namespace clearway::scenario
