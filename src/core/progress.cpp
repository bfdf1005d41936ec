#include "core/progress.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/terminal.hpp"

namespace clearway::core {
namespace {

constexpr std::size_t bar_width = 30;
constexpr std::size_t least_bar_width = 8;

enum class Elapsed : std::uint8_t { shown, left_out };

using Counts = Progress::Counts;

/// By the pace until the last change, less what has passed since then; at least as if the next one ended now.
double left_s(const Counts& counts) {
    const auto all = static_cast<double>(counts.total - counts.before);
    const double share = counts.work.value_or(static_cast<double>(counts.done - counts.before) / all);
    const auto left = [](double of_share, double in_s) { return in_s * (1.0 - of_share) / of_share; };
    if (share <= 0.0) return 0.0;
    return std::max(left(share, counts.elapsed_s - counts.resting_s) - counts.resting_s,
                    left(std::min(1.0, share + 1.0 / all), counts.elapsed_s));
}

std::string words_of(const Counts& counts, Elapsed elapsed = Elapsed::shown) {
    std::string text = fmt::format("{}/{}", counts.done, counts.total);
    if (counts.failed > 0) text += fmt::format(", {} failed", counts.failed);
    if (elapsed == Elapsed::shown) text += ", " + clock_text(counts.elapsed_s) + " elapsed";
    if (counts.done <= counts.before || counts.done >= counts.total) return text;
    if (const double left = left_s(counts); left > 0.0) text += ", " + clock_text(left) + " left";
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

void Progress::set_work(double share) {
    if (work_ != share) changed_ = Clock::now();
    work_ = share;
}

void Progress::update(std::size_t done, std::size_t failed, const std::string& note) {
    if (done_ != done) changed_ = Clock::now();
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

std::string Progress::render_bar(const std::string& label, const Counts& counts, std::size_t width) {
    const auto& [done, total, failed, elapsed_s, before, work, resting_s] = counts;
    double filled = total == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(total);
    if (work && total > 0)
        filled = (static_cast<double>(before) + *work * static_cast<double>(total - before)) /
                 static_cast<double>(total);
    std::string bar(std::min(width, static_cast<std::size_t>(filled * static_cast<double>(width))), '=');
    if (bar.size() < width) bar += '>';
    bar.resize(width, ' ');
    return fmt::format("{} [{}] {}", label, bar, words_of(counts));
}

std::string Progress::line(std::size_t columns) const {
    const Clock::time_point now = Clock::now();
    const auto since_s = [&](Clock::time_point then) {
        return std::chrono::duration<double>(now - then).count();
    };
    const Counts counts{done_, total_, failed_, since_s(started_), before_, work_, since_s(changed_)};
    const std::string note = note_.empty() ? "" : "  " + note_;
    if (style_ == Style::lines) return fmt::format("{}: {}{}\n", label_, words_of(counts), note);
    const auto with_bar = [&](std::size_t width) { return render_bar(label_, counts, width); };
    const std::size_t of_note = std::min(note.size(), note.find(": "));
    const std::size_t length = with_bar(bar_width).size() + of_note;
    const std::size_t too_long = length > columns ? length - columns : 0;
    std::string line = with_bar(bar_width - std::min(too_long, bar_width - least_bar_width));
    for (const Elapsed elapsed : {Elapsed::shown, Elapsed::left_out})
        if (line.size() + of_note > columns) line = label_ + " " + words_of(counts, elapsed);
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
