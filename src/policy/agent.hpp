#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "policy/policy.hpp"
#include "python/channel.hpp"

namespace clearway::policy {

/// Makes a policy that no name stands for.
using GuestMaker = std::function<std::unique_ptr<Policy>(const PolicyContext& context)>;

/// What an environment's agent got since its last decision, from the truth: for learning, never for deciding.
struct AgentScore {
    double emergency_delay_s = 0.0;  ///< Time that emergency vehicles lost against their allowed speed.
    double others_delay_s = 0.0;     ///< The same of all other vehicles, summed.
    bool all_arrived = false;        ///< Every emergency vehicle has departed, and none is on the road.
    bool any_departed = false;       ///< The first emergency vehicle has entered.
};

/// Sizes of the arrays that an agent gets. The same for a whole environment.
struct AgentSizes {
    std::uint32_t vehicles = 32;     ///< Rows of vehicles, the nearest to the emergency vehicle.
    std::uint32_t links = 128;       ///< Believed links among them.
    std::uint32_t automated = 8;     ///< Automated vehicles ahead on its route that take actions.
    std::uint32_t signals = 0;       ///< All of the network.
    std::uint32_t phases = 0;        ///< Most green phases of a signal.
    std::uint32_t signal_links = 0;  ///< Most links of a signal.
    std::uint32_t ways = 0;          ///< From which the emergency vehicle's way may be chosen.
};
/// Most ways that an agent may be offered.
inline constexpr std::uint32_t most_agent_ways = 8;
/// Throws core::InputError for more ways than that.
AgentSizes agent_sizes(const roads::Network& network, std::uint32_t ways = 0);

/// Sheets, sizes and names, as an environment gets them once: JSON.
std::string agent_greeting(const roads::Network& network, std::uint32_t ways = 0);

/// The policy whose mind is an environment in another process: it hands over what is believed around the
/// first emergency vehicle as arrays of fixed size, waits, and makes leases of the answer. Actions:
///
/// - for each signal 0 (leave it to its plan) or 1 + p: hold the p-th green phase of its program;
/// - for each automated vehicle `lane + 4 * speed`: lane 0 none, 1 hold, 2 outward, 3 inward; speed 0 none,
///   or 1 to 3: half, 0.8 and all of what it is allowed;
/// - where `ways` are offered, for the emergency vehicle 0 (keep its way) or the number of one of the ways
///   that are fastest by the times that `navigate` believes by default, from the last turn that it can make.
///
/// Illegal actions (`action_mask` 0) make no lease and are counted in the next sheet.
class Agent : public Policy {
  public:
    /// Both outlive the policy. Before the first emergency vehicle enters, nobody is asked. `left` is called
    /// when the environment does not want to go on: it must not return.
    Agent(const PolicyContext& context, const python::Channel& channel, AgentScore& score,
          std::function<void(python::Bell)> left, std::uint32_t ways = 0);
    ~Agent() override;

    std::string_view name() const override { return "agent"; }
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::policy
