#pragma once

#include <filesystem>
#include <string>

#include <pugixml.hpp>

#include "core/units.hpp"

namespace clearway::scenario::detail {

/// A SUMO network file as XML, for changes that netconvert cannot make without touching the geometry.
/// Comments are left out: in one of them netconvert notes time, options and paths. Holds the whole file in
/// memory.
class NetworkDocument {
  public:
    /// Reads `.net.xml` or `.net.xml.gz`. Throws core::InputError when it is missing, not XML or not a
    /// network.
    explicit NetworkDocument(const std::filesystem::path& file);

    /// Takes out the vehicle classes that netconvert 1.18 and later write and SUMO 1.15 refuses.
    NetworkDocument& without_newer_classes();
    /// No lane is faster than `limit`.
    void limit_speed(core::MetresPerSecond limit);
    std::string text() const;

  private:
    pugi::xml_document document_;
};

}  // namespace clearway::scenario::detail
