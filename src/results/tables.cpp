#include <fmt/format.h>

#include "core/files.hpp"
#include "results/detail/csv.hpp"
#include "results/detail/database.hpp"
#include "results/detail/record_files.hpp"
#include "results/store.hpp"

namespace clearway::results {
namespace {

using detail::csv_text;

std::string key_cells(const RunKey& key) {
    return fmt::format("{},{},{}", csv_text(key.scenario), csv_text(key.condition), key.replication);
}

std::string complete_line(const RunRecord& run) {
    std::string line = key_cells(run.key) + ",ok,";
    detail::append_cells(line, run.metrics);
    detail::append_cells(line, run.provenance);
    return line;
}

std::string incomplete_line(const RunKey& key, std::string_view outcome, std::string_view cause) {
    std::string line = fmt::format("{},{},{}", key_cells(key), outcome, cause);
    detail::append_empty_cells<metrics::RunMetrics>(line);
    detail::append_empty_cells<Provenance>(line);
    return line;
}

}  // namespace

Results read_results(const Store& store, VehicleRows rows) {
    Results results;
    results.manifest = store.manifest();
    for (const RunKey& key : results.manifest.runs()) {
        if (auto run = store.read(key, rows)) {
            results.runs.push_back(std::move(*run));
        } else if (auto failure = store.read_failure(key)) {
            results.failures.push_back(std::move(*failure));
        } else {
            results.missing.push_back(key);
        }
    }
    return results;
}

std::string runs_csv(const Results& results) {
    std::string text = "scenario,condition,replication,outcome,cause";
    detail::append_header<metrics::RunMetrics>(text);
    detail::append_header<Provenance>(text);
    text += "\n";
    // All three lists are sorted, and together they are the manifest's runs.
    auto run = results.runs.begin();
    auto failure = results.failures.begin();
    for (const RunKey& key : results.manifest.runs()) {
        if (run != results.runs.end() && run->key == key) {
            text += complete_line(*run++);
        } else if (failure != results.failures.end() && failure->key == key) {
            text += incomplete_line(key, "failed", name((failure++)->cause));
        } else {
            text += incomplete_line(key, "missing", "");
        }
        text += "\n";
    }
    return text;
}

std::string vehicles_csv(const Results& results) {
    std::string text = "scenario,condition,replication," + detail::vehicle_header() + "\n";
    for (const RunRecord& run : results.runs) {
        const std::string key = key_cells(run.key);
        for (const metrics::VehicleRow& vehicle : run.vehicles)
            text += key + "," + detail::vehicle_cells(vehicle) + "\n";
    }
    return text;
}

void write_tables(const Store& store, const Results& results) {
    core::write_atomically(store.runs_csv(), runs_csv(results));
    core::write_atomically(store.vehicles_csv(), vehicles_csv(results));
    detail::write_database(store.folder() / "results.sqlite", results);
}

}  // namespace clearway::results
