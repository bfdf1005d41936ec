#include "samples/edge_times.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "truth/snapshot.hpp"

namespace clearway::samples {

EdgeUseRecorder::EdgeUseRecorder(const roads::Network& network)
    : network_(network), uses_(network.edges().size()) {}

void EdgeUseRecorder::on_step(const truth::Snapshot& snapshot, const traffic::Roster& /*roster*/) {
    const double now_s = snapshot.time.value;
    const double step_s = last_s_ < 0.0 ? 0.0 : now_s - last_s_;
    last_s_ = now_s;
    for (std::size_t row = 0; row < snapshot.size(); ++row) {
        if (snapshot.vehicle_class[row] == traffic::VehicleClass::emergency) continue;
        const core::EdgeIndex edge = network_.lane(snapshot.lane[row]).edge;
        if (network_.edge(edge).internal) continue;
        EdgeUse& use = uses_[edge.value];
        use.time_s += step_s;
        use.distance_m += snapshot.speed_mps[row] * step_s;
        const auto [last, is_new] = on_edge_.try_emplace(snapshot.key[row].value, edge);
        if (is_new || last->second != edge) ++use.vehicles;
        last->second = edge;
    }
}

EdgeUses EdgeUseRecorder::uses() const {
    EdgeUses found;
    for (std::size_t row = 0; row < uses_.size(); ++row) {
        if (uses_[row].vehicles > 0) found.emplace(network_.edges()[row].id, uses_[row]);
    }
    return found;
}

void write_edge_uses(const EdgeUses& uses, const std::filesystem::path& file) {
    std::string text = "edge,vehicles,time_s,distance_m\n";
    for (const auto& [edge, use] : uses)
        text += fmt::format("{},{},{},{}\n", core::csv_text(edge), use.vehicles, use.time_s, use.distance_m);
    core::write_atomically(file, text);
}

EdgeUses read_edge_uses(const std::filesystem::path& file) try {
    const std::string text = core::read_file(file);
    core::CsvReader reader(text);
    EdgeUses uses;
    for (reader.next(); reader.next();) {
        const std::vector<std::string_view>& cells = reader.cells();
        if (cells.size() != 4) throw std::runtime_error("a row without four cells");
        EdgeUse& use = uses[std::string(cells[0])];
        core::read_cell(cells[1], use.vehicles);
        core::read_cell(cells[2], use.time_s);
        core::read_cell(cells[3], use.distance_m);
    }
    return uses;
} catch (const std::runtime_error& error) {
    throw core::InputError({file.string(), error.what(), "", ""});
}

}  // namespace clearway::samples
