#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace clearway::core {

/// Progress of a long job on standard error: a bar that is redrawn on a terminal and never wraps, otherwise
/// one line per 10 s, and a last line at the end. Times left are estimated from the work done so far, or from
/// the counts where no work is given.
class Progress {
  public:
    enum class Style { bar, lines, silent };

    /// `style_for_stderr()` chooses between bar and lines.
    Progress(std::string label, std::size_t total, Style style);
    /// Ends a drawn line, so that what is printed next begins below it.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// The bar where `can_redraw`, else lines.
    static Style style_for_stderr();

    /// Work done before this job began; it is left out of the estimate of the time left.
    void begin_at(std::size_t done) { before_ = done; }
    /// For a job whose size becomes known on the way.
    void expect(std::size_t total) { total_ = total; }
    /// Call as often as convenient; output is limited to 10 a second (bar) or one per 10 s (lines). `note` is
    /// a short extra text, for example the current estimate of the headline metric.
    void update(std::size_t done, std::size_t failed, const std::string& note = {});
    /// Share of the work of this job that is done, 0 to 1, for bar and time left.
    void set_work(double share);
    /// Prints the final state and ends the line.
    void finish();

    /// What a line shows.
    struct Counts {
        std::size_t done = 0;
        std::size_t total = 0;
        std::size_t failed = 0;
        double elapsed_s = 0.0;
        std::size_t before = 0;           ///< Done when the clock started.
        std::optional<double> work = {};  ///< Share of the work that is done, if it is known.
        double resting_s = 0.0;           ///< Since the counts last changed.
    };
    /// `label  [=====>    ] 120/300, 2 failed, 1:05 elapsed, 1:40 left  note`. The time left passes while
    /// nothing ends, as long as the next end may still come at the pace so far. Pure, for tests.
    static std::string render_bar(const std::string& label, const Counts& counts, std::size_t width = 30);
    /// The line as it is printed now. With a bar it has at most `columns` characters: the bar is shortened,
    /// then left out, then the time elapsed, so that the note stays up to its first `: `; then it is cut.
    std::string line(std::size_t columns) const;

  private:
    using Clock = std::chrono::steady_clock;
    void print();

    std::string label_;
    std::size_t total_;
    Style style_;
    std::size_t done_ = 0;
    std::size_t before_ = 0;
    std::size_t failed_ = 0;
    std::optional<double> work_;
    std::string note_;
    Clock::time_point started_ = Clock::now();
    Clock::time_point changed_ = started_;
    Clock::time_point printed_{};
    bool ever_printed_ = false;
};

/// `0:07`, `12:34`, `1:02:03`.
std::string clock_text(double seconds);

}  // namespace clearway::core
