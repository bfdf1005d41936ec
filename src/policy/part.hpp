#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/units.hpp"
#include "roads/network.hpp"
#include "traffic/belief.hpp"
#include "traffic/lease.hpp"

namespace clearway::policy {

/// One part of a policy: reads the believed graph and issues leases. A condition is a list of parts. A part
/// may keep state between steps, is used by one thread, and draws nothing at random. It never learns whether
/// the graph is true, observed or repaired, and it never releases what it asked for: leases end by
/// themselves.
class Part {
  public:
    Part() = default;
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;
    virtual ~Part() = default;

    virtual std::string_view name() const = 0;
    /// Called every `PartContext::period` with the belief of that moment. Appends to
    /// `leases`.
    virtual void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) = 0;
};

/// What a part needs beside the belief. The network outlives the part.
struct PartContext {
    const roads::Network& network;
    core::Seconds period{0.5};  ///< Between two calls of `act`.
};

/// A part as the registry knows it.
struct PartEntry {
    std::string name;
    std::string summary;  ///< One line for `clearway list`.
    std::unique_ptr<Part> (*make)(const PartContext& context);
};

/// All registered parts, by name.
const std::vector<PartEntry>& parts();

/// Throws core::InputError for an unknown name, naming the nearest.
std::unique_ptr<Part> make_part(const std::string& name, const PartContext& context);

}  // namespace clearway::policy
