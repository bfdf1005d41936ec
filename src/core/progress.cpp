#include "core/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "core/terminal.hpp"

namespace clearway::core {
namespace {

constexpr std::size_t bar_width = 30;
constexpr std::size_t least_bar_width = 8;

enum class Elapsed : std::uint8_t { shown, left_out };

struct Counts {
    std::size_t done = 0;
    std::size_t total = 0;
    std::size_t failed = 0;
    double elapsed_s = 0.0;
    std::size_t before = 0;      ///< Done when the clock started.
    std::optional<double> work;  ///< Share of the work that is done, if it is known.
};

std::string words_of(const Counts& counts, Elapsed elapsed = Elapsed::shown) {
    const auto& [done, total, failed, elapsed_s, before, work] = counts;
    std::string text = fmt::format("{}/{}", done, total);
    if (failed > 0) text += fmt::format(", {} failed", failed);
    if (elapsed == Elapsed::shown) text += ", " + clock_text(elapsed_s) + " elapsed";
    if (done <= before || done >= total) return text;
    const double share =
        work.value_or(static_cast<double>(done - before) / static_cast<double>(total - before));
    if (share > 0.0) text += ", " + clock_text(elapsed_s * (1.0 - share) / share) + " left";
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
    return can_redraw() ? Style::bar : Style::lines;
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
                                 std::size_t failed, double elapsed_s, std::size_t before, std::size_t width,
                                 std::optional<double> work) {
    double filled = total == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(total);
    if (work && total > 0)
        filled = (static_cast<double>(before) + *work * static_cast<double>(total - before)) /
                 static_cast<double>(total);
    std::string bar(std::min(width, static_cast<std::size_t>(filled * static_cast<double>(width))), '=');
    if (bar.size() < width) bar += '>';
    bar.resize(width, ' ');
    return fmt::format("{} [{}] {}", label, bar, words_of({done, total, failed, elapsed_s, before, work}));
}

std::string Progress::line(std::size_t columns) const {
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - started_).count();
    const std::string note = note_.empty() ? "" : "  " + note_;
    const auto counted = [&](Elapsed elapsed) {
        return words_of({done_, total_, failed_, elapsed_s, before_, work_}, elapsed);
    };
    if (style_ == Style::lines) return fmt::format("{}: {}{}\n", label_, counted(Elapsed::shown), note);
    const auto with_bar = [&](std::size_t width) {
        return render_bar(label_, done_, total_, failed_, elapsed_s, before_, width, work_);
    };
    const std::size_t of_note = std::min(note.size(), note.find(": "));
    const std::size_t length = with_bar(bar_width).size() + of_note;
    const std::size_t too_long = length > columns ? length - columns : 0;
    std::string line = with_bar(bar_width - std::min(too_long, bar_width - least_bar_width));
    for (const Elapsed elapsed : {Elapsed::shown, Elapsed::left_out})
        if (line.size() + of_note > columns) line = label_ + " " + counted(elapsed);
    return cut_to_columns(line + note, columns);
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
