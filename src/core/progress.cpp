#include "core/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace clearway::core {
namespace {

constexpr std::size_t bar_width = 30;

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
    if (Clock::now() - last >= interval) print(false);
}

void Progress::finish() {
    print(true);
}

// NOLINTNEXTLINE(readability-function-size): what a line shows
std::string Progress::render_bar(const std::string& label, std::size_t done, std::size_t total,
                                 std::size_t failed, double elapsed_s, std::size_t before) {
    const std::size_t filled = total == 0 ? bar_width : std::min(bar_width, bar_width * done / total);
    std::string bar(filled, '=');
    if (filled < bar_width) bar += '>';
    bar.resize(bar_width, ' ');
    return fmt::format("{} [{}] {}", label, bar, counts(done, total, failed, elapsed_s, before));
}

void Progress::print(bool final) {
    if (style_ == Style::silent) return;
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - started_).count();
    const std::string note = note_.empty() ? "" : "  " + note_;
    if (style_ == Style::bar) {
        fmt::print(stderr, "\r{}{}\x1b[K{}", render_bar(label_, done_, total_, failed_, elapsed_s, before_),
                   note, final ? "\n" : "");
    } else {
        fmt::print(stderr, "{}: {}{}\n", label_, counts(done_, total_, failed_, elapsed_s, before_), note);
    }
    std::fflush(stderr);
    printed_ = Clock::now();
    ever_printed_ = true;
}

}  // namespace clearway::core
