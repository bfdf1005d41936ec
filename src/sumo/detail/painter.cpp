#include "sumo/detail/painter.hpp"

#include <fmt/format.h>

namespace clearway::sumo::detail {
namespace {

/// Distance that the view shows to each side of the first vehicle that it follows, m: enough road and the
/// next junction. Later the user's own zoom stays.
constexpr double shown_m = 100.0;

std::string name_of(std::size_t stroke) {
    return fmt::format("clearway:{}", stroke);
}

bool same_style(const Stroke& one, const Stroke& other) {
    return one.colour == other.colour && one.width_m == other.width_m;
}

}  // namespace

void Painter::draw(const Drawing& drawing) {
    colour(drawing);
    stroke(drawing.strokes);
    if (has_view_) follow(drawing.followed);
}

void Painter::colour(const Drawing& drawing) {
    for (const auto& [key, colour] : drawing.vehicles) {
        const Vehicle* vehicle = fleet_.find(key);
        if (vehicle == nullptr || !vehicle->on_road) continue;
        const auto [known, is_new] = colours_.emplace(key, colour);
        if (!is_new && known->second == colour) continue;
        known->second = colour;
        sumo_.colour_vehicle(vehicle->id, colour);
    }
}

void Painter::stroke(const std::vector<Stroke>& strokes) {
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        if (i < strokes_.size() && strokes[i] == strokes_[i]) continue;
        if (i < strokes_.size() && same_style(strokes[i], strokes_[i])) {
            sumo_.move_stroke(name_of(i), strokes[i].points);
            continue;
        }
        if (i < strokes_.size()) sumo_.remove_stroke(name_of(i));
        sumo_.add_stroke(name_of(i), strokes[i]);
    }
    for (std::size_t i = strokes.size(); i < strokes_.size(); ++i)
        sumo_.remove_stroke(name_of(i));
    strokes_ = strokes;
}

void Painter::follow(std::optional<core::VehicleKey> followed) {
    if (followed == followed_) return;
    const Vehicle* vehicle = followed ? fleet_.find(*followed) : nullptr;
    if (vehicle != nullptr && !has_zoomed_) {
        sumo_.show_around(vehicle->id, shown_m);
        has_zoomed_ = true;
    }
    sumo_.track(vehicle != nullptr ? vehicle->id : "");
    followed_ = followed;
}

}  // namespace clearway::sumo::detail
