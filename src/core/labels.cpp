#include "core/labels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clearway::core {
namespace {

constexpr double gap = 1.0;
/// Spots round a place: rings of so many spots each. Sixteen on the smallest ring are 6 units apart, and the
/// farthest is 92 units away, a tenth of the picture: farther, nobody sees what a disc belongs to.
constexpr int rings = 20;
constexpr int spots_of_ring = 16;
constexpr double first_ring = 16.0;
constexpr double ring_step = 4.0;
/// Marks nearer than this decide to which side a disc goes.
constexpr double near = 40.0;

double distance(const Spot& one, const Spot& other) {
    return std::hypot(one.x - other.x, one.y - other.y);
}

class Spreader {
  public:
    Spreader(const std::vector<Spot>& places, const std::vector<Mark>& marks, Spot size)
        : places_(places), marks_(marks), size_(size) {}

    std::vector<Spot> spots() {
        std::vector<Spot> spots = places_;
        std::vector<std::size_t> crowded;
        for (std::size_t row = 0; row < places_.size(); ++row) {
            if (marks_[row] == Mark::dot) continue;
            if (hides_a_place(places_[row], row) || meets_a_disc_at_its_place(row)) {
                crowded.push_back(row);
            } else {
                discs_.push_back(places_[row]);
            }
        }
        for (const std::size_t row : crowded) {
            spots[row] = free_spot(row);
            discs_.push_back(spots[row]);
        }
        return spots;
    }

  private:
    bool meets_a_disc_at_its_place(std::size_t row) const {
        for (std::size_t other = 0; other < places_.size(); ++other)
            if (other != row && marks_[other] == Mark::disc &&
                distance(places_[row], places_[other]) < 2 * disc_radius + gap)
                return true;
        return false;
    }

    bool hides_a_place(const Spot& spot, std::size_t row) const {
        for (std::size_t other = 0; other < places_.size(); ++other)
            if (other != row && distance(spot, places_[other]) < disc_radius + dot_radius) return true;
        return false;
    }

    bool is_free(const Spot& spot, std::size_t row) const {
        const bool inside = spot.x >= disc_radius && spot.y >= disc_radius &&
                            spot.x <= size_.x - disc_radius && spot.y <= size_.y - disc_radius;
        return inside && !hides_a_place(spot, row) && std::ranges::none_of(discs_, [&](const Spot& disc) {
                   return distance(spot, disc) < 2 * disc_radius + gap;
               });
    }

    /// The direction away from the other marks near it, clockwise from above: so discs keep their sides.
    double away(std::size_t row) const {
        Spot sum;
        for (const Spot& other : places_) {
            const double apart = distance(places_[row], other);
            if (apart == 0.0 || apart > near) continue;
            sum.x += (places_[row].x - other.x) / apart;
            sum.y += (places_[row].y - other.y) / apart;
        }
        return sum == Spot{} ? 0.0 : std::atan2(sum.x, -sum.y);
    }

    /// From the nearest ring outwards, in each beginning away from the others and going to both sides.
    Spot free_spot(std::size_t row) const {
        const double first = away(row);
        for (int ring = 0; ring < rings; ++ring) {
            const double radius = first_ring + ring_step * ring;
            for (int at = 0; at < spots_of_ring; ++at) {
                const int side = at % 2 == 0 ? -at / 2 : (at + 1) / 2;
                const double angle = first + 2.0 * std::numbers::pi * side / spots_of_ring;
                const Spot spot{places_[row].x + radius * std::sin(angle),
                                places_[row].y - radius * std::cos(angle)};
                if (is_free(spot, row)) return spot;
            }
        }
        return places_[row];
    }

    const std::vector<Spot>& places_;
    const std::vector<Mark>& marks_;
    Spot size_;
    std::vector<Spot> discs_;  ///< Those that have their spot.
};

}  // namespace

void Extent::add(double x, double y) {
    left = std::min(left, x);
    bottom = std::min(bottom, y);
    right = std::max(right, x);
    top = std::max(top, y);
}

Extent drawn_part(const Extent& all, const Extent& signals) {
    constexpr double least_margin_m = 100.0;
    constexpr double margin_share = 0.2;
    constexpr double flattest = 0.5;
    constexpr double largest_share = 1.0 / 3.0;
    if (signals.right < signals.left) return all;
    const double margin_m =
        std::max(least_margin_m, margin_share * std::max(signals.width(), signals.height()));
    double across = signals.width() + 2.0 * margin_m;
    double high = signals.height() + 2.0 * margin_m;
    across = std::max(across, flattest * high);
    high = std::max(high, flattest * across);
    const double x = (signals.left + signals.right) / 2.0;
    const double y = (signals.bottom + signals.top) / 2.0;
    const Extent part{std::max(all.left, x - across / 2.0), std::max(all.bottom, y - high / 2.0),
                      std::min(all.right, x + across / 2.0), std::min(all.top, y + high / 2.0)};
    return part.width() * part.height() < largest_share * all.width() * all.height() ? part : all;
}

std::vector<Spot> spread(const std::vector<Spot>& places, const std::vector<Mark>& marks, Spot size) {
    return Spreader(places, marks, size).spots();
}

}  // namespace clearway::core
