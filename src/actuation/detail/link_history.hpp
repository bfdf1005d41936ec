#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/units.hpp"

namespace clearway::actuation::detail {

/// Since when each link of a signal has shown its colour.
class LinkHistory {
  public:
    /// Notes what the signal shows, or was told to show from now on. The first state is taken for as old as
    /// time.
    void watch(const std::string& state, core::Seconds now);

    /// How long the link has been green, s; 0 while it is not.
    double green_s(std::uint16_t link, core::Seconds now) const;
    /// How long the link has been yellow, s; 0 while it is not.
    double yellow_s(std::uint16_t link, core::Seconds now) const;
    /// How long the link has been neither green nor yellow, s; 0 while it is.
    double red_s(std::uint16_t link, core::Seconds now) const;

  private:
    struct Link {
        char letter = 'r';
        core::Seconds green_since;
        core::Seconds yellow_since;
        core::Seconds red_since;
    };
    std::vector<Link> links_;
};

}  // namespace clearway::actuation::detail
