#include "view/near_path.hpp"

#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "trace/recording.hpp"
#include "truth/snapshot.hpp"

namespace clearway::view {
namespace {

constexpr double cell_m = 25.0;
using Cell = std::pair<int, int>;

int cell_of(double metres) {
    return static_cast<int>(std::floor(metres / cell_m));
}

}  // namespace

void add_path(const std::filesystem::path& recording, const std::string& vehicle,
              std::vector<roads::Point>& path) {
    trace::RecordingReader reader(recording);
    const core::VehicleKey key = core::vehicle_key(vehicle);
    while (const auto step = reader.next()) {
        if (const auto row = step->snapshot->row_of(key))
            path.push_back({step->snapshot->x_m[*row], step->snapshot->y_m[*row]});
    }
}

Area near_path(const std::vector<roads::Point>& path, double radius_m) {
    const auto cells = std::make_shared<std::set<Cell>>();
    const int reach = static_cast<int>(std::ceil(radius_m / cell_m));
    Cell last{path.empty() ? 0 : cell_of(path.front().x_m) + 1, 0};
    for (const roads::Point& point : path) {
        const Cell here{cell_of(point.x_m), cell_of(point.y_m)};
        if (here == last) continue;
        last = here;
        for (int i = -reach; i <= reach; ++i) {
            for (int j = -reach; j <= reach; ++j) {
                if (std::hypot(i, j) * cell_m <= radius_m) cells->insert({here.first + i, here.second + j});
            }
        }
    }
    return [cells](double x_m, double y_m) { return cells->contains({cell_of(x_m), cell_of(y_m)}); };
}

}  // namespace clearway::view
