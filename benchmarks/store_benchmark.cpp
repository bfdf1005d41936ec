// What storing one run of the city costs (73 vehicles and some emergency ones), without and with a line in
// the tables. Real time is the disk's: files are flushed. Compare the processor time with that of a run.
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <benchmark/benchmark.h>

#include "results/store.hpp"
#include "results/table_writer.hpp"

namespace {

using namespace clearway;

class TemporaryStore {
  public:
    TemporaryStore() : folder_("clearway-store-XXXXXX") {
        if (::mkdtemp(folder_.data()) == nullptr) throw std::runtime_error("no temporary folder");
    }
    ~TemporaryStore() { std::filesystem::remove_all(folder_); }
    TemporaryStore(const TemporaryStore&) = delete;
    TemporaryStore& operator=(const TemporaryStore&) = delete;

    results::Store store(std::uint32_t replications) const {
        results::Manifest manifest;
        manifest.replications = replications;
        manifest.scenarios.emplace_back().name = "city";
        manifest.conditions.emplace_back().name = "baseline";
        return results::Store::create(folder_, manifest);
    }

  private:
    std::string folder_;
};

results::RunRecord run_of_the_city(std::uint32_t replication) {
    results::RunRecord run;
    run.key = {"city", "baseline", replication};
    run.condition.name = "baseline";
    for (int i = 0; i < 75; ++i) {
        metrics::VehicleRow row;
        row.id = "h" + std::to_string(i);
        row.key = core::vehicle_key(row.id);
        row.travel_time_s = 100.0 / 3.0 + i;
        row.time_loss_s = 10.0 / 3.0;
        run.vehicles.push_back(row);
    }
    return run;
}

void store_run(benchmark::State& state) {
    const TemporaryStore folder;
    const results::Store store = folder.store(100000);
    std::uint32_t replication = 0;
    for (auto _ : state)
        store.write(run_of_the_city(replication++), {});
}

void table_line(benchmark::State& state) {
    const TemporaryStore folder;
    const results::Store store = folder.store(100000);
    results::TableWriter writer(store);
    std::uint32_t replication = 0;
    for (auto _ : state)
        writer.add(run_of_the_city(replication++));
}

}  // namespace

BENCHMARK(store_run)->Iterations(200)->Unit(benchmark::kMicrosecond);
BENCHMARK(table_line)->Iterations(2000)->Unit(benchmark::kMicrosecond);
