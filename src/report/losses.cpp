#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "core/counted.hpp"
#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/json.hpp"
#include "core/settings.hpp"
#include "prediction/predictor.hpp"
#include "report/read_facts.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
    throw core::InputError(core::Problem{
        where, what,
        "epoch,train_loss_nat,test_loss_nat and a row of numbers for each epoch; empty where not finite",
        "Train again with clearway links train, or remove the folder from training/."});
}

double loss_from(std::string_view cell, const std::string& where) {
    if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto value = core::number_from(std::string(cell));
    if (!value) refuse(where, fmt::format("'{}' is not a number", cell));
    return *value;
}

/// `test` of `test_loss_nat`.
std::string held_out_name(const std::vector<std::string_view>& head, const std::string& file) {
    constexpr std::string_view ending = "_loss_nat";
    const bool fits = head.size() == 3 && head[0] == "epoch" && head[1] == "train_loss_nat" &&
                      head[2].size() > ending.size() && head[2].ends_with(ending);
    if (!fits) refuse(file + ":1", "unknown columns");
    return std::string(head[2].substr(0, head[2].size() - ending.size()));
}

std::optional<double> number_of(const core::Json& object, const char* name) {
    const auto found = object.find(name);
    if (found == object.end() || !found->is_number()) return std::nullopt;
    return found->get<double>();
}

std::string text_of(const core::Json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Adds what the curve does not show, from the summary beside it.
void add_summary(const std::filesystem::path& file, LossCurve& curve) {
    if (!std::filesystem::exists(file)) return;
    const core::Json summary = core::parse_object(core::read_file(file), file.string());
    const std::string pairs = text_of(summary, "pairs");
    const std::string mode = text_of(summary, "mode");
    const auto named = [](const char* predictor, const char* data) {
        return fmt::format("{}; {}", prediction::title_of(predictor), data);
    };
    if (mode == "graphsage") curve.title = named("graphsage", "validated on unseen seeds");
    if (mode == "corrected") curve.title = named("graphsage_corrected", "validated on unseen seeds");
    if (pairs == "true-links") curve.title = named("graphsage_as_published", "list of true links only");
    if (pairs == "candidates") curve.title = named("graphsage_as_published", "list of candidate pairs");
    curve.constant_loss = number_of(summary, "constant_test_loss_nat");
    if (curve.constant_loss) {
        curve.note = fmt::format("Loss of the best constant answer on the test pairs: {}.",
                                 number(*curve.constant_loss, {3, Script::typeset}));
    }
    const auto test = summary.find("test");
    if (test == summary.end() || !test->is_object()) return;
    const auto auc = number_of(*test, "auc");
    if (auc) {
        curve.note +=
            fmt::format(" AUC on the test pairs: {} (chance: 0.5).", number(*auc, {2, Script::typeset}));
    } else if (pairs == "true-links") {
        curve.note += " No AUC: every pair is linked, so there is nothing to tell apart.";
    }
}

}  // namespace

LossCurve read_losses(const std::filesystem::path& training_folder) {
    const std::filesystem::path file = training_folder / "losses.csv";
    const std::string text = core::read_file(file);
    core::CsvReader lines(text);
    LossCurve curve;
    curve.title = training_folder.filename().string();
    lines.next();
    curve.held_out = held_out_name(lines.cells(), file.string());
    for (std::size_t row = 2; lines.next(); ++row) {
        const std::string where = fmt::format("{}:{}", file.string(), row);
        const std::vector<std::string_view>& cells = lines.cells();
        if (cells.size() != 3) refuse(where, core::counted(cells.size(), "cell"));
        curve.epoch.push_back(loss_from(cells[0], where));
        curve.train.push_back(loss_from(cells[1], where));
        curve.test.push_back(loss_from(cells[2], where));
    }
    add_summary(training_folder / "summary.json", curve);
    return curve;
}

}  // namespace clearway::report
