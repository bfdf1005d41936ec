#include "report/detail/link_figures.hpp"

#include <cmath>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/text.hpp"

namespace clearway::report::detail {
namespace {

constexpr double height = 300.0;
/// With fewer pairs the share of true links in a bin is too uncertain.
constexpr std::uint64_t fewest_pairs = 100;
/// Points closer than this, in figure units, are left out.
constexpr double least_step = 1.5;

std::string decimal(double value, int decimals) {
    return number(value, {decimals, Script::typeset});
}

std::vector<LegendEntry> legend_of(const std::vector<DrawnResult>& drawn) {
    std::vector<LegendEntry> entries;
    for (const DrawnResult& one : drawn)
        entries.push_back(line_entry({one.series}, one.result->predictor));
    return entries;
}

/// Leaves out points too close to the last one drawn.
Points thinned(const Points& points, const Axis& x, const Axis& y) {
    Points kept;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool last = i + 1 == points.size();
        if (!kept.empty() && !last &&
            std::hypot(x.place(points[i].first) - x.place(kept.back().first),
                       y.place(points[i].second) - y.place(kept.back().second)) < least_step)
            continue;
        kept.push_back(points[i]);
    }
    return kept;
}

/// Greatest precision among thresholds that find at least `recall` of the links.
std::string precision_at(const std::vector<links::PrecisionRecall>& curve, double recall) {
    double best = -1.0;
    for (const links::PrecisionRecall& point : curve) {
        if (point.recall >= recall) best = std::max(best, point.precision);
    }
    return best < 0.0 ? missing(Script::typeset) : decimal(best, 3);
}

Points gaps_of(const links::LinkSummary& summary) {
    Points points;
    for (const links::LinkSummary::Calibration& bin : summary.calibration) {
        if (bin.pairs < fewest_pairs) continue;
        const auto pairs = static_cast<double>(bin.pairs);
        const double stated =
            static_cast<double>(bin.probability) * links::LinkSummary::probability_unit / pairs;
        points.emplace_back(stated, static_cast<double>(bin.linked) / pairs - stated);
    }
    return points;
}

std::string age_label(std::size_t age_class) {
    if (age_class + 1 == links::age_classes) return fmt::format("> {:g}", links::age_ends_s[age_class - 1]);
    return fmt::format("\u2264 {:g}", links::age_ends_s[age_class]);
}

}  // namespace

std::string precision_recall_figure(const std::vector<DrawnResult>& drawn) {
    Chart plot("Precision over recall", height, Range(0.5, 1.0), "recall, 0 to 1", Range(0.5, 1.0),
               "precision, 0 to 1");
    DataTable data{{"Predictor", "AP", "precision at recall .80", ".90", ".95", ".98", ".99"}, {}};
    bool any = false;
    for (const DrawnResult& one : drawn) {
        const auto curve = links::precision_recall(one.result->scores.of(links::LinkSubset::all));
        Points points;
        for (const links::PrecisionRecall& point : curve) {
            if (point.recall >= 0.5 && point.precision >= 0.5)
                points.emplace_back(point.recall, point.precision);
        }
        any = any || !curve.empty();
        if (!points.empty()) plot.line(thinned(points, plot.x(), plot.y()), {one.series});
        const auto& ap = one.result->of(links::LinkSubset::all).ap.value;
        std::vector<std::string> row = {one.result->predictor, number_or_dash(ap, typeset(4))};
        for (const double recall : {0.80, 0.90, 0.95, 0.98, 0.99})
            row.push_back(precision_at(curve, recall));
        data.rows.push_back(std::move(row));
    }
    if (!any) return {};
    plot.legend(legend_of(drawn));
    return to_html(Figure{"", "Precision over recall", plot.finish(),
                          "Only the quarter where both are above 0.5 is shown; a predictor without a line "
                          "stays below it.",
                          data});
}

std::string reliability_figure(const std::vector<DrawnResult>& drawn) {
    Range gaps(-0.05, 0.05);
    std::vector<Points> curves;
    for (const DrawnResult& one : drawn) {
        curves.push_back(gaps_of(one.result->scores.of(links::LinkSubset::all)));
        for (const auto& [stated, gap] : curves.back())
            gaps.include(gap);
    }
    Chart plot("Reliability", height, Range(0.0, 1.0), "stated probability, 0 to 1", padded(gaps, 0.04),
               "share of true links minus stated probability, \u22121 to 1");
    DataTable data{{"Predictor", "stated", "share of true links minus it"}, {}};
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        if (!curves[i].empty()) plot.line(curves[i], {drawn[i].series});
        for (const auto& [stated, gap] : curves[i])
            data.rows.push_back({drawn[i].result->predictor, decimal(stated, 3), decimal(gap, 3)});
    }
    if (data.rows.empty()) return {};
    plot.legend(legend_of(drawn));
    return to_html(Figure{"", "Reliability", plot.finish(),
                          fmt::format("Perfect calibration is 0. {} bins of equal width; those with fewer "
                                      "than {} pairs are left out.",
                                      links::calibration_bins, fewest_pairs),
                          data});
}

std::string age_figure(const std::vector<DrawnResult>& drawn) {
    Range values(0.95, 1.0);
    DataTable data{{"Predictor"}, {}};
    for (std::size_t age_class = 0; age_class < links::age_classes; ++age_class)
        data.head.push_back(age_label(age_class) + " s");
    std::vector<Points> curves;
    bool any = false;
    for (const DrawnResult& one : drawn) {
        Points& points = curves.emplace_back();
        std::vector<std::string>& row = data.rows.emplace_back();
        row.push_back(one.result->predictor);
        for (std::size_t age_class = 0; age_class < links::age_classes; ++age_class) {
            const auto ap = links::link_quality(one.result->scores.of_age(age_class)).ap;
            row.push_back(number_or_dash(ap, typeset(4)));
            if (!ap) continue;
            any = true;
            points.emplace_back(static_cast<double>(age_class), *ap);
            values.include(*ap);
        }
    }
    if (!any) return {};
    const double last = static_cast<double>(links::age_classes) - 1.0;
    Plot plot("Average precision by age", height,
              {Range(-0.3, last + 0.3), "age of the older report, s", left_edge, right_edge},
              {padded(values, 0.02), "average precision, 0 to 1", height - label_space, top_edge});
    plot.grid_y();
    for (std::size_t age_class = 0; age_class < links::age_classes; ++age_class) {
        plot.text(plot.x().place(static_cast<double>(age_class)), height - label_space + 16.0,
                  age_label(age_class), Plot::Anchor::middle, "tick");
    }
    plot.text((left_edge + right_edge) / 2.0, height - label_space + 34.0, plot.x().label,
              Plot::Anchor::middle, "axis");
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        if (!curves[i].empty()) plot.line(curves[i], {drawn[i].series});
    }
    plot.legend(legend_of(drawn));
    return to_html(Figure{"", "Average precision by age", plot.finish(), "Pairs by classes of age.", data});
}

}  // namespace clearway::report::detail
