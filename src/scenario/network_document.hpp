#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include <pugixml.hpp>

#include "core/units.hpp"

namespace clearway::scenario {

/// A SUMO network file as XML, for changes that netconvert cannot make without touching the geometry.
/// Comments are dropped, because netconvert writes time, options and paths into one. Holds the whole file in
/// memory.
class NetworkDocument {
  public:
    /// Reads `.net.xml` or `.net.xml.gz`. Throws core::InputError when it is missing, not XML or not a
    /// network.
    explicit NetworkDocument(const std::filesystem::path& file);

    /// Removes the vehicle classes that netconvert 1.18 and later write but SUMO 1.15 rejects.
    NetworkDocument& without_newer_classes();
    /// Number of class lists that `without_newer_classes` changed.
    int repaired_lists() const { return repaired_lists_; }
    /// Opens everything that is open to cars to class `emergency` too. Returns the number of lists changed.
    int admit_emergency();
    /// Makes edges whose tracks or lanes also lead back (attribute `bidi`) edges of their own where one of
    /// the two has several lanes: SUMO 1.15 aborts there (assertion in MSLane::getBidiLane). Returns the
    /// number of edges outside junctions.
    int part_two_way_edges();
    /// Whether there is an edge outside junctions.
    bool has_edges() const;
    /// Attribute of the root element, such as `version`; empty if there is none.
    std::string attribute(const char* name) const;
    /// Gives signal programs without `type` the one that netconvert and this project assume, `static`:
    /// SUMO 1.15 does not know their signals.
    void name_controllers();
    /// Lowers the speed limit of each faster lane to `limit`.
    void limit_speed(core::MetresPerSecond limit);
    /// Ids of the edges outside junctions.
    std::set<std::string> edges() const;
    /// Multiplies the speed limit of each lane by the factor of its edge, inside junctions too.
    void scale_speeds(const std::function<double(const std::string& edge)>& factor_of);
    /// Shifts the offsets of signal programs so that at time 0 they are where they were at `begin_s`.
    void begin_programs_at(double begin_s);
    /// Puts `program`, the XML of a `<tlLogic>`, in place of the programs of signal `id`. Returns false when
    /// there is no such signal.
    bool replace_programs(const std::string& id, const std::string& program);
    std::string text() const;

  private:
    pugi::xml_document document_;
    int repaired_lists_ = 0;
};

/// Throws core::EnvironmentError unless `file` ends as a network does. Netconvert says nothing when it could
/// not write all of it.
void require_whole(const std::filesystem::path& file);

}  // namespace clearway::scenario
