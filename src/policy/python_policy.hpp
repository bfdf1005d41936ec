#pragma once

#include <memory>
#include <string>
#include <vector>

#include "policy/policy.hpp"
#include "python/part_name.hpp"

namespace clearway::policy {

/// A policy that is a class in Python: it runs in a process of its own (python::PartProcess), gets every
/// belief as arrays in shared memory, and answers with leases. Its leases are judged, expire and are counted
/// as those of any policy, under the name of its class.
class PythonPolicy : public Policy {
  public:
    /// `settings` are those of its class. Throws core::InputError when the file has changed,
    /// python::PartError when it cannot be loaded.
    PythonPolicy(const PolicyContext& context, const std::string& word, const core::Settings& settings);
    ~PythonPolicy() override;

    std::string_view name() const override { return *name_; }
    /// Throws python::PartError with the traceback of an exception.
    void act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) override;

  private:
    struct State;
    const std::string* name_;
    std::unique_ptr<State> state_;
};

}  // namespace clearway::policy
