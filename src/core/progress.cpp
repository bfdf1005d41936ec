#include "core/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "core/terminal.hpp"

namespace clearway::core {
namespace {

constexpr std::size_t bar_width = 30;
constexpr std::size_t least_bar_width = 8;

std::string counts(std::size_t done, std::size_t total, std::size_t failed, double elapsed_s,
                   std::size_t before) {
    std::string text = fmt::format("{}/{}", done, total);
    if (failed > 0) text += fmt::format(", {} failed", failed);
    text += ", " + clock_text(elapsed_s) + " elapsed";
    if (done > before && done < total) {
        const double left_s =
            elapsed_s * static_cast<double>(total - done) / static_cast<double>(done - before);
        text += ", " + clock_text(left_s) + " left";
    }
    return text;
}

}  // namespace

std::string clock_text(double seconds) {
    const auto whole = std::lround(std::max(0.0, seconds));
    if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

Progress::Progress(std::string label, std::size_t total, Style style)
    : label_(std::move(label)), total_(total), style_(style) {}

Progress::Style Progress::style_for_stderr() {
    return ::isatty(STDERR_FILENO) != 0 ? Style::bar : Style::lines;
}

void Progress::update(std::size_t done, std::size_t failed, const std::string& note) {
    done_ = done;
    failed_ = failed;
    note_ = note;
    const auto interval = style_ == Style::bar ? std::chrono::milliseconds(100) : std::chrono::seconds(10);
    const auto last = ever_printed_ ? printed_ : started_;
    if (Clock::now() - last >= interval) print();
}

void Progress::finish() {
    print();
    end_drawn_line();
}

Progress::~Progress() {
    if (style_ == Style::bar) end_drawn_line();
}

// NOLINTNEXTLINE(readability-function-size): what a line shows
std::string Progress::render_bar(const std::string& label, std::size_t done, std::size_t total,
                                 std::size_t failed, double elapsed_s, std::size_t before,
                                 std::size_t width) {
    const std::size_t filled = total == 0 ? width : std::min(width, width * done / total);
    std::string bar(filled, '=');
    if (filled < width) bar += '>';
    bar.resize(width, ' ');
    return fmt::format("{} [{}] {}", label, bar, counts(done, total, failed, elapsed_s, before));
}

std::string Progress::line(std::size_t columns) const {
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - started_).count();
    const std::string note = note_.empty() ? "" : "  " + note_;
    if (style_ == Style::lines)
        return fmt::format("{}: {}{}\n", label_, counts(done_, total_, failed_, elapsed_s, before_), note);
    const auto with_bar = [&](std::size_t width) {
        return render_bar(label_, done_, total_, failed_, elapsed_s, before_, width) + note;
    };
    // Shorten the bar first, then the note.
    const std::size_t length = with_bar(bar_width).size();
    const std::size_t too_long = length > columns ? length - columns : 0;
    const std::size_t width = bar_width - std::min(too_long, bar_width - least_bar_width);
    return cut_to_columns(with_bar(width), columns);
}

void Progress::print() {
    if (style_ == Style::silent) return;
    if (style_ == Style::bar) {
        draw_line(line(terminal_columns() - 1));
    } else {
        print_message(line(0));
    }
    printed_ = Clock::now();
    ever_printed_ = true;
}

}  // namespace clearway::core
