#include <algorithm>

#include "core/error.hpp"
#include "policy/dissertation.hpp"
#include "policy/listing_5_5.hpp"
#include "policy/part.hpp"

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
