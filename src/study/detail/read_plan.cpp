#include "study/detail/read_plan.hpp"

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/folder_name.hpp"
#include "experiment/condition_titles.hpp"
#include "metrics/run_metrics.hpp"

namespace clearway::study::detail {
namespace {

using core::StrictTable;

template <class Element>
std::vector<std::string> names_of(const std::vector<Element>& elements) {
    return core::texts_of(elements, &Element::name);
}

/// The name, or the value of a factor, that has this title; a title of several and other words as they are.
std::string untitled(const std::string& word, const core::Settings& titles) {
    const auto is_title = [&](const auto& one) { return one.second == word; };
    return std::ranges::count_if(titles, is_title) == 1 ? std::ranges::find_if(titles, is_title)->first
                                                        : word;
}

/// The name probably meant by one that is not in the study. Factors lengthen names: `a` is `a+lease_s=2`
/// then, and `2` a part of it.
std::string meant(const std::string& text, const std::vector<std::string>& known,
                  const core::Settings& titles) {
    const std::string name = untitled(text.substr(0, text.find(", ")), titles);  // `Green wave, no repair`
    std::vector<std::string> lengthened;
    for (const std::string& full : known) {
        const bool has_value = (full + "+").find("=" + core::as_folder_name(name) + "+") != std::string::npos;
        if (!name.empty() && (full.starts_with(name + "+") || has_value)) lengthened.push_back(full);
    }
    if (!lengthened.empty())
        return fmt::format("Factors are part of a name: write '{}'", fmt::join(lengthened, "' or '"));
    return core::did_you_mean(name, known);
}

/// `linked`, `failure=B10`, `policy=mine.py_Green`: the parts of a name that factors lengthened, sorted.
std::vector<std::string> parts_of(const std::string& name, const core::Settings& titles) {
    std::vector<std::string> parts;
    std::istringstream text(name);
    for (std::string part; std::getline(text, part, '+');) {
        const std::size_t at = part.find('=') + 1;
        const std::string value = untitled(part.substr(at), titles);
        parts.push_back(at == 0 ? value : part.substr(0, at) + core::as_folder_name(value));
    }
    std::ranges::sort(parts);
    return parts;
}

/// Checks names; of several problems the first alone lists what is allowed.
class Names {
  public:
    /// `made`: the titles that reports give, by name.
    explicit Names(std::vector<std::string> known, core::Settings titles = {}, core::Settings made = {})
        : known_(std::move(known)), titles_(std::move(titles)), made_(std::move(made)) {}

    /// The name in the study of its title, or of `linked+policy=mine.py:Green+failure=B10`, whose factors may
    /// have any order, and values as they stand in the file or their titles; the same text where there is
    /// none.
    std::string full(const std::string& text) const {
        if (core::contains(known_, text)) return text;
        const std::string made = untitled(text, made_);
        if (made != text) return made;
        const std::vector<std::string> parts = parts_of(text, titles_);
        const auto found = std::ranges::find(
            known_, parts, [](const std::string& name) { return parts_of(name, core::Settings()); });
        return found == known_.end() ? text : *found;
    }

    void check(StrictTable& row, const char* key, const std::string& name) {
        if (core::contains(known_, name)) return;
        row.problem(key, name.empty() ? "is missing" : fmt::format("'{}' is not in the study", name),
                    is_listed_ ? "as above" : core::listed(known_), meant(name, known_, titles_));
        is_listed_ = true;
    }

  private:
    std::vector<std::string> known_;
    core::Settings titles_, made_;
    bool is_listed_ = false;
};

/// Metrics in seconds, for which the margin has a meaning.
std::vector<std::string> metrics_in_seconds() {
    std::vector<std::string> names;
    core::for_each_field<metrics::RunMetrics>([&](const auto& field) {
        if (std::string_view(field.unit) == "s") names.emplace_back(field.name);
    });
    return names;
}

results::PlannedComparison read_comparison(StrictTable& row) {
    results::PlannedComparison comparison;
    row.text("name", comparison.name);
    row.text("scenario", comparison.scenario);
    row.text("condition", comparison.condition);
    row.text("against", comparison.against);
    row.word<results::Claim>("claim", comparison.claim);
    row.finish();
    return comparison;
}

/// The names that rows may hold.
struct Known {
    Names conditions;
    Names scenarios;
    std::set<std::string> comparisons = {};  ///< Of rows before.
};

void check_comparison(StrictTable& row, const results::PlannedComparison& comparison, Known& known) {
    if (comparison.name.empty()) row.problem("name", "is missing", "a name", "Name the comparison");
    if (!comparison.name.empty() && !known.comparisons.insert(comparison.name).second)
        row.problem("name", fmt::format("'{}' occurs twice", comparison.name), "a name of its own", "");
    known.conditions.check(row, "condition", comparison.condition);
    known.conditions.check(row, "against", comparison.against);
    if (!comparison.condition.empty() && comparison.condition == comparison.against)
        row.problem("against", "is the condition itself", "another condition", "");
    if (!comparison.scenario.empty()) known.scenarios.check(row, "scenario", comparison.scenario);
}

/// Whether two comparisons ask the same of the same runs, in whichever direction.
bool ask_the_same(const results::PlannedComparison& one, const results::PlannedComparison& other) {
    const bool same_pair =
        std::minmax(one.condition, one.against) == std::minmax(other.condition, other.against);
    const bool same_scenario =
        one.scenario == other.scenario || one.scenario.empty() || other.scenario.empty();
    return one.claim == other.claim && same_pair && same_scenario;
}

/// A question that is asked twice would be counted twice by Holm's correction.
void check_repeated(std::vector<StrictTable>& rows,
                    const std::vector<results::PlannedComparison>& comparisons) {
    for (std::size_t at = 1; at < comparisons.size(); ++at) {
        const auto here = comparisons.begin() + static_cast<std::ptrdiff_t>(at);
        const auto first = std::find_if(comparisons.begin(), here,
                                        [&](const auto& other) { return ask_the_same(other, *here); });
        if (first == here) continue;
        rows[at].problem("condition",
                         fmt::format("'{}' and '{}' are compared by '{}' already", here->condition,
                                     here->against, first->name),
                         "each pair once for each claim and scenario", "Remove one of the two");
    }
}

/// A margin of 0 holds no difference. A margin that is a share of the delay needs the time of an emergency
/// vehicle alone.
void check_margin(StrictTable& reader, const results::AnalysisPlan& plan, bool has_solo) {
    const bool claims_equivalence = std::ranges::any_of(
        plan.comparisons,
        [](const results::PlannedComparison& one) { return one.claim == results::Claim::equivalence; });
    if (!claims_equivalence) return;
    if (plan.margin_s == 0.0 && plan.margin_share == 0.0)
        reader.problem("margin_s", "is 0, and so is margin_share: equivalence cannot be shown",
                       "one of them above 0", "Give the least difference that would matter, in seconds");
    if (plan.margin_share > 0.0 && !has_solo)
        reader.problem("margin_share", "is a share of the delay, which needs the condition solo",
                       "0, or a study with solo", "Add solo to the conditions");
}

}  // namespace

void read_plan(StrictTable& root, Extent extent, StudyConfig& config) {
    auto reader = root.below("plan");
    if (!reader) return;
    results::AnalysisPlan plan;
    const bool has_solo = std::ranges::any_of(config.conditions, [](const experiment::ConditionSpec& one) {
        return one.traffic_model == experiment::TrafficModel::free_flow;
    });
    if (!has_solo) plan.margin_share = 0.0;
    reader->text("metric", plan.metric);
    reader->read(plan);
    std::vector<StrictTable> rows = reader->rows("comparison");
    for (StrictTable& row : rows)
        plan.comparisons.push_back(read_comparison(row));
    reader->finish();
    const std::vector<std::string> metrics = metrics_in_seconds();
    if (!core::contains(metrics, plan.metric))
        reader->problem("metric", fmt::format("'{}' is not a metric in seconds", plan.metric),
                        "columns of runs.csv in seconds", core::did_you_mean(plan.metric, metrics));
    if (rows.empty())
        reader->problem("comparison", "is missing", "at least one [[plan.comparison]]",
                        "Name what the study is to show, or remove [plan]");
    if (config.precision)
        root.problem(
            "precision", "is given together with [plan]",
            "replications: a study that stops once its results look sufficient claims too many effects",
            "Fix the number of replications beforehand");
    if (extent == Extent::quick) return;
    if (config.replications < 2)
        root.problem("replications", fmt::format("{} cannot show what [plan] claims", config.replications),
                     "2 or more", "Give as many as the claims need, or remove [plan]");
    Known known{Names(names_of(config.conditions), config.titles,
                      experiment::ConditionTitles(config.titles).of(config.conditions)),
                Names(names_of(config.scenarios))};
    for (results::PlannedComparison& comparison : plan.comparisons) {
        comparison.condition = known.conditions.full(comparison.condition);
        comparison.against = known.conditions.full(comparison.against);
    }
    for (std::size_t at = 0; at < rows.size(); ++at)
        check_comparison(rows[at], plan.comparisons[at], known);
    check_repeated(rows, plan.comparisons);
    check_margin(*reader, plan, has_solo);
    config.plan = std::move(plan);
}

}  // namespace clearway::study::detail
