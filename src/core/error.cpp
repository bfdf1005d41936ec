#include "core/error.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clearway::core {
namespace {

std::string format_all(const std::vector<Problem>& problems) {
    std::string text;
    for (const Problem& problem : problems) {
        text += (text.empty() ? "" : "\n") + format_problem(problem);
    }
    return text;
}

/// Levenshtein distance, one row at a time.
std::size_t edit_distance(const std::string& left, const std::string& right) {
    std::vector<std::size_t> row(right.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= left.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= right.size(); ++j) {
            const std::size_t substituted = diagonal + (left[i - 1] == right[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
        }
    }
    return row.back();
}

}  // namespace

InputError::InputError(std::vector<Problem> problems)
    : Error(ExitCode::bad_input, format_all(problems)), problems_(std::move(problems)) {}

InputError::InputError(Problem problem) : InputError(std::vector<Problem>{std::move(problem)}) {}

SimulatorError SimulatorError::with_context(const std::string& context) const {
    return SimulatorError(context + ": " + what());
}

std::string format_problem(const Problem& problem) {
    std::string text = fmt::format("{}: {}", problem.where, problem.what);
    if (!problem.allowed.empty()) text += fmt::format(" (allowed: {})", problem.allowed);
    if (!problem.cure.empty()) text += fmt::format(". {}", problem.cure);
    return text;
}

std::string listed(const std::vector<std::string>& words) {
    return fmt::format("{}", fmt::join(words, ", "));
}

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
    std::string best;
    // At most two letters or a third of the word, and never all of it.
    const std::size_t most = std::max(std::min<std::size_t>(2, word.size() / 2), word.size() / 3);
    std::size_t best_distance = most + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best_distance) {
            best_distance = distance;
            best = candidate;
        }
    }
    if (best_distance <= 1) return best;
    // The beginning of one word alone: `traj` for `trajectories`.
    const auto begins = [&](const std::string& candidate) { return candidate.starts_with(word); };
    constexpr std::size_t least_letters = 3;
    const bool is_one = word.size() >= least_letters && std::ranges::count_if(candidates, begins) == 1;
    return is_one ? *std::ranges::find_if(candidates, begins) : best;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates,
                         const std::string& otherwise) {
    const std::string near = nearest(word, candidates);
    return near.empty() ? otherwise : fmt::format("Did you mean '{}'?", near);
}

}  // namespace clearway::core
