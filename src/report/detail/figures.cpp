#include "report/detail/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/markup.hpp"
#include "report/published.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

constexpr std::array forest_measures = {Measure::emergency_restricted_time, Measure::emergency_waiting_time,
                                        Measure::other_time_loss};
constexpr double forest_right = 250.0;  // the numbers are to the right of the drawing
constexpr double heading_height = 28.0;
constexpr double row_height = 34.0;

Range forest_range(const ScenarioFacts& scenario, std::size_t& compared) {
    Range range;
    range.include(0.0);
    compared = 0;
    for (const ConditionFacts& condition : scenario.conditions) {
        if (!condition.is_compared()) continue;
        ++compared;
        for (const Measure measure : forest_measures) {
            const Estimate& difference = condition.outcome(measure).difference;
            if (difference.mean) range.include(*difference.mean);
            if (difference.has_interval()) {
                range.include(*difference.low);
                range.include(*difference.high);
            }
        }
    }
    return range;
}

void draw_forest_row(Plot& plot, const ConditionFacts& condition, const Outcome& outcome, double top,
                     std::size_t series) {
    const Estimate& difference = outcome.difference;
    plot.text(10.0, top + 11.0, condition.label(), Plot::Anchor::start, "label");
    plot.text(right_edge, top + 26.0, estimate(difference, typeset(1, Sign::always)), Plot::Anchor::end,
              "value");
    if (!difference.mean) return;
    if (difference.has_interval()) {
        plot.interval({*difference.low, *difference.high}, *difference.mean, top + 22.0, series);
    } else {
        plot.point(*difference.mean, top + 22.0, series);
    }
}

DataTable forest_data(const ScenarioFacts& scenario) {
    DataTable table{{"Measure, condition", "difference, s", "low 95 %", "high 95 %", "pairs"}, {}};
    for (const Measure measure : forest_measures) {
        for (const ConditionFacts& condition : scenario.conditions) {
            if (!condition.is_compared()) continue;
            const Estimate& difference = condition.outcome(measure).difference;
            const auto cell = [](const std::optional<double>& value) {
                return value ? number(*value, typeset(2, Sign::always)) : missing(Script::typeset);
            };
            table.rows.push_back({fmt::format("{}, {}", info(measure).title, condition.label()),
                                  cell(difference.mean), cell(difference.low), cell(difference.high),
                                  grouped(difference.count)});
        }
    }
    return table;
}

std::vector<std::pair<double, double>> steps(const Distribution& distribution, double last) {
    std::vector<std::pair<double, double>> points;
    double share = 0.0;
    for (const SharePoint& point : distribution.points) {
        points.emplace_back(point.seconds, share);
        points.emplace_back(point.seconds, point.share);
        share = point.share;
    }
    points.emplace_back(last, share);
    return points;
}

/// Seconds within which `share` of all EVs arrived; a dash if fewer did.
std::string seconds_at(const Distribution& distribution, double share) {
    for (const SharePoint& point : distribution.points) {
        if (point.share >= share - 1e-9) return number(point.seconds, typeset(1));
    }
    return missing(Script::typeset);
}

DataTable distribution_data(const ScenarioFacts& scenario) {
    DataTable table{{"Condition", "EVs", "arrived", "10 % within, s", "25 %", "50 %", "75 %", "90 %", "95 %",
                     "median [95 %], s", "95th percentile [95 %], s"},
                    {}};
    for (const ConditionFacts& condition : scenario.conditions) {
        const Distribution& distribution = condition.travel_time;
        std::vector<std::string> row = {condition.label(), grouped(distribution.all),
                                        grouped(distribution.arrived)};
        for (const double share : {0.10, 0.25, 0.50, 0.75, 0.90, 0.95}) {
            row.push_back(seconds_at(distribution, share));
        }
        row.push_back(estimate(condition.travel_time_median, typeset(1)));
        row.push_back(estimate(condition.travel_time_percentile_95, typeset(1)));
        table.rows.push_back(std::move(row));
    }
    return table;
}

std::string distribution_note(const ScenarioFacts& scenario) {
    std::string note =
        "Share of all EVs of the demand, so a curve that ends below 1 shows EVs that did not arrive. "
        "Replications are pooled; the intervals under Data come from resampling whole replications.";
    const bool thinned =
        std::any_of(scenario.conditions.begin(), scenario.conditions.end(),
                    [](const auto& one) { return one.travel_time.arrived > one.travel_time.points.size(); });
    if (thinned) {
        note += fmt::format(" Drawn at {} ranks, evenly spaced; the steps between them are left out.",
                            distribution_points);
    }
    return note;
}

std::vector<std::pair<double, double>> zipped(const std::vector<double>& x, const std::vector<double>& y) {
    // For long trainings: about as many points as the figure has units.
    const std::size_t stride = std::max<std::size_t>(1, x.size() / 400);
    std::vector<std::pair<double, double>> points;
    for (std::size_t row = 0; row < x.size(); row += stride) {
        if (std::isfinite(y[row])) points.emplace_back(x[row], y[row]);
    }
    if (!x.empty() && (x.size() - 1) % stride != 0 && std::isfinite(y.back())) {
        points.emplace_back(x.back(), y.back());
    }
    return points;
}

/// Linear from 0, or logarithmic down to `smallest` if the largest loss is more than a hundred times the
/// last, because most of the curve would then lie along the bottom.
Axis loss_axis(const LossCurve& curve) {
    constexpr double smallest = 1e-4;
    Range losses;
    for (const std::vector<double>* const column : {&curve.train, &curve.test}) {
        for (const double loss : *column) {
            losses.include(loss);
        }
    }
    if (curve.constant_loss) losses.include(*curve.constant_loss);
    const bool decades = losses.high > 100.0 * std::max(smallest, curve.train.back());
    if (!decades) {
        losses.low = 0.0;
        losses.high = losses.high > 0.0 ? losses.high * 1.05 : 1.0;
        return {losses, "loss, nat", 0.0, 0.0};
    }
    Range exponents;
    exponents.include(std::floor(std::log10(std::max(smallest, losses.low))));
    exponents.include(std::ceil(std::log10(losses.high)));
    return {exponents, fmt::format("loss, nat, in decades; below {:g} at the bottom", smallest), 0.0, 0.0,
            Scale::logarithmic};
}

}  // namespace

std::string forest_figure(const ScenarioFacts& scenario) {
    std::size_t compared = 0;
    const Range range = forest_range(scenario, compared);
    if (compared == 0) return {};
    const double rows = static_cast<double>(compared * forest_measures.size()) * row_height +
                        heading_height * forest_measures.size();
    const double height = rows + 10.0 + label_space;
    Plot plot(fmt::format("{}: paired differences to the baseline", scenario.name), height,
              {padded(range, 0.06), "difference to the baseline, s", 10.0, forest_right},
              {{}, "", 6.0, height - label_space});
    plot.grid_x();
    plot.vertical(0.0);
    double top = 6.0;
    for (const Measure measure : forest_measures) {
        plot.text(10.0, top + 18.0, info(measure).title, Plot::Anchor::start, "heading");
        top += heading_height;
        for (std::size_t row = 0; row < scenario.conditions.size(); ++row) {
            const ConditionFacts& condition = scenario.conditions[row];
            if (!condition.is_compared()) continue;
            draw_forest_row(plot, condition, condition.outcome(measure), top, row);
            top += row_height;
        }
    }
    return to_html(Figure{scenario.name, plot.finish(), "", "", forest_data(scenario)});
}

std::string distribution_figure(const ScenarioFacts& scenario) {
    Range range;
    for (const ConditionFacts& condition : scenario.conditions) {
        for (const SharePoint& point : condition.travel_time.points) {
            range.include(point.seconds);
        }
    }
    if (range.empty()) return {};
    const double height = 300.0;
    Range shares;
    shares.include(0.0);
    shares.include(1.0);
    Plot plot(fmt::format("{}: distribution of EV travel time", scenario.name), height,
              {padded(range, 0.04), "EV travel time, s", left_edge, right_edge},
              {shares, "share of EVs that arrived within", height - label_space, 26.0});
    plot.grid_x();
    plot.grid_y();
    std::vector<std::pair<std::size_t, std::string>> entries;
    for (std::size_t row = 0; row < scenario.conditions.size(); ++row) {
        const ConditionFacts& condition = scenario.conditions[row];
        entries.emplace_back(row, condition.label());
        if (!condition.travel_time.points.empty()) {
            plot.line(steps(condition.travel_time, plot.x().values.high), row);
        }
    }
    return to_html(Figure{scenario.name, plot.finish(), legend(entries), distribution_note(scenario),
                          distribution_data(scenario)});
}

std::string loss_figure(const LossCurve& curve) {
    if (curve.epoch.empty()) return {};
    Range epochs;
    for (const double epoch : curve.epoch) {
        epochs.include(epoch);
    }
    if (epochs.high <= epochs.low) epochs = padded(epochs, 0.0);
    const double height = 270.0;
    Axis losses = loss_axis(curve);
    losses.from = height - label_space;
    losses.to = 26.0;
    Plot plot(fmt::format("Train and test loss: {}", curve.title), height,
              {epochs, "epoch", left_edge, right_edge}, losses);
    plot.grid_x();
    plot.grid_y();
    std::vector<std::pair<std::size_t, std::string>> entries = {{1, "train"}, {2, curve.held_out}};
    if (curve.constant_loss) {
        plot.line({{epochs.low, *curve.constant_loss}, {epochs.high, *curve.constant_loss}}, 3);
        entries.emplace_back(3, "best constant answer");
    }
    plot.line(zipped(curve.epoch, curve.train), 1);
    plot.line(zipped(curve.epoch, curve.test), 2);
    DataTable data{{"epoch", "train loss", curve.held_out + " loss"}, {}};
    for (std::size_t row = 0; row < curve.epoch.size(); ++row) {
        data.rows.push_back({number(curve.epoch[row], typeset(0)), number(curve.train[row], typeset(4)),
                             number(curve.test[row], typeset(4))});
    }
    return to_html(Figure{curve.title, plot.finish(), legend(entries), curve.note, data});
}

std::string network_figure(const ScenarioFacts& scenario) {
    if (scenario.network_svg.empty()) return {};
    DataTable wide{{"edge", "street", "lanes for cars"}, {}, DataTable::Cells::words};
    for (const WideEdge& edge : scenario.wide_edges.value_or(std::vector<WideEdge>{})) {
        wide.rows.push_back({edge.edge, edge.street, std::to_string(edge.car_lanes)});
    }
    std::string note = wide_edges_sentence(scenario);
    if (!note.empty() && !scenario.attribution.empty()) note += ' ';
    const std::optional<PublishedTable> published = published_table(scenario.name);
    const std::string title =
        published ? fmt::format("{} ({} of the dissertation)", scenario.name, published->figure)
                  : scenario.name;
    return to_html(Figure{title, scenario.network_svg, "", note + scenario.attribution, std::move(wide)});
}

}  // namespace clearway::report::detail
