#pragma once

#include <span>
#include <vector>

#include "policy/agent.hpp"
#include "policy/detail/approach.hpp"
#include "policy/detail/believed_ways.hpp"
#include "policy/detail/view.hpp"
#include "python/sheet.hpp"

namespace clearway::policy::detail {

std::span<const python::Column> agent_columns();
std::span<const python::Column> agent_answer_columns();

/// Shares of the allowed speed that an automated vehicle may be asked for.
inline constexpr double asked_shares[] = {0.5, 0.8, 1.0};
inline constexpr std::uint32_t lane_choices = 4;
inline constexpr std::uint32_t automated_choices = lane_choices * (1 + std::size(asked_shares));

/// Phases of a signal's own program that show green without yellow, by number.
std::vector<std::size_t> green_phases(const roads::Signal& signal);

/// What one decision of an agent is about.
struct AgentScene {
    const traffic::BelievedVehicle* emergency = nullptr;     ///< Null: none on the road.
    std::vector<Approach> approaches;                        ///< Of that vehicle, nearest first.
    std::vector<const traffic::BelievedVehicle*> automated;  ///< Ahead of it, nearest first.
    std::vector<VehicleAhead> ahead;
    std::vector<OfferedWay> ways;  ///< That it could take, the fastest first.
};

/// Writes all arrays but the score, and `mask`: 1 for each legal action: signals, automated vehicles, the
/// way.
void write_agent_sheet(const View& view, const AgentScene& scene, const AgentSizes& sizes,
                       python::Sheet& sheet, std::vector<std::uint8_t>& mask);

/// Columns that the agent itself fills.
enum class AgentColumn : std::size_t { time, rewards, flags, first_own };

}  // namespace clearway::policy::detail
