#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "report/detail/axes.hpp"
#include "report/detail/figures.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report::detail {
namespace {

Points zipped(const std::vector<double>& x, const std::vector<double>& y) {
    // For long trainings: about as many points as the figure has units.
    const std::size_t stride = std::max<std::size_t>(1, x.size() / 400);
    Points points;
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
        return {losses, "loss, nat"};
    }
    Range exponents;
    exponents.include(std::floor(std::log10(std::max(smallest, losses.low))));
    exponents.include(std::ceil(std::log10(losses.high)));
    return {exponents, fmt::format("loss, nat, in decades; below {:g} at the bottom", smallest), 0.0, 0.0,
            Scale::logarithmic};
}

Figure loss_figure(const LossCurve& curve) {
    if (curve.epoch.empty()) return {};
    Range epochs;
    for (const double epoch : curve.epoch) {
        epochs.include(epoch);
    }
    if (epochs.high <= epochs.low) epochs = padded(epochs, 0.0);
    Chart plot(fmt::format("Train and test loss: {}", curve.title), 270.0, {epochs, "epoch, number"},
               loss_axis(curve));
    std::vector<LegendEntry> entries = {line_entry({1}, "train"), line_entry({2}, curve.held_out)};
    if (curve.constant_loss) {
        plot.line({{epochs.low, *curve.constant_loss}, {epochs.high, *curve.constant_loss}}, {3});
        entries.push_back(line_entry({3}, "best constant answer"));
    }
    plot.line(zipped(curve.epoch, curve.train), {1});
    plot.line(zipped(curve.epoch, curve.test), {2});
    DataTable data{{"epoch", "train loss", curve.held_out + " loss"}, {}};
    for (std::size_t row = 0; row < curve.epoch.size(); ++row) {
        data.rows.push_back({number(curve.epoch[row], typeset(0)), number(curve.train[row], typeset(4)),
                             number(curve.test[row], typeset(4))});
    }
    plot.legend(entries);
    return {"training-" + curve.title, curve.title, plot.finish(), curve.note, std::move(data)};
}

}  // namespace

void training_section(const StudyFacts& study, Writer& writer) {
    writer.markup(
        "<p>Train and test loss over the epochs (the dissertation\u2019s Fig. 4). Its text does not say "
        "whether the list of pairs holds only true links, so the network as published is trained both ways. "
        "A list of true links alone gives a low loss whatever the network learns: the constant answer 1 "
        "reaches it too.</p>\n");
    std::vector<Figure> figures;
    for (const LossCurve& curve : study.curves)
        figures.push_back(loss_figure(curve));
    writer.figures(std::move(figures));
}

}  // namespace clearway::report::detail
