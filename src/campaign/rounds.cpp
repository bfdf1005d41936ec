#include "campaign/rounds.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "analysis/replications.hpp"
#include "analysis/summary.hpp"

namespace clearway::campaign {
namespace {

enum class Outcome : std::uint8_t { reached, capped, unknown, more };

struct Round {
    Outcome outcome = Outcome::unknown;
    std::uint32_t next = 0;  ///< Replications of the next round, when there is one.
    std::string text;        ///< What was found, for the user.
};

/// Decides from the replications so far whether another round follows.
Round judge(const results::Store& store, const results::PrecisionTarget& target) {
    const results::Results results = results::read_results(store);
    const auto found = analysis::widest(analysis::summarise(results), target.metric, target.half_width);
    if (!found) return {Outcome::unknown, 0, "no interval: too few complete runs"};
    const std::uint32_t now = results.manifest.replications;
    const auto wanted =
        static_cast<std::uint32_t>(std::min<std::size_t>(found->required + found->lost, target.at_most));
    Round round;
    round.text =
        fmt::format("{} of {}/{} is known to +- {:.3g} after {} replications; wanted: +- {:g}", target.metric,
                    found->scenario, found->condition, found->half_width, now, target.half_width);
    round.next = std::max(wanted, now);
    if (found->required <= found->n) {
        round.outcome = Outcome::reached;
    } else {
        round.outcome = now >= target.at_most ? Outcome::capped : Outcome::more;
        round.text += fmt::format(", for which {} are needed", found->required + found->lost);
    }
    return round;
}

void say(const Round& round) {
    const char* end = "";
    if (round.outcome == Outcome::reached) end = ": reached";
    if (round.outcome == Outcome::capped) end = ": stopped at the cap of the study file (at_most)";
    fmt::print(stderr, "clearway: {}{}\n", round.text, end);
}

}  // namespace

std::uint32_t replications_so_far(const study::StudyConfig& config, const std::filesystem::path& folder) {
    if (!config.precision || !std::filesystem::exists(folder / "manifest.json")) return config.replications;
    const results::Manifest stored = results::Store::open(folder).manifest();
    return stored.precision == config.precision ? std::max(config.replications, stored.replications)
                                                : config.replications;
}

core::ExitCode run_in_rounds(study::StudyConfig config, RunPlanOptions options) {
    config.replications = replications_so_far(config, options.folder);
    while (true) {
        const study::Plan plan = plan_for(config, options);
        const results::Store store = prepare_run_folder(plan, options);
        const study::StudyResult result = run_missing(plan, store, options);
        if (was_interrupted(result)) return result.exit_code;
        const Round round = judge(store, *config.precision);
        say(round);
        if (round.outcome != Outcome::more) return publish(store, how_to_publish(options));
        // At least one more, so that failing runs cannot keep a study from reaching its cap.
        config.replications =
            std::min(std::max(round.next, config.replications + 1), config.precision->at_most);
    }
}

}  // namespace clearway::campaign
