#include <algorithm>

#include "core/error.hpp"
#include "policy/clear_lane.hpp"
#include "policy/corridor.hpp"
#include "policy/dissertation.hpp"
#include "policy/green_wave.hpp"
#include "policy/listing_5_5.hpp"
#include "policy/part.hpp"
#include "policy/preempt_signals.hpp"
#include "policy/recover_signals.hpp"
#include "policy/red_privilege.hpp"

namespace clearway::policy {
namespace {

template <class Kind>
std::unique_ptr<Part> make(const PartContext& context) {
    return std::make_unique<Kind>(context);
}

}  // namespace

const std::vector<PartEntry>& parts() {
    static const std::vector<PartEntry> entries = {
        {"listing_5_5", "The dissertation's listing 5.5 as published, defects included", make<Listing55>},
        {"dissertation", "The dissertation's policy text (4.3) made workable", make<Dissertation>},
        {"preempt_signals", "Green for the emergency vehicle's approach on its arrival",
         make<PreemptSignals>},
        {"recover_signals", "Gives time back to the approaches that waited", make<RecoverSignals>},
        {"clear_lane", "Automated vehicles ahead leave the emergency vehicle's lane", make<ClearLane>},
        {"corridor", "preempt_signals, recover_signals and clear_lane together", make<Corridor>},
        {"green_wave", "Opponent: every signal of the route at the arrival planned once", make<GreenWave>},
        {"red_privilege", "Opponent: the emergency vehicle passes red slowly and yielding",
         make<RedPrivilege>},
    };
    return entries;
}

std::unique_ptr<Part> make_part(const std::string& name, const PartContext& context) {
    std::vector<std::string> names;
    for (const PartEntry& entry : parts()) {
        if (entry.name == name) return entry.make(context);
        names.push_back(entry.name);
    }
    const std::string near = core::nearest(name, names);
    std::string allowed;
    for (const std::string& known : names)
        allowed += (allowed.empty() ? "" : ", ") + known;
    throw core::InputError(core::Problem{"policy part", "'" + name + "' is not known", allowed,
                                         near.empty() ? "" : "did you mean '" + near + "'?"});
}

}  // namespace clearway::policy
