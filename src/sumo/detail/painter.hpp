#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "sumo/detail/fleet.hpp"
#include "sumo/detail/gateway.hpp"
#include "sumo/drawing.hpp"

namespace clearway::sumo::detail {

/// Updates SUMO from one drawing to the next with few calls, because each is a request over a connection:
/// what stays is not sent again, and strokes are moved while their style stays the same.
class Painter {
  public:
    /// Both outlive the painter.
    Painter(gateway::Sumo& sumo, Fleet& fleet) : sumo_(sumo), fleet_(fleet), has_view_(sumo.has_view()) {}

    void draw(const Drawing& drawing);

  private:
    void colour(const Drawing& drawing);
    void stroke(const std::vector<Stroke>& strokes);
    void follow(std::optional<core::VehicleKey> followed);

    gateway::Sumo& sumo_;
    Fleet& fleet_;
    bool has_view_;
    bool has_zoomed_ = false;
    std::unordered_map<core::VehicleKey, Colour> colours_;
    std::vector<Stroke> strokes_;
    std::optional<core::VehicleKey> followed_;
};

}  // namespace clearway::sumo::detail
