#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/settings.hpp"
#include "core/spellings.hpp"

namespace clearway::traffic {

/// What a policy or predictor does or needs. Checks ask for this, never for a part by its name.
enum class Trait : std::uint8_t {
    /// Its requests to vehicles live `lease_s` unless it renews them: one that arrives later is lost.
    renews_requests,
    asks_signals,          ///< For green, before the emergency vehicle arrives.
    asks_without_radio,    ///< By a detector or a light: no message that could be lost.
    reads_links,           ///< Believed links decide something, and not places alone.
    sublane_model,         ///< Needs vehicles with a lateral position within their lane.
    shoulder,              ///< Needs a network with shoulders.
    learned,               ///< Takes a model file.
    knows_truth,           ///< Is given the truth instead of reports: no repair, but a ceiling for them.
    compares_only,         ///< Nobody would run it but to compare others with it.
    repeats_dissertation,  ///< As published, defects included.
};
constexpr core::Spellings<Trait, 10> spellings(Trait) {
    return {{{Trait::renews_requests, "renews_requests"},
             {Trait::asks_signals, "asks_signals"},
             {Trait::asks_without_radio, "asks_without_radio"},
             {Trait::reads_links, "reads_links"},
             {Trait::sublane_model, "needs_sublane_model"},
             {Trait::shoulder, "needs_shoulder"},
             {Trait::learned, "learned"},
             {Trait::knows_truth, "knows_truth"},
             {Trait::compares_only, "compares_only"},
             {Trait::repeats_dissertation, "repeats_dissertation"}}};
}

/// A policy or predictor that can be asked for by name.
template <class Part, class Context>
struct Registered {
    std::string name;
    std::string summary;  ///< One line for `clearway list`.
    std::vector<Trait> traits;
    core::SettingsTable table;  ///< Its own settings.
    std::function<std::unique_ptr<Part>(const Context& context, const core::Settings& settings)> make;

    bool is(Trait trait) const { return core::contains(traits, trait); }
};

/// All registered parts of one kind, in the order of the documentation.
template <class Entry>
class Registry {
  public:
    /// `kind` is what messages call a part: `policy`.
    Registry(std::string kind, std::vector<Entry> entries)
        : kind_(std::move(kind)), entries_(std::move(entries)) {}

    auto begin() const { return entries_.begin(); }
    auto end() const { return entries_.end(); }

    /// Null for an unknown name.
    const Entry* find(const std::string& name) const {
        const auto found = std::ranges::find(entries_, name, &Entry::name);
        return found == entries_.end() ? nullptr : &*found;
    }
    /// Throws core::InputError for an unknown name, naming the nearest.
    const Entry& at(const std::string& name) const {
        if (const Entry* const entry = find(name)) return *entry;
        throw core::InputError({kind_, fmt::format("'{}' is not a {}", name, kind_), core::listed(names()),
                                core::did_you_mean(name, names())});
    }
    /// Whether `name` is registered and has the trait.
    bool is(const std::string& name, Trait trait) const {
        const Entry* const entry = find(name);
        return entry != nullptr && entry->is(trait);
    }
    std::vector<std::string> names() const {
        std::vector<std::string> all;
        std::ranges::transform(entries_, std::back_inserter(all), &Entry::name);
        return all;
    }
    /// Names of those with the trait.
    std::vector<std::string> names(Trait trait) const {
        std::vector<std::string> some = names();
        std::erase_if(some, [&](const std::string& name) { return !is(name, trait); });
        return some;
    }

  private:
    std::string kind_;
    std::vector<Entry> entries_;
};

}  // namespace clearway::traffic
