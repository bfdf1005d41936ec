#include "study/work_estimate.hpp"

namespace clearway::study {

WorkEstimate::WorkEstimate(std::vector<double> expected_s) {
    for (const double run_s : expected_s)
        cells_.push_back({.expected_s = run_s});
}

void WorkEstimate::end(std::size_t cell, double wall_s) {
    ++cells_[cell].ended;
    cells_[cell].measured_s += wall_s;
    measured_s_ += wall_s;
    expected_s_ += cells_[cell].expected_s;
}

double WorkEstimate::run_s(std::size_t cell) const {
    const Cell& own = cells_[cell];
    if (own.ended > 0) return own.measured_s / static_cast<double>(own.ended);
    return expected_s_ > 0.0 ? own.expected_s * measured_s_ / expected_s_ : own.expected_s;
}

double WorkEstimate::done_s() const {
    return measured_s_;
}

double WorkEstimate::total_s() const {
    double sum_s = 0.0;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell)
        sum_s += static_cast<double>(cells_[cell].runs) * run_s(cell);
    return sum_s;
}

}  // namespace clearway::study
