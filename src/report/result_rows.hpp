#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/summary.hpp"
#include "core/fields.hpp"
#include "report/links.hpp"

namespace clearway::report {

/// One published figure: a row of `results/*.csv`, from which pages are made. All members are texts as they
/// are shown.
struct ResultRow {
    std::string study, tree, date, seed, pairs, command;
    std::string scenario, condition;
    std::string measure;  ///< A column of runs.csv; What follows a `:` is against the baseline.
    std::string unit, mean;
    std::string low, high;  ///< Of the 95 % interval; empty if too few values.
    std::string lost_evs;   ///< `1 of 420`.
    std::string origin;     ///< `product`, or `transcribed` from an earlier page.
    std::string behaviour;  ///< Fingerprint of the tree's golden runs; empty if transcribed.

    bool operator==(const ResultRow&) const = default;

    static constexpr void fields(const auto& table) {
        using R = ResultRow;
        const auto text = [](const char* name, std::string R::*member) {
            return core::Field{name, "", member, 0, 0, "", ""};
        };
        table(text("study", &R::study), text("tree", &R::tree), text("date", &R::date),
              text("seed", &R::seed), text("pairs", &R::pairs), text("command", &R::command),
              text("scenario", &R::scenario), text("condition", &R::condition), text("measure", &R::measure),
              text("unit", &R::unit), text("mean", &R::mean), text("low", &R::low), text("high", &R::high),
              text("lost_evs", &R::lost_evs), text("origin", &R::origin), text("behaviour", &R::behaviour));
    }
};

/// What all rows of one publication share.
struct RowSource {
    std::string tree;
    std::string date;
    std::string command;
    std::string behaviour;
};

/// Levels of every condition, and differences of those that have a baseline, also in percent; of the primary
/// metric also the median of the pairs (`:median`), the mean of the pairs without a lock (`:unlocked`), and
/// the number of replications for a half width of 1 (`:replications`). Where a condition loses more emergency
/// vehicles than its baseline, means over emergency vehicles are left out but for the restricted travel time,
/// which counts those lost.
std::vector<ResultRow> study_rows(const analysis::Summary& summary, const std::vector<std::string>& metrics,
                                  const RowSource& source);

/// Quality of the predictors over all scenarios together. A row's scenario is `TITLE, FAILURE`, with `, exits
/// unknown` where they are, and its condition is the predictor.
std::vector<ResultRow> link_rows(const LinkFacts& facts, const RowSource& source);

/// The content of the file `name` with these rows instead of the product's earlier rows of the same studies
/// and measures, and instead of any row of the same study, scenario, condition and measure. `existing` may be
/// empty. Throws core::InputError for content that is not such a file.
std::string with_rows(std::string_view existing, const std::string& name, const std::vector<ResultRow>& rows);

/// A command as a user types it: without its folder and number of jobs, `clearway` without a path, and paths
/// in `root` relative to it. Of other absolute paths the last part stays.
std::string portable_command(const std::string& command, const std::string& root);

}  // namespace clearway::report
