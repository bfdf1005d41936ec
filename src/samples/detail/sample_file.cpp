#include "samples/detail/sample_file.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/read_failure.hpp"

namespace clearway::samples::detail {
namespace {

constexpr std::uint32_t most_features = 256;

/// Splits off the last line and checks its hash against the bytes before it. Returns the number of samples.
std::size_t check_end(std::string_view& bytes, const std::string& where, std::string& hash) {
    const std::size_t start = bytes.empty() ? std::string_view::npos : bytes.rfind('\n', bytes.size() - 2);
    const std::string last(start == std::string_view::npos ? std::string_view{} : bytes.substr(start + 1));
    char digits[33] = {};
    unsigned long count = 0;
    if (!last.ends_with('\n') || std::sscanf(last.c_str(), "end %lu %32[0-9a-f]\n", &count, digits) != 2) {
        throw core::InputError({where, "its last line is missing: it is cut short", "", cure_remake});
    }
    bytes = bytes.substr(0, start);
    hash = core::content_hash(bytes);
    if (hash != digits) {
        throw core::InputError(
            {where, fmt::format("its content hash is {}, but its last line says {}", hash, digits), "",
             "It was changed or damaged. " + std::string(cure_remake)});
    }
    return count;
}

}  // namespace

std::uint32_t ByteReader::next_count(std::size_t bytes_each) {
    const auto count = next<std::uint32_t>();
    if (std::size_t{count} * bytes_each > bytes_.size()) end_reached();
    return count;
}

std::string_view ByteReader::take(std::size_t size) {
    if (size > bytes_.size()) end_reached();
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
}

void ByteReader::end_reached() const {
    throw core::InputError({where_, "a sample ends before its data", "", cure_remake});
}

std::string origin_line(const SampleOrigin& origin) {
    if (origin.features.width == 0 || origin.features.width > most_features)
        throw std::logic_error(fmt::format("samples of {} features", origin.features.width));
    nlohmann::ordered_json json = {{"scenario", origin.scenario},
                                   {"failure", origin.failure},
                                   {"feature_name", origin.features.name},
                                   {"feature_version", origin.features.version},
                                   {"feature_count", origin.features.width},
                                   {"study_seed", origin.study_seed},
                                   {"replication", origin.replication},
                                   {"link_radius_m", origin.link_radius_m}};
    if (!origin.traffic.empty()) json["traffic"] = origin.traffic;
    return json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
}

SampleOrigin read_origin(std::string_view line, const std::string& where) {
    try {
        const nlohmann::json json = nlohmann::json::parse(line);
        SampleOrigin origin;
        json.at("scenario").get_to(origin.scenario);
        json.at("failure").get_to(origin.failure);
        json.at("feature_name").get_to(origin.features.name);
        json.at("feature_version").get_to(origin.features.version);
        json.at("feature_count").get_to(origin.features.width);
        json.at("study_seed").get_to(origin.study_seed);
        json.at("replication").get_to(origin.replication);
        json.at("link_radius_m").get_to(origin.link_radius_m);
        origin.traffic = json.value("traffic", "");
        if (origin.features.width == 0 || origin.features.width > most_features) {
            throw core::InputError({where + ": feature_count",
                                    fmt::format("{} features", origin.features.width),
                                    fmt::format("1 to {}", most_features), cure_remake});
        }
        return origin;
    } catch (const nlohmann::json::exception& error) {
        throw core::InputError({where, error.what(), "", cure_remake});
    }
}

SampleFileWriter::SampleFileWriter(std::string_view first_line, const SampleOrigin& origin)
    : bytes_(std::string(first_line) + origin_line(origin)) {}

std::string& SampleFileWriter::bytes_of_sample(const std::string& fault) {
    if (!fault.empty()) throw std::logic_error("sample: " + fault);
    ++sample_count_;
    return bytes_;
}

void SampleFileWriter::write(const std::filesystem::path& file) const {
    core::write_atomically(file,
                           bytes_ + fmt::format("\nend {} {}\n", sample_count_, core::content_hash(bytes_)));
}

void read_sample_bytes(const std::filesystem::path& file, std::string_view first_line, SampleBytes& bytes) {
    bytes.content = core::read_file(file);
    const std::string where = file.string();
    bytes.samples = bytes.content;
    if (!bytes.samples.starts_with(first_line)) {
        throw core::InputError({where + ":1", "not a file of such samples, or one of another version",
                                fmt::format("first line `{}`", first_line.substr(0, first_line.size() - 1)),
                                cure_remake});
    }
    bytes.sample_count = check_end(bytes.samples, where, bytes.content_hash);
    bytes.samples.remove_prefix(first_line.size());
    const std::size_t line_end = std::min(bytes.samples.find('\n'), bytes.samples.size());
    bytes.origin = read_origin(bytes.samples.substr(0, line_end), where + ":2");
    bytes.samples.remove_prefix(std::min(line_end + 1, bytes.samples.size()));
}

void refuse_sample(const std::filesystem::path& file, std::size_t number, const std::string& fault) {
    throw core::InputError({fmt::format("{}: sample {}", file.string(), number), fault, "", cure_remake});
}

void refuse_count(const std::filesystem::path& file, std::size_t found, std::size_t stated) {
    throw core::InputError({file.string(),
                            fmt::format("{} samples, but its last line says {}", found, stated), "",
                            cure_remake});
}

std::vector<std::filesystem::path> find_files(const std::filesystem::path& folder, std::string_view ending,
                                              std::string_view what, std::string_view cure) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    std::filesystem::path at = folder;
    for (auto entry = std::filesystem::recursive_directory_iterator(folder, error);
         !error && entry != std::filesystem::recursive_directory_iterator(); entry.increment(error)) {
        at = entry->path();
        if (at.filename().string().ends_with(ending)) files.push_back(at);
    }
    if (error) core::fail_to_read(std::filesystem::is_directory(at) ? at : at.parent_path(), error.value());
    if (files.empty()) {
        throw core::InputError({folder.string(), fmt::format("holds no file of {}", what),
                                fmt::format("a folder with *{} files", ending), std::string(cure)});
    }
    std::ranges::sort(files);
    return files;
}

}  // namespace clearway::samples::detail
