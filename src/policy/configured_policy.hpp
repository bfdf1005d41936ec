#pragma once

#include "core/fields.hpp"
#include "policy/policy.hpp"

namespace clearway::policy {

namespace detail {

/// A lifetime, the same field in every policy whose leases must be renewed.
template <class Config>
constexpr auto lifetime_field() {
    return core::Field{"lease_s",
                       "s",
                       &Config::lease_s,
                       0.1,
                       60.0,
                       "Lifetime of a lease that is not renewed; at least two periods",
                       "assumed: four decisions at the usual period"};
}

}  // namespace detail

/// A policy with settings of its own.
template <class Config>
class ConfiguredPolicy : public Policy {
  public:
    explicit ConfiguredPolicy(const PolicyContext& context, const Config& config = {})
        : context_(context), config_(config) {}

  protected:
    PolicyContext context_;
    Config config_;
};

}  // namespace clearway::policy
