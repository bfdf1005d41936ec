#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "roads/network.hpp"
#include "trace/step_listener.hpp"

namespace clearway::samples {

/// How vehicles used an edge. Distance over time is their mean speed there (Edie 1963).
struct EdgeUse {
    std::uint64_t vehicles = 0;
    double time_s = 0.0;
    double distance_m = 0.0;
};
using EdgeUses = std::map<std::string, EdgeUse>;  ///< By id of the edge.

/// Watches a run and sums how vehicles other than emergency vehicles use the edges outside junctions.
class EdgeUseRecorder : public trace::StepListener {
  public:
    explicit EdgeUseRecorder(const roads::Network& network);

    void on_step(const truth::Snapshot& snapshot, const traffic::Roster& roster) override;
    /// Edges that were used.
    EdgeUses uses() const;

  private:
    const roads::Network& network_;
    std::vector<EdgeUse> uses_;                                   ///< By edge.
    std::unordered_map<std::uint64_t, core::EdgeIndex> on_edge_;  ///< By key of the vehicle, the last one.
    double last_s_ = -1.0;                                        ///< Time of the last step; negative: none.
};

/// Writes a file for `read_edge_uses`. Throws core::EnvironmentError.
void write_edge_uses(const EdgeUses& uses, const std::filesystem::path& file);
/// Throws core::InputError for a file that is not one of these.
EdgeUses read_edge_uses(const std::filesystem::path& file);

}  // namespace clearway::samples
