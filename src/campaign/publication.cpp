#include "campaign/publication.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "core/build_stamp.hpp"
#include "core/counted.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/process.hpp"
#include "core/shipped_files.hpp"
#include "core/temporary_folder.hpp"

namespace clearway::campaign {
namespace {

namespace fs = std::filesystem;

constexpr const char* golden_file = "tests/loop/golden.txt";
constexpr std::size_t digits_of_behaviour = 12;

fs::path root() {
    const auto golden = core::shipped(golden_file);
    return golden ? golden->parent_path().parent_path().parent_path() : fs::path();
}

std::string commit_of(const fs::path& tree) {
    const core::TemporaryFolder folder;
    const fs::path output = folder.path() / "commit";
    const core::Exit exit = core::run({.program = "git",
                                       .arguments = {"-C", tree.string(), "rev-parse", "--short=7", "HEAD"},
                                       .output = output});
    std::istringstream words(exit.ok() ? core::read_file(output) : "");
    std::string commit;
    words >> commit;
    return commit;
}

/// The exclusive or of all hashes of the golden runs, as scripts/published_rows.py computes it.
std::string behaviour_of(const std::string& golden) {
    std::uint64_t first_half = 0;
    std::istringstream words(golden);
    for (std::string word; words >> word;) {
        if (word.size() == 32 && word.find_first_not_of("0123456789abcdef") == std::string::npos)
            first_half ^= std::stoull(word.substr(0, 16), nullptr, 16);
    }
    return fmt::format("{:016x}", first_half).substr(0, digits_of_behaviour);
}

std::string day(std::chrono::system_clock::time_point time) {
    return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

std::string day_of(const fs::path& file) {
    return day(std::chrono::file_clock::to_sys(fs::last_write_time(file)));
}

report::RowSource source_of(const Publication& publication, const std::string& command,
                            const std::string& date) {
    const fs::path tree = root();
    report::RowSource source{.tree = publication.tree,
                             .date = date,
                             .command = report::portable_command(command, tree.string()),
                             .behaviour = publication.behaviour};
    std::vector<core::Problem> problems;
    if (source.tree.empty() && !tree.empty()) source.tree = commit_of(tree);
    if (source.tree.empty())
        problems.push_back({"--tree", "git does not name the commit of this tree", "a commit", "Give it"});
    if (source.behaviour.empty() && !tree.empty())
        source.behaviour = behaviour_of(core::read_file(tree / golden_file));
    if (source.behaviour.empty())
        problems.push_back({"--behaviour", fmt::format("there is no {} to take it from", golden_file),
                            "what scripts/render-docs --behaviour prints in the tree of the runs", ""});
    if (!problems.empty()) throw core::InputError(std::move(problems));
    return source;
}

/// One command at a time changes the files of this folder while this object lives; others wait.
class Turn {
  public:
    explicit Turn(const fs::path& folder)
        : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        if (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX) == 0) return;
        if (errno == ENOENT) return;  // which writing tells
        fmt::print(stderr, "{}: cannot be locked ({}): let no other command publish there now\n",
                   folder.string(), std::strerror(errno));
    }
    ~Turn() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

  private:
    int descriptor_;
};

void write(const Publication& publication, const std::vector<report::ResultRow>& rows) {
    const Turn turn(fs::absolute(publication.file).parent_path());
    const std::string existing =
        fs::exists(publication.file) ? core::read_file(publication.file) : std::string();
    core::write_atomically(publication.file, report::with_rows(existing, publication.file, rows));
    fmt::print(stderr, "{}: {}\n", publication.file, core::counted(rows.size(), "row"));
}

/// Rows of a part of the runs would stand beside those of others as if they were the whole.
void check_complete(const std::string& folder, const analysis::Summary& summary) {
    std::vector<core::Problem> problems;
    for (const analysis::Unpaired& lost : summary.unpaired)
        problems.push_back({fmt::format("{}: {}/{}", folder, lost.scenario, lost.condition), lost.why,
                            "a complete study", "Repeat the study with the same --out"});
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

std::vector<std::string> each_once(const std::vector<std::string>& metrics) {
    std::vector<std::string> once;
    for (const std::string& metric : metrics) {
        if (!core::contains(once, metric)) once.push_back(metric);
    }
    return once;
}

}  // namespace

void publish_study(const Publication& publication, const results::Store& store,
                   const analysis::Summary& summary, const std::vector<std::string>& metrics) {
    const results::Manifest& manifest = store.manifest();
    const std::string folder = store.folder().string();
    if (manifest.replications < 2)
        throw core::InputError({folder, "has one replication, from which nothing can be concluded",
                                "at least 2", "Repeat the study with more --seeds"});
    check_complete(folder, summary);
    const bool named = !publication.tree.empty() && !publication.behaviour.empty();
    if (manifest.clearway_build != core::build_stamp() && !named)
        throw core::InputError({folder,
                                fmt::format("was made by build {} and this is build {}",
                                            manifest.clearway_build, core::build_stamp()),
                                "", "Name the tree that made the runs: --tree COMMIT --behaviour DIGITS"});
    const fs::path command = store.folder() / "command.txt";
    const fs::path written =
        fs::exists(store.runs_csv()) ? store.runs_csv() : store.folder() / "manifest.json";
    const report::RowSource source =
        source_of(publication, fs::exists(command) ? core::read_file(command) : "", day_of(written));
    write(publication, report::study_rows(summary, each_once(metrics), source));
}

void publish_links(const Publication& publication, const report::LinkFacts& facts) {
    write(publication, report::link_rows(facts, source_of(publication, facts.command,
                                                          day(std::chrono::system_clock::now()))));
}

}  // namespace clearway::campaign
