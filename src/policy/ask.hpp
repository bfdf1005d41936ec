#pragma once

#include <cstdint>
#include <vector>

#include "core/fields.hpp"
#include "core/spellings.hpp"
#include "traffic/belief.hpp"

namespace clearway::policy {

/// Whom a policy asks.
enum class Ask : std::uint8_t {
    everyone,  ///< Every vehicle whose place matters.
    linked,    ///< Of these, those that the emergency vehicle is believed to be linked with.
};
constexpr core::Spellings<Ask, 2> spellings(Ask) {
    return {{{Ask::everyone, "everyone"}, {Ask::linked, "linked"}}};
}

/// Settings of policies that ask vehicles; bases of their configurations.
struct AskSettings {
    Ask ask = Ask::everyone;
    double ask_probability = 0.5;
    int ask_hops = 1;
    int ask_humans = 0;

    static constexpr void fields(const auto& table) {
        using C = AskSettings;
        using core::Field;
        table(
            Field{"ask", "", &C::ask, 0, 0,
                  "Which vehicles it asks: all, or those that the emergency vehicle is believed to be linked "
                  "with",
                  "everyone: earlier conditions use positions only"},
            Field{"ask_probability", "1", &C::ask_probability, 0.0, 1.0,
                  "linked: a believed link counts when its probability is at least this", "even odds"},
            Field{"ask_hops", "1", &C::ask_hops, 1, 5,
                  "linked: links from the emergency vehicle, the ones in between being automated vehicles; "
                  "more than 1 needs loop.automated_links=1",
                  "1: no relays"},
            Field{"ask_humans", "1", &C::ask_humans, 0, 1,
                  "1: human drivers are asked, too; those who comply (requests.compliance) do it",
                  "0: automated vehicles alone"});
    }
};

/// The vehicles that a policy may ask on behalf of one emergency vehicle. Refers to the belief. An emergency
/// vehicle that is not in the believed graph, because nobody has heard it, is linked with nobody.
class Audience {
  public:
    /// O(links) for `linked`, nothing otherwise.
    Audience(const traffic::BelievedGraph& belief, core::VehicleKey emergency, const AskSettings& settings);
    bool has(const traffic::BelievedVehicle& vehicle) const;

  private:
    Ask ask_;
    bool with_humans_;
    std::vector<core::VehicleKey> linked_;  ///< Ascending.
};

}  // namespace clearway::policy
