#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/settings.hpp"
#include "core/units.hpp"
#include "policy/signal_messages.hpp"
#include "roads/network.hpp"
#include "traffic/belief.hpp"
#include "traffic/lease.hpp"
#include "traffic/registry.hpp"

namespace clearway::policy {

/// Reads the believed graph and issues leases. A condition has a list of policies. A policy may keep state
/// between steps, is used by one thread, and draws nothing at random. It does not know whether the graph is
/// true, observed or repaired. It never releases what it asked for: leases expire.
class Policy {
  public:
    Policy() = default;
    Policy(const Policy&) = delete;
    Policy& operator=(const Policy&) = delete;
    virtual ~Policy() = default;

    virtual std::string_view name() const = 0;
    /// Called every `PolicyContext::period` with the belief of that moment. Appends to `leases`.
    virtual void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) = 0;
    /// Its part that asks signals by message; null for policies whose leases are the requests themselves.
    virtual SignalMessages* messages() { return nullptr; }
};

/// What a policy needs besides the belief. The network outlives the policy.
struct PolicyContext {
    const roads::Network& network;
    core::Seconds period{0.5};  ///< Time between two calls of `act`.
    /// What others needed for each edge on other days, s, by core::EdgeIndex, 0 where that is not known;
    /// empty: for none. Valid while the policy is made.
    std::span<const double> mean_times_s = {};
};

/// A registered policy. Settings are named with their component, `preempt_signals.lead_s`; `make` ignores
/// those of other components.
struct PolicyEntry : traffic::Registered<Policy, PolicyContext> {
    /// Names of the policies whose settings it has: its own name, or those of the policies it combines.
    std::vector<std::string> components;
};

/// All registered policies.
const traffic::Registry<PolicyEntry>& policies();

/// Throws core::InputError for an unknown name, naming the nearest, and for settings that its table does not
/// allow.
std::unique_ptr<Policy> make_policy(const std::string& name, const PolicyContext& context,
                                    const core::Settings& settings = {});

}  // namespace clearway::policy
