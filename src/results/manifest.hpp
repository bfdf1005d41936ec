#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiment/condition.hpp"
#include "results/analysis_plan.hpp"
#include "results/record.hpp"

namespace clearway::results {

/// A scenario of a study, with everything that decides its runs.
struct ScenarioEntry {
    std::string name;
    std::string version;
    std::string title;
    std::string configuration;       ///< The effective configuration, TOML.
    std::string configuration_hash;  ///< Of `configuration` and the scenario's own files.
    std::string attribution;         ///< Credit that the map data requires; may be empty.
    core::Settings factors = {};     ///< Of the study: `scenario.demand.human` -> `80`.
    std::string variant = {};        ///< `dense`; empty: the standard one.

    bool operator==(const ScenarioEntry&) const = default;

    /// The members that are texts.
    static constexpr void fields(const auto& table) {
        using S = ScenarioEntry;
        using core::Field;
        table(Field{"name", "", &S::name, 0, 0, "", ""}, Field{"version", "", &S::version, 0, 0, "", ""},
              Field{"title", "", &S::title, 0, 0, "", ""},
              Field{"configuration_hash", "", &S::configuration_hash, 0, 0, "", ""},
              Field{"attribution", "", &S::attribution, 0, 0, "", ""},
              Field{"configuration", "", &S::configuration, 0, 0, "", ""});
    }
};

/// The precision that a study must reach, in place of a number of replications.
struct PrecisionTarget {
    std::string metric = "emergency_restricted_travel_time_s";  ///< Of metrics::RunMetrics.
    double half_width = 0.0;    ///< Of the 95 % interval, in the metric's unit; > 0.
    std::uint32_t at_most = 0;  ///< Largest number of replications.

    bool operator==(const PrecisionTarget&) const = default;
};

/// What a study is. With it and the same versions every run can be repeated.
struct Manifest {
    int format = 5;  ///< Format of the run folder; other formats are rejected.
    std::string study;
    std::string clearway_version;
    std::string clearway_build = {};  ///< Of the programs (core::build_stamp).
    std::string sumo_version;
    std::uint64_t study_seed = 1;
    std::uint32_t replications = 0;  ///< With a precision target: those asked for so far.
    std::vector<ScenarioEntry> scenarios;
    std::vector<experiment::ConditionSpec> conditions;
    std::optional<PrecisionTarget> precision;
    std::optional<AnalysisPlan> plan = std::nullopt;

    bool operator==(const Manifest&) const = default;
    /// Every run of the study, sorted.
    std::vector<experiment::RunKey> runs() const;
    std::size_t run_count() const { return scenarios.size() * conditions.size() * replications; }
    /// The same one by one, for studies whose list would be large.
    void for_each_run(const std::function<void(const experiment::RunKey&)>& visit) const;
};

/// What a study decides of the provenance of its runs of a scenario; the rest is empty, as are hashes of a
/// scenario that it does not have.
experiment::Provenance planned_provenance(const Manifest& manifest, const std::string& scenario);

/// How `differences` names another build of the programs.
inline constexpr const char* another_build = "build of Clearway";

/// Names of what differs between two manifests, `seed, conditions`; empty for the same study. `titles` are
/// those that a study file gives.
std::string differences(const Manifest& left, const Manifest& right, const core::Settings& titles = {});

/// Whether `wanted` is the study of `stored` with as many replications or more and, where no plan was written
/// before, perhaps conditions between or after those stored: no run depends on another condition.
bool continues(const Manifest& wanted, const Manifest& stored);

/// Deterministic JSON with a `hash` of the rest.
std::string to_json(const Manifest& manifest);
/// Throws core::InputError, naming `where`, for text that is not a manifest of this format or does not match
/// its hash.
Manifest manifest_from_json(const std::string& text, const std::string& where);
/// 32 hex digits. Equal hashes: the same study, with files of the user in the same folders.
std::string manifest_hash(const Manifest& manifest);
/// 32 hex digits, wherever the user's files are (experiment::without_folders). Equal hashes: the same study.
std::string study_hash(Manifest manifest);

}  // namespace clearway::results
