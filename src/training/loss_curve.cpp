#include "training/loss_curve.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/markup.hpp"

namespace clearway::training {
namespace {

constexpr double width = 640, height = 400;
constexpr double left = 70, right = 20, top = 20, bottom = 50;
constexpr double plot_width = width - left - right, plot_height = height - top - bottom;
// Blue and vermilion of Okabe and Ito's palette, told apart by colour-blind readers too; the second is also
// dashed.
constexpr const char* train_style = "stroke=\"#0072b2\"";
constexpr const char* held_out_style = "stroke=\"#d55e00\" stroke-dasharray=\"6 3\"";

/// 1, 2 or 5 times a power of ten, so that `span` has at most about `steps` of them.
double tick_step(double span, double steps) {
    const double power = std::pow(10.0, std::floor(std::log10(span / steps)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (span / (factor * power) <= steps) return factor * power;
    }
    return 10.0 * power;
}

/// From epochs (1 to `epochs`) and losses (0 to `highest`) to points of the image.
struct Scale {
    double epochs = 1, highest = 1;
    double x(double epoch) const {
        return left + plot_width * (epochs > 1 ? (epoch - 1) / (epochs - 1) : 0.5);
    }
    double y(double loss) const { return top + plot_height * (1 - loss / highest); }
};

Scale scale_for(const std::vector<EpochLoss>& losses) {
    double highest = 0;
    for (const EpochLoss& loss : losses) {
        for (const double value : {loss.train, loss.held_out}) {
            if (std::isfinite(value)) highest = std::max(highest, value);
        }
    }
    return {static_cast<double>(std::max<std::size_t>(losses.size(), 1)), highest > 0 ? highest * 1.05 : 1.0};
}

std::string axes(const Scale& scale) {
    std::string svg = fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
        "stroke=\"#888\"/>\n",
        left, top, plot_width, plot_height);
    const double loss_step = tick_step(scale.highest, 6);
    for (int tick = 0; tick * loss_step <= scale.highest; ++tick) {
        const double y = scale.y(tick * loss_step);
        svg += fmt::format(
            "<path d=\"M{:.1f} {:.1f}h-5\" stroke=\"#888\"/><text x=\"{:.1f}\" y=\"{:.1f}\" "
            "text-anchor=\"end\">{:g}</text>\n",
            left, y, left - 8, y + 4, tick * loss_step);
    }
    const double epoch_step = std::max(1.0, tick_step(std::max(scale.epochs, 1.0), 10));
    for (double epoch = epoch_step; epoch <= scale.epochs; epoch += epoch_step) {
        svg += fmt::format(
            "<path d=\"M{:.1f} {:.1f}v5\" stroke=\"#888\"/><text x=\"{:.1f}\" y=\"{:.1f}\" "
            "text-anchor=\"middle\">{:g}</text>\n",
            scale.x(epoch), height - bottom, scale.x(epoch), height - bottom + 19, epoch);
    }
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">Epoch</text>\n",
                       left + plot_width / 2, height - 10);
    svg += fmt::format(
        "<text x=\"16\" y=\"{0:.1f}\" text-anchor=\"middle\" transform=\"rotate(-90 16 {0:.1f})\">Loss "
        "(nat)</text>\n",
        top + plot_height / 2);
    return svg;
}

std::string curve(const std::vector<EpochLoss>& losses, double EpochLoss::*member, const Scale& scale,
                  const char* style) {
    std::string path;
    bool pen_is_down = false;
    for (std::size_t epoch = 0; epoch < losses.size(); ++epoch) {
        const double loss = losses[epoch].*member;
        if (std::isfinite(loss)) {
            path += fmt::format("{}{:.1f} {:.1f}", pen_is_down ? 'L' : 'M',
                                scale.x(static_cast<double>(epoch) + 1), scale.y(loss));
        }
        pen_is_down = std::isfinite(loss);
    }
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke-width=\"2\" {}/>\n", path, style);
}

std::string legend_entry(double y, const std::string& label, const char* style) {
    return fmt::format(
        "<path d=\"M{:.1f} {:.1f}h30\" stroke-width=\"2\" {}/><text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
        width - right - 170, y, style, width - right - 132, y + 4, core::escaped(label));
}

}  // namespace

std::string loss_curve_svg(const std::vector<EpochLoss>& losses, const std::string& held_out_label) {
    const Scale scale = scale_for(losses);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
        "height=\"{1:g}\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n<title>Train-test curve</title>\n"
        "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#fff\"/>\n",
        width, height);
    svg += axes(scale);
    svg += curve(losses, &EpochLoss::train, scale, train_style);
    svg += curve(losses, &EpochLoss::held_out, scale, held_out_style);
    svg += legend_entry(top + 16, "Train Loss", train_style) +
           legend_entry(top + 34, held_out_label, held_out_style);
    return svg + "</svg>\n";
}

}  // namespace clearway::training
