#pragma once

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace clearway::core {

/// Exit codes of every program, as `docs/reference/command-line.md` lists them.
enum class ExitCode : int {
    ok = 0,
    runs_failed = 1,
    usage = 2,
    bad_input = 3,
    environment = 4,
    incomplete = 5,
    fell_short = 6,
    conflict = 7,
    interrupted = 130,
    terminated = 143,
};

/// One problem with the user's input. All members may hold text from the user's files; pages escape it.
struct Problem {
    std::string where;    ///< File and place: `city.toml:12:3: demand.count` or `--step-length`.
    std::string what;     ///< What is wrong, with the value found: `-3 is negative`.
    std::string allowed;  ///< What is allowed: `0 to 100000`. Empty if there is no general rule.
    std::string cure;     ///< What to do. Empty if `allowed` is enough.
};

/// Base of everything that a program reports to its user with an exit code. `what()` is the whole message.
class Error : public std::runtime_error {
  public:
    Error(ExitCode exit_code, const std::string& message)
        : std::runtime_error(message), exit_code_(exit_code) {}
    ExitCode exit_code() const { return exit_code_; }

  private:
    ExitCode exit_code_;
};

/// The user's input is wrong. Thrown after all problems of the input have been collected; there is at least
/// one. Equal problems are kept once.
class InputError : public Error {
  public:
    explicit InputError(std::vector<Problem> problems);
    explicit InputError(Problem problem);
    const std::vector<Problem>& problems() const { return problems_; }

  private:
    std::vector<Problem> problems_;
};

/// Something is wrong with the machine: SUMO is missing or has another version, a folder is not writable, the
/// disk is full, a port is taken.
class EnvironmentError : public Error {
  public:
    explicit EnvironmentError(const std::string& message) : Error(ExitCode::environment, message) {}
};

/// The simulator failed. Each layer that rethrows it adds what it knows (time, vehicle, file) with
/// `with_context`.
class SimulatorError : public Error {
  public:
    explicit SimulatorError(const std::string& message) : Error(ExitCode::runs_failed, message) {}
    /// The same error with `context` before its message.
    SimulatorError with_context(const std::string& context) const;
};

/// Two different results claim the same place.
class ConflictError : public Error {
  public:
    explicit ConflictError(const std::string& message) : Error(ExitCode::conflict, message) {}
};

/// One line per problem: `where: what (allowed: ...). cure`; control characters are shown as `\x1b`.
std::string format_problem(const Problem& problem);

/// Whether a range has an element whose `projection` equals a value.
template <class Range, class Value, class Projection = std::identity>
constexpr bool contains(const Range& range, const Value& value, const Projection& projection = {}) {
    return std::ranges::find(range, value, projection) != std::ranges::end(range);
}

/// The texts that `projection` gives for the elements of a range, in their order.
template <class Range, class Projection>
std::vector<std::string> texts_of(const Range& range, const Projection& projection) {
    std::vector<std::string> texts;
    for (const auto& element : range)
        texts.emplace_back(std::invoke(projection, element));
    return texts;
}

/// `a, b, c`.
std::string listed(const std::vector<std::string>& words);

/// The candidate nearest to `word` by edit distance; empty when all differ in more than a third of its
/// letters (and in more than two). Capitals do not count.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

/// `Did you mean 'WORD'?`: the nearest candidate, before it the first part `WORD#0` of a road that imports
/// cut, after it up to three that contain the word; else `otherwise`.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates,
                         const std::string& otherwise = "");

}  // namespace clearway::core
