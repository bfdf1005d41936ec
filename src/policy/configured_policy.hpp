#pragma once

#include "policy/policy.hpp"

namespace clearway::policy {

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
