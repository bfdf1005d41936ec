#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/ids.hpp"
#include "sumo/network_names.hpp"
#include "sumo/session.hpp"
#include "support/temporary_folder.hpp"

namespace clearway::test {

/// A folder of its own for the running test, empty at first and removed with the object.
class Scene {
  public:
    const std::filesystem::path& folder() const { return folder_.path(); }
    /// Writes a text file and gives its path.
    std::filesystem::path write(const std::string& name, const std::string& text) const;

    /// Two edges of two lanes eastward, `in` (0 to 500 m) and `out` (500 to 1000 m), 13.89 m/s, no signal.
    std::filesystem::path straight_road() const;
    /// Edges `east` and `west` of one lane, 2 km, 27.78 m/s; each may overtake on the other's lane.
    std::filesystem::path two_way_road() const;
    /// A crossing at (0, 0) with a signal, `c`, and four arms of 200 m and two lanes: edges `west_in`,
    /// `east_out` and so on.
    std::filesystem::path crossing() const;
    /// Types `hv` (Krauss, imperfection 0), `av` and `ev` (IDM), with their class and kind.
    std::filesystem::path types() const;
    /// A route file: `vehicles` are XML elements.
    std::filesystem::path routes(const std::string& vehicles) const;
    /// A configuration with these types and routes, and the names that stand in the network file.
    sumo::SessionConfig config(const std::filesystem::path& network, const std::string& vehicles) const;

  private:
    support::TemporaryFolder folder_;
};

/// A vehicle element that drives `edges`.
std::string vehicle(const std::string& id, const std::string& type, double depart_s, const std::string& edges,
                    const std::string& attributes = "");

/// Steps until `time_s` is reached.
void step_until(sumo::Session& session, double time_s);

/// The whole text of a file, with the moment of writing, which SUMO puts in a comment, blotted out.
std::string text_without_date(const std::filesystem::path& file);

inline void apply(sumo::Session& session, const traffic::Command& command) {
    session.apply(std::span(&command, 1));
}

inline core::VehicleKey key(const std::string& id) {
    return core::vehicle_key(id);
}

}  // namespace clearway::test
