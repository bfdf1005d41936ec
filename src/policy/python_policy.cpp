#include "policy/python_policy.hpp"

#include <fmt/format.h>

#include "policy/detail/belief_sheet.hpp"
#include "policy/detail/believed_ways.hpp"
#include "policy/detail/known_targets.hpp"
#include "policy/detail/lease_reader.hpp"
#include "policy/navigate.hpp"
#include "python/part_process.hpp"

namespace clearway::policy {

struct PythonPolicy::State {
    State(const PolicyContext& context, const std::string& word, const core::Settings& settings)
        : network(context.network),
          ways(context, NavigateConfig{}),
          targets(context.network),
          process(*python::part_name_from(python::resolved(word, {}, "policy")),
                  {.kind = python::PartKind::policy,
                   .settings = settings,
                   .question = detail::belief_columns(),
                   .network = &context.network,
                   .period_s = context.period.value}) {}

    /// Adds to the error what a reader needs to find the lease: action, time and the line that made it.
    void check(const traffic::Lease& lease, const std::string& place, core::Seconds now) const {
        try {
            targets.check(lease);
        } catch (const python::PartError& error) {
            throw python::PartError(fmt::format("{} ({} at {:.1f} s{}{})", error.what(),
                                                traffic::name(lease.action), now.value,
                                                place.empty() ? "" : "; ", place));
        }
    }

    const roads::Network& network;
    detail::BelievedWays ways;
    detail::KnownTargets targets;
    python::PartProcess process;
};

PythonPolicy::PythonPolicy(const PolicyContext& context, const std::string& word,
                           const core::Settings& settings)
    : name_(&detail::kept_text(python::short_name(word))),
      state_(std::make_unique<State>(context, word, settings)) {}

PythonPolicy::~PythonPolicy() = default;

void PythonPolicy::act(const traffic::BelievedGraph& belief, std::vector<traffic::Lease>& leases) {
    const detail::View view(state_->network, belief);
    state_->ways.see(belief);
    state_->targets.see(belief);
    detail::write_belief(view, view.emergency_vehicles(), state_->ways, state_->process.question());
    state_->process.ask();
    try {
        const std::size_t before = leases.size();
        const std::vector<std::string> places =
            detail::read_leases(state_->process.answer_text(), *name_, belief.time, leases);
        for (std::size_t lease = before; lease < leases.size(); ++lease)
            state_->check(leases[lease], places[lease - before], belief.time);
    } catch (const python::PartError& error) {
        throw python::PartError(fmt::format("{}: {}", *name_, error.what()));
    }
}

}  // namespace clearway::policy
