#include "links/link_run.hpp"

#include <string_view>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/json.hpp"
#include "core/random.hpp"

namespace clearway::links {
namespace {

// The file: a line of magic, a line of JSON, by case the score summaries and the place errors as
// variable-length integers (LEB128), and a hash of all of these as 16 hex digits.
constexpr std::string_view magic = "clearway links 2\n";
constexpr std::size_t seal_size = 16;

using core::Json;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
    throw core::InputError({file.string(), what, "a file that clearway links evaluate wrote",
                            "Remove it; the same command then repeats this run"});
}

std::string seal_of(std::string_view bytes) {
    return fmt::format("{:016x}", core::fnv1a64(bytes));
}

class Writer {
  public:
    explicit Writer(std::string& bytes) : bytes_(bytes) {}

    void add(std::uint64_t value) {
        for (; value >= 0x80U; value >>= 7U)
            bytes_ += static_cast<char>(value | 0x80U);
        bytes_ += static_cast<char>(value);
    }
    void add(const LinkSummary& summary) {
        add(summary.bins.size());
        std::uint32_t last = 0;
        for (const LinkSummary::Bin& bin : summary.bins) {
            add(bin.bin - last);
            add(bin.linked);
            add(bin.unlinked);
            last = bin.bin;
        }
        if (summary.bins.empty()) return;
        add(summary.log_loss);
        add(summary.brier);
        for (const LinkSummary::Calibration& bin : summary.calibration) {
            add(bin.pairs);
            add(bin.linked);
            add(bin.probability);
        }
    }
    void add(const LinkScoreSummary& scores) {
        for (const LinkSummary& cell : scores.cells)
            add(cell);
        add(scores.policy);
    }
    void add(const PlaceErrors& errors) {
        add(errors.bins.size());
        std::uint32_t last = 0;
        for (const PlaceErrors::Bin& bin : errors.bins) {
            add(bin.bin - last);
            add(bin.vehicles);
            last = bin.bin;
        }
    }

  private:
    std::string& bytes_;
};

class Reader {
  public:
    Reader(std::string_view bytes, const std::filesystem::path& file) : rest_(bytes), file_(file) {}

    std::uint64_t integer() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            if (rest_.empty()) refuse(file_, "ends too early");
            const auto byte = static_cast<unsigned char>(rest_.front());
            rest_.remove_prefix(1);
            value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
            if ((byte & 0x80U) == 0) return value;
        }
        refuse(file_, "holds a number that is too long");
    }
    LinkSummary summary() {
        LinkSummary summary;
        read_bins("links", LinkGrid::size, [&](std::uint32_t bin) {
            const std::uint64_t linked = integer();
            summary.bins.push_back({bin, linked, integer()});
        });
        if (summary.bins.empty()) return summary;
        summary.log_loss = integer();
        summary.brier = integer();
        for (LinkSummary::Calibration& bin : summary.calibration) {
            bin.pairs = integer();
            bin.linked = integer();
            bin.probability = integer();
        }
        return summary;
    }
    LinkScoreSummary scores() {
        LinkScoreSummary scores;
        for (LinkSummary& cell : scores.cells)
            cell = summary();
        scores.policy = summary();
        return scores;
    }
    PlaceErrors places() {
        PlaceErrors errors;
        read_bins("place errors", PlaceGrid::size, [&](std::uint32_t bin) {
            errors.bins.push_back({bin, integer()});
        });
        return errors;
    }
    bool at_end() const { return rest_.empty(); }

  private:
    /// Calls `read_counts(bin)` for each bin of a list on a grid of `size` bins. They are stored as the steps
    /// between them.
    template <typename ReadCounts>
    void read_bins(std::string_view of_what, std::uint32_t size, ReadCounts&& read_counts) {
        const std::uint64_t bins = integer();
        if (bins > size) refuse(file_, fmt::format("lists {} bins of {}", bins, of_what));
        std::uint64_t bin = 0;
        for (std::uint64_t i = 0; i < bins; ++i) {
            bin += integer();
            if (bin >= size) refuse(file_, fmt::format("names bin {} of {}", bin, of_what));
            read_counts(static_cast<std::uint32_t>(bin));
        }
    }

    std::string_view rest_;
    const std::filesystem::path& file_;
};

Json head_of(const LinkRun& run) {
    Json cases = Json::array();
    for (const LinkCase& one : run.cases) {
        Json truth = Json::object();
        Json belief = Json::object();
        core::write_fields(truth, one.truth);
        core::write_fields(belief, one.belief);
        cases.push_back({{"failure", one.failure},
                         {"exits", core::name(one.exits)},
                         {"truth", truth},
                         {"belief", belief}});
    }
    return {{"scenario", run.scenario},     {"configuration_hash", run.configuration_hash},
            {"study_seed", run.study_seed}, {"replication", run.replication},
            {"predictor", run.predictor},   {"cases", cases}};
}

LinkCase case_from(const Json& json, const std::string& where, std::vector<core::Problem>& problems) {
    LinkCase one;
    core::ObjectReader reader(json, where, problems);
    reader.read("failure", one.failure);
    reader.read("exits", one.exits);
    core::ObjectReader(reader.child("truth", Json::value_t::object), where, problems).read_fields(one.truth);
    core::ObjectReader(reader.child("belief", Json::value_t::object), where, problems)
        .read_fields(one.belief);
    return one;
}

LinkRun run_from(const Json& json, const std::string& where, std::vector<core::Problem>& problems) {
    LinkRun run;
    core::ObjectReader reader(json, where, problems);
    reader.read("scenario", run.scenario);
    reader.read("configuration_hash", run.configuration_hash);
    reader.read("study_seed", run.study_seed);
    reader.read("replication", run.replication);
    reader.read("predictor", run.predictor);
    for (const Json& one : reader.child("cases", Json::value_t::array))
        run.cases.push_back(case_from(one, where, problems));
    return run;
}

LinkTiming timing_in(const std::filesystem::path& file) {
    const Json json = core::parse_object(core::read_file(file), file.string());
    std::vector<core::Problem> problems;
    LinkTiming timing;
    core::ObjectReader root(json, file.string(), problems);
    for (const Json& one : root.child("cases", Json::value_t::array)) {
        LinkTiming::Case& timed = timing.cases.emplace_back();
        core::ObjectReader reader(one, file.string(), problems);
        reader.read("failure", timed.failure);
        reader.read("exits", timed.exits);
        reader.read("reports", timed.reports);
        reader.read("vehicles", timed.vehicles);
        reader.read("predict_s", timed.predict_s);
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return timing;
}

}  // namespace

std::filesystem::path timing_file(std::filesystem::path link_run_file) {
    return link_run_file.replace_extension(".timing.json");
}

void write_link_run(const std::filesystem::path& file, const LinkRun& run, const LinkTiming& timing) {
    Json cases = Json::array();
    for (const LinkTiming::Case& one : timing.cases) {
        cases.push_back({{"failure", one.failure},
                         {"exits", core::name(one.exits)},
                         {"reports", one.reports},
                         {"vehicles", one.vehicles},
                         {"predict_s", one.predict_s}});
    }
    core::write_atomically(timing_file(file), core::to_text({{"cases", cases}}));

    std::string bytes(magic);
    bytes += head_of(run).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    Writer writer(bytes);
    for (const LinkCase& one : run.cases) {
        writer.add(one.scores);
        writer.add(one.places);
    }
    bytes += seal_of(bytes);
    core::write_atomically(file, bytes);
}

LinkRun read_link_run(const std::filesystem::path& file) {
    const std::string bytes = core::read_file(file);
    std::string_view content = bytes;
    if (!content.starts_with(magic)) refuse(file, "is not a file of scored links, version 2");
    if (content.size() < magic.size() + seal_size ||
        content.substr(content.size() - seal_size) != seal_of(content.substr(0, content.size() - seal_size)))
        refuse(file, "is damaged: its checksum does not match");
    content.remove_suffix(seal_size);
    content.remove_prefix(magic.size());
    const std::size_t line_end = content.find('\n');
    std::vector<core::Problem> problems;
    LinkRun run = run_from(core::parse_object(std::string(content.substr(0, line_end)), file.string()),
                           file.string(), problems);
    if (!problems.empty()) throw core::InputError(std::move(problems));
    if (line_end == std::string_view::npos) refuse(file, "ends too early");
    Reader reader(content.substr(line_end + 1), file);
    for (LinkCase& one : run.cases) {
        one.scores = reader.scores();
        one.places = reader.places();
    }
    if (!reader.at_end()) refuse(file, "holds more data than it declares");
    return run;
}

LinkTiming read_link_timing(const std::filesystem::path& link_run_file) {
    const std::filesystem::path file = timing_file(link_run_file);
    try {
        return timing_in(file);
    } catch (const core::InputError& error) {
        refuse(file, error.problems().front().what);
    }
}

}  // namespace clearway::links
