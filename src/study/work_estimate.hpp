#pragma once

#include <cstddef>
#include <map>
#include <vector>

namespace clearway::study {

/// How much of the work of a study is done, in wall time of its runs, so that a study whose cheap runs come
/// first does not promise too early an end. A cell is a scenario under a condition. A run costs what ended
/// runs of its cell took on average; before that, what was expected of it, corrected by the ratio that ended
/// runs of other cells of its kind have to what was expected of them.
class WorkEstimate {
  public:
    /// What is expected of a cell.
    struct Expected {
        double run_s = 1.0;    ///< Wall time of a run, above 0.
        std::size_t kind = 0;  ///< Runs of other kinds, such as an empty road's, say nothing about its own.
    };
    explicit WorkEstimate(const std::vector<Expected>& cells);

    /// A run is to be made.
    void add(std::size_t cell) { ++cells_[cell].runs; }
    /// A run has ended, after this wall time.
    void end(std::size_t cell, double wall_s);

    /// Wall time of one run.
    double run_s(std::size_t cell) const;
    /// Of the runs that have ended.
    double done_s() const;
    /// Of all that were added.
    double total_s() const;

  private:
    struct Cell {
        Expected expected;
        std::size_t runs = 0;
        std::size_t ended = 0;
        double measured_s = 0.0;  ///< Of all that have ended.
    };
    struct Ended {
        double measured_s = 0.0;
        double expected_s = 0.0;  ///< Of the same runs.
    };
    std::vector<Cell> cells_;
    std::map<std::size_t, Ended> ended_;  ///< By kind.
};

}  // namespace clearway::study
