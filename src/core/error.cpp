#include "core/error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clearway::core {
namespace {

/// The first places, and how many more there are.
std::string some_of(const std::vector<std::string>& places) {
    constexpr std::size_t most_shown = 2;
    if (places.size() <= most_shown) return fmt::format("{}", fmt::join(places, " and "));
    return fmt::format("{} and {} more", places.front(), places.size() - 1);
}

/// Text from a file may hold what ends a C string or commands a terminal: `\x00`, `\x1b`, in UTF-8 also
/// U+009B.
std::string visible(const std::string& text) {
    constexpr std::string_view whitespace = "\n\t";
    std::string shown;
    for (std::size_t at = 0; at < text.size(); ++at) {
        auto code = static_cast<unsigned char>(text[at]);
        const auto next = static_cast<unsigned char>(at + 1 < text.size() ? text[at + 1] : '\0');
        const bool is_wide = code == 0xc2 && next >= 0x80 && next < 0xa0;
        if (is_wide) {
            code = next;
            ++at;
        }
        const bool is_control =
            is_wide || code == 0x7f || (code < 0x20 && whitespace.find(text[at]) == std::string_view::npos);
        shown += is_control ? fmt::format("\\x{:02x}", code) : std::string(1, text[at]);
    }
    return shown;
}

/// `where: what (allowed: ...). cure`; behind several lines, as of a syntax error, the cure has its own.
std::string text_of(const Problem& problem) {
    std::string text = fmt::format("{}: {}", problem.where, problem.what);
    if (!problem.allowed.empty()) text += fmt::format(" (allowed: {})", problem.allowed);
    if (problem.cure.empty()) return text;
    const bool has_lines = problem.what.find('\n') != std::string::npos;
    // Another's message may end with its own question.
    text += has_lines ? "\n  " : text.back() == '?' ? " " : ". ";
    const std::string word = problem.cure.substr(0, problem.cure.find(' '));
    const bool is_name = word == "clearway" || word.find_first_of("_.=/") != std::string::npos;
    const std::size_t begin = text.size();
    text += problem.cure;
    if (!is_name) text[begin] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[begin])));
    return text;
}

/// An equal problem is told once; so is one of several places that comes with a long list of what is allowed.
std::vector<Problem> each_once(const std::vector<Problem>& problems) {
    std::vector<Problem> told;
    std::map<std::string, std::vector<std::string>> places;  // by the problem without its place
    const auto kind_of = [](Problem one) {
        constexpr std::size_t long_list = 100;
        if (one.allowed.size() > long_list) one.where.clear();
        return format_problem(one);
    };
    for (const Problem& one : problems) {
        std::vector<std::string>& known = places[kind_of(one)];
        if (known.empty()) told.push_back(one);
        if (!core::contains(known, one.where)) known.push_back(one.where);
    }
    for (Problem& one : told)
        one.where = some_of(places.at(kind_of(one)));
    return told;
}

std::string format_all(const std::vector<Problem>& problems) {
    return fmt::format("{}", fmt::join(texts_of(each_once(problems), format_problem), "\n"));
}

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char letter) { return std::tolower(letter); });
    return text;
}

/// The command line says `--seeds` and study files `replications`; `seed` is neither.
bool counts_runs(const std::string& word) {
    constexpr std::array words = {"seeds", "replications", "repetitions"};
    return core::contains(words, word.substr(std::min(word.find_first_not_of('-'), word.size())));
}

/// The words between underscores; what users call an EV is `emergency` in names.
std::vector<std::string> parts_of(const std::string& word) {
    std::vector<std::string> parts;
    for (std::size_t start = 0; start <= word.size();) {
        const std::size_t end = std::min(word.find('_', start), word.size());
        const std::string part = word.substr(start, end - start);
        if (!part.empty()) parts.push_back(part == "ev" ? "emergency" : part);
        start = end + 1;
    }
    return parts;
}

/// Letters to insert, leave out, replace or exchange with the next one (optimal string alignment), row by
/// row.
std::size_t edit_distance(const std::string& left, const std::string& right) {
    std::vector<std::size_t> before, last, row(right.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= left.size(); ++i) {
        before = std::exchange(last, row);
        row[0] = i;
        for (std::size_t j = 1; j <= right.size(); ++j) {
            const std::size_t substituted = last[j - 1] + (left[i - 1] == right[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, substituted});
            if (i > 1 && j > 1 && left[i - 1] == right[j - 2] && left[i - 2] == right[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row.back();
}

/// `Did you mean 'a', 'b' or 'c'?` with candidates that contain all parts of the word, but for a letter of a
/// long one or of a short one beside others; three at most. Empty without one.
std::string question_of_parts(const std::string& word, const std::vector<std::string>& candidates) {
    constexpr std::size_t least_letters = 4;
    constexpr std::size_t most_candidates = 3;
    const std::vector<std::string> parts = parts_of(word);
    std::vector<std::string> found;
    for (const std::string& candidate : candidates) {
        const std::vector<std::string> own = parts_of(candidate);
        const bool has_all = !parts.empty() && std::ranges::all_of(parts, [&](const std::string& part) {
            return candidate.find(part) != std::string::npos ||
                   (part.size() > (parts.size() > 1 ? 2 : least_letters) &&
                    std::ranges::any_of(
                        own, [&](const std::string& one) { return edit_distance(part, one) <= 1; }));
        });
        if (word.size() >= least_letters && has_all && found.size() < most_candidates)
            found.push_back("'" + candidate + "'");
    }
    return found.empty() ? "" : fmt::format("Did you mean {}?", fmt::join(found, " or "));
}

/// `157719652#0` for `157719652`: the first part of a road that imports cut; empty if there is none.
std::string first_part(const std::string& word, const std::vector<std::string>& candidates) {
    const std::string* first = nullptr;
    for (const std::string& candidate : candidates) {
        if (!candidate.starts_with(word + "#")) continue;
        const auto order = [](const std::string& text) { return std::pair(text.size(), text); };
        if (first == nullptr || order(candidate) < order(*first)) first = &candidate;
    }
    return first == nullptr ? "" : *first;
}

}  // namespace

InputError::InputError(std::vector<Problem> problems)
    : Error(ExitCode::bad_input, format_all(problems)), problems_(each_once(problems)) {}

InputError::InputError(Problem problem) : InputError(std::vector<Problem>{std::move(problem)}) {}

SimulatorError SimulatorError::with_context(const std::string& context) const {
    return SimulatorError(context + ": " + what());
}

std::string format_problem(const Problem& problem) {
    return visible(text_of(problem));
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
        const std::size_t distance = edit_distance(lower(word), lower(candidate));
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
    std::string near = first_part(word, candidates);
    if (near.empty()) near = nearest(word, candidates);
    if (counts_runs(word)) {
        const auto same = std::ranges::find_if(candidates, counts_runs);
        near = same == candidates.end() ? "" : *same;
    }
    if (!near.empty()) return fmt::format("Did you mean '{}'?", near);
    const std::string question = counts_runs(word) ? "" : question_of_parts(word, candidates);
    return question.empty() ? otherwise : question;
}

}  // namespace clearway::core
