#include "scenario/detail/pedestrians.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "core/error.hpp"
#include "roads/crossings.hpp"
#include "scenario/prepare.hpp"

namespace clearway::scenario::detail {

namespace {

/// Numbers of the random draws for one pedestrian. Never renumber them.
struct Draw {
    enum Number : std::uint64_t { depart, crossing, direction, from, to, from_distance, to_distance, speed };
};

/// Range of distances from the junction at which pedestrians depart and arrive, m, if the sidewalk is long
/// enough. Assumed: far enough to meet a signal in any phase, near enough to cost little time.
constexpr double nearest_m = 5.0;
constexpr double farthest_m = 30.0;
constexpr double slowest_mps = 0.5;
constexpr double fastest_mps = 3.0;

struct Walker {
    double depart_s = 0.0;
    int number = 0;
    std::string xml;
};

std::vector<roads::Crossing> used_crossings(const ScenarioConfig& config, const roads::Network& network) {
    const bool only_signals = config.pedestrians.crossings == Crossings::signals;
    std::vector<roads::Crossing> all = roads::crossings(network);
    const bool has_any = !all.empty();
    if (only_signals) std::erase_if(all, [](const roads::Crossing& row) { return !row.has_signal; });
    if (!all.empty()) return all;
    throw core::InputError(core::Problem{
        config.where("pedestrians.per_hour"),
        has_any ? "the network has no crossing with a signal" : "the network has no crossing for pedestrians",
        "0, or a network with crossings",
        has_any ? "set crossings = \"all\" in [pedestrians]"
                : "import the map with --pedestrians, or give the network sidewalks and crossings"});
}

class Walk {
  public:
    Walk(const DemandContext& context, int number)
        : context_(context), number_(number), id_(fmt::format("pedestrian.{}", number)) {}

    Walker along(const std::vector<roads::Crossing>& crossings) const {
        const roads::Crossing& across = pick(crossings, Draw::crossing);
        const bool forth = draw(Draw::direction) < 0.5;
        const roads::SidewalkEnd start = pick(forth ? across.one_side : across.other_side, Draw::from);
        const roads::SidewalkEnd target = pick(forth ? across.other_side : across.one_side, Draw::to);
        const Pedestrians& people = context_.config.pedestrians;
        const double speed_mps = std::clamp(
            people.speed_mean_mps + people.speed_deviation_mps *
                                        context_.random.normal(core::Purpose::pedestrian, key(), Draw::speed),
            slowest_mps, fastest_mps);
        const double depart_s =
            std::round(draw(Draw::depart) * context_.config.time.window_s * 100.0) / 100.0;
        return {
            depart_s, number_,
            fmt::format(
                "    <person id=\"{}\" type=\"crossing_pedestrian\" depart=\"{:.2f}\" departPos=\"{:.2f}\">"
                "<walk edges=\"{}\" arrivalPos=\"{:.2f}\" speed=\"{:.2f}\"/></person>\n",
                id_, depart_s, position_m(start, Draw::from_distance), edges(start, target),
                position_m(target, Draw::to_distance), speed_mps)};
    }

  private:
    std::uint64_t key() const { return core::vehicle_key(id_).value; }
    double draw(Draw::Number what) const {
        return context_.random.uniform(core::Purpose::pedestrian, key(), what);
    }
    template <class Row>
    const Row& pick(const std::vector<Row>& rows, Draw::Number what) const {
        return rows[context_.random.below(rows.size(), core::Purpose::pedestrian, key(), what)];
    }
    const std::string& edge_id(const roads::SidewalkEnd& sidewalk) const {
        return context_.network.edge(context_.network.lane(sidewalk.lane).edge).id;
    }
    std::string edges(const roads::SidewalkEnd& start, const roads::SidewalkEnd& target) const {
        return edge_id(start) + " " + edge_id(target);
    }
    /// Position along the sidewalk's lane.
    double position_m(const roads::SidewalkEnd& sidewalk, Draw::Number what) const {
        const double length_m = context_.network.lane(sidewalk.lane).length_m;
        const double off_m = std::min(nearest_m + draw(what) * (farthest_m - nearest_m), length_m / 2.0);
        return sidewalk.end == roads::LaneEnd::last ? length_m - off_m : off_m;
    }

    const DemandContext& context_;
    int number_;
    std::string id_;
};

}  // namespace

std::string pedestrians_xml(const DemandContext& context) {
    constexpr double seconds_per_hour = 3600.0;
    const std::vector<roads::Crossing> crossings = used_crossings(context.config, context.network);
    const double hours = context.config.time.window_s / seconds_per_hour;
    const auto count = static_cast<int>(
        std::lround(context.config.pedestrians.per_hour * hours * static_cast<double>(crossings.size())));
    std::vector<Walker> walkers;
    for (int number = 0; number < count; ++number)
        walkers.push_back(Walk(context, number).along(crossings));
    std::ranges::sort(walkers, {}, [](const Walker& row) { return std::tie(row.depart_s, row.number); });
    std::string xml =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<routes>\n"
        "    <vType id=\"crossing_pedestrian\" vClass=\"pedestrian\" speedFactor=\"1\" speedDev=\"0\"/>\n";
    for (const Walker& walker : walkers)
        xml += walker.xml;
    return xml + "</routes>\n";
}

}  // namespace clearway::scenario::detail

namespace clearway::scenario {

void require_crossings(const ScenarioConfig& config, const roads::Network& network) {
    if (config.pedestrians.walk()) detail::used_crossings(config, network);
}

}  // namespace clearway::scenario
