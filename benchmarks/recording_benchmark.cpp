// What it costs to write and to read a recording, and how large it is:
//
//     CLEARWAY_RECORDING=runs/mine/recordings/city/mine/00000.h5 build/release/benchmarks/recording_benchmark
//
// Reading decodes every step. Writing encodes the same steps again; its figure includes their reading, so the
// cost of writing is the difference of the two.

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include <benchmark/benchmark.h>

#include "core/temporary_folder.hpp"
#include "trace/recording.hpp"
#include "truth/snapshot.hpp"

namespace {

using namespace clearway;

std::filesystem::path recording() {
    const char* const file = std::getenv("CLEARWAY_RECORDING");
    if (file == nullptr) throw std::runtime_error("CLEARWAY_RECORDING must name the file of a recording");
    return file;
}

struct Size {
    double steps = 0.0;
    double vehicle_steps = 0.0;
};

/// Reads `file`, and writes it again to `copy` where that is given.
Size run_through(const std::filesystem::path& file, const std::filesystem::path& copy) {
    trace::RecordingReader reader(file);
    std::optional<trace::RecordingWriter> writer;
    if (!copy.empty()) writer.emplace(copy, reader.info());
    Size size;
    while (const auto step = reader.next()) {
        size.steps += 1.0;
        size.vehicle_steps += static_cast<double>(step->snapshot->size());
        if (writer) writer->write(*step);
    }
    if (writer) writer->finish();
    return size;
}

void report(benchmark::State& state, const std::filesystem::path& file, const Size& size) {
    const auto bytes = static_cast<double>(std::filesystem::file_size(file));
    state.counters["bytes"] = bytes;
    state.counters["steps"] = size.steps;
    state.counters["vehicle_steps"] = size.vehicle_steps;
    state.counters["bytes_per_vehicle_step"] = bytes / size.vehicle_steps;
}

void reading(benchmark::State& state) {
    const std::filesystem::path file = recording();
    Size size;
    for (auto _ : state)
        size = run_through(file, {});
    report(state, file, size);
}

void reading_and_writing(benchmark::State& state) {
    const core::TemporaryFolder folder;
    const std::filesystem::path copy = folder.path() / "copy.h5";
    Size size;
    for (auto _ : state)
        size = run_through(recording(), copy);
    report(state, copy, size);
}

BENCHMARK(reading)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(reading_and_writing)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
