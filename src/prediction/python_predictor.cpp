#include "prediction/python_predictor.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "prediction/detail/pairwise.hpp"
#include "python/part_process.hpp"

namespace clearway::prediction {
namespace {

using python::Sheet;

constexpr std::array columns = std::to_array<python::Column>({
    {"time_s", "f8", "s", "Simulation time of the observation"},
    {"key", "u8", "", "Identity of each observed vehicle during the run; rows are ordered by it"},
    {"vehicle_class", "u1", "", "0 human, 1 automated, 2 emergency"},
    {"age_s", "f4", "s", "Age of its last report"},
    {"known", "u1", "1", "1: its newest report arrived and states no error"},
    {"sensor_sigma_m", "f4", "m", "Standard error that the sensor states"},
    {"x_m", "f4", "m", "Front bumper now, had it kept its speed along its route (dead reckoning)"},
    {"y_m", "f4", "m", "Likewise"},
    {"heading_rad", "f4", "rad", "Likewise, counter-clockwise from the x axis"},
    {"speed_mps", "f4", "m/s", "As last reported"},
    {"lane", "u4", "", "Lane of the network by dead reckoning; 4294967295: none"},
    {"lane_position_m", "f4", "m", "From the start of that lane"},
    {"last_x_m", "f4", "m", "Front bumper as last reported"},
    {"last_y_m", "f4", "m", "Likewise"},
    {"link_left", "u4", "", "Row of one end of each observed link: known or detected"},
    {"link_right", "u4", "", "Row of the other end"},
    {"pair_left", "u4", "", "Row of one end of each candidate"},
    {"pair_right", "u4", "", "Row of the other end"},
    {"pair_last_seen_m", "f4", "m", "Distance of the places last reported"},
    {"pair_dead_reckoned_m", "f4", "m", "Distance of the dead-reckoned places"},
});

constexpr std::array<python::Column, 1> answer_columns = {{
    {"probability", "f4", "1", "That a candidate is nearer than the link radius, 0 to 1"},
}};

/// Place of a column, at compile time: a name that the table lacks does not compile.
consteval std::size_t column(std::string_view name) {
    for (std::size_t at = 0; at < columns.size(); ++at) {
        if (columns[at].name == name) return at;
    }
    throw std::logic_error("no column of this name");
}

template <class Value, class Rows, class Member>
void fill(Sheet& sheet, std::size_t number, const Rows& rows, const Member& member) {
    std::ranges::transform(rows, sheet.room<Value>(number, rows.size()).begin(), member);
}

void write_tracks(const Tracks& tracks, Sheet& sheet) {
    using State = traffic::MotionState;
    fill<std::uint64_t>(sheet, column("key"), tracks.key, [](core::VehicleKey key) { return key.value; });
    fill<std::uint8_t>(sheet, column("vehicle_class"), tracks.vehicle_class,
                       [](traffic::VehicleClass one) { return static_cast<std::uint8_t>(one); });
    sheet.put(column("age_s"), tracks.age_s);
    sheet.put(column("known"), tracks.known);
    sheet.put(column("sensor_sigma_m"), tracks.sensor_sigma_m);
    sheet.put(column("x_m"), tracks.x_m);
    sheet.put(column("y_m"), tracks.y_m);
    fill<float>(sheet, column("heading_rad"), tracks.state,
                [](const State& state) { return state.heading_rad; });
    fill<float>(sheet, column("speed_mps"), tracks.state, [](const State& state) { return state.speed_mps; });
    fill<std::uint32_t>(sheet, column("lane"), tracks.state,
                        [](const State& state) { return state.lane.value; });
    fill<float>(sheet, column("lane_position_m"), tracks.state,
                [](const State& state) { return state.lane_position_m; });
    sheet.put(column("last_x_m"), tracks.last_x_m);
    sheet.put(column("last_y_m"), tracks.last_y_m);
}

class PythonPredictor final : public detail::PairwisePredictor {
  public:
    PythonPredictor(const PredictorContext& context, const std::string& word, const core::Settings& settings)
        : PairwisePredictor(context),
          name_(python::short_name(word)),
          process_(*python::part_name_from(python::resolved(word, {}, "predictor")),
                   {.kind = python::PartKind::predictor,
                    .settings = settings,
                    .question = columns,
                    .answer = answer_columns,
                    .network = &context.network,
                    .link_radius_m = context.rules.radius_m}) {}
    std::string_view name() const override { return name_; }

  private:
    void believe(const Scene& scene, std::vector<detail::RowBelief>& beliefs) override {
        detail::believe_dead_reckoned(scene.tracks, beliefs);
    }
    void score(const Scene& scene, const std::vector<detail::RowBelief>&,
               std::vector<float>& probabilities) override {
        if (scene.candidates.size() == 0) return;
        write(scene);
        process_.ask();
        const std::span<const float> answer = process_.answer_array<float>(0);
        const bool fits = answer.size() == probabilities.size() &&
                          std::ranges::all_of(answer, [](float one) { return one >= 0.0F && one <= 1.0F; });
        if (!fits)
            throw python::PartError(
                fmt::format("{}: {} values are not the probabilities of {} candidates, each 0 to 1", name_,
                            answer.size(), probabilities.size()));
        std::ranges::copy(answer, probabilities.begin());
    }
    void write(const Scene& scene) {
        Sheet& sheet = process_.question();
        sheet.clear();
        sheet.room<double>(column("time_s"), 1)[0] = scene.tracks.time_s;
        write_tracks(scene.tracks, sheet);
        std::vector<RowPair> links = scene.known.rows;
        links.insert(links.end(), scene.detected.rows.begin(), scene.detected.rows.end());
        const auto left = [](RowPair pair) { return pair.left; };
        const auto right = [](RowPair pair) { return pair.right; };
        fill<std::uint32_t>(sheet, column("link_left"), links, left);
        fill<std::uint32_t>(sheet, column("link_right"), links, right);
        fill<std::uint32_t>(sheet, column("pair_left"), scene.candidates.rows, left);
        fill<std::uint32_t>(sheet, column("pair_right"), scene.candidates.rows, right);
        sheet.put(column("pair_last_seen_m"), scene.candidates.last_seen_m);
        sheet.put(column("pair_dead_reckoned_m"), scene.candidates.dead_reckoned_m);
    }

    std::string name_;
    python::PartProcess process_;
};

}  // namespace

PartedSettings parted_settings(const core::Settings& settings) {
    PartedSettings parted;
    const std::vector<core::SettingInfo> rows = core::field_rows<PredictionConfig>();
    for (const auto& setting : settings) {
        const bool is_shared = core::contains(rows, setting.first, &core::SettingInfo::name);
        (is_shared ? parted.shared : parted.own).insert(setting);
    }
    return parted;
}

std::unique_ptr<Predictor> make_python_predictor(PredictorContext context, const std::string& word,
                                                 const core::Settings& settings) {
    const PartedSettings parted = parted_settings(settings);
    core::set_all(parted.shared, "predictor ", context.config);
    return std::make_unique<PythonPredictor>(context, word, parted.own);
}

}  // namespace clearway::prediction
