#include "study/work_estimate.hpp"

namespace clearway::study {

WorkEstimate::WorkEstimate(const std::vector<Expected>& cells) {
    for (const Expected& expected : cells)
        cells_.push_back({.expected = expected});
}

void WorkEstimate::end(std::size_t cell, double wall_s) {
    Cell& own = cells_[cell];
    ++own.ended;
    own.measured_s += wall_s;
    Ended& alike = ended_[own.expected.kind];
    alike.measured_s += wall_s;
    alike.expected_s += own.expected.run_s;
}

double WorkEstimate::run_s(std::size_t cell) const {
    const Cell& own = cells_[cell];
    if (own.ended > 0) return own.measured_s / static_cast<double>(own.ended);
    const auto alike = ended_.find(own.expected.kind);
    if (alike == ended_.end()) return own.expected.run_s;
    return own.expected.run_s * alike->second.measured_s / alike->second.expected_s;
}

double WorkEstimate::done_s() const {
    double sum_s = 0.0;
    for (const auto& [kind, ended] : ended_)
        sum_s += ended.measured_s;
    return sum_s;
}

double WorkEstimate::total_s() const {
    double sum_s = 0.0;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell)
        sum_s += static_cast<double>(cells_[cell].runs) * run_s(cell);
    return sum_s;
}

}  // namespace clearway::study
