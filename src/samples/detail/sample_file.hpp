#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "samples/sample_origin.hpp"

namespace clearway::samples::detail {

// What all sample files share: a first line with kind and version, a line of JSON with the origin,
// little-endian binary samples, and a last line with their number and a content hash.

static_assert(std::endian::native == std::endian::little, "sample files are little-endian");

template <class Number>
void append(std::string& bytes, Number number) {
    char raw[sizeof(Number)];
    std::memcpy(raw, &number, sizeof(Number));
    bytes.append(raw, sizeof(Number));
}
template <class Number>
void append_all(std::string& bytes, std::span<const Number> numbers) {
    bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
}

/// Reads numbers from the front of a buffer; throws core::InputError at its end.
class ByteReader {
  public:
    ByteReader(std::string_view bytes, std::string where) : bytes_(bytes), where_(std::move(where)) {}

    bool empty() const { return bytes_.empty(); }

    template <class Number>
    Number next() {
        Number number;
        std::memcpy(&number, take(sizeof(Number)).data(), sizeof(Number));
        return number;
    }
    template <class Number>
    void next_all(std::size_t count, std::vector<Number>& numbers) {
        numbers.resize(count);
        const std::string_view raw = take(count * sizeof(Number));
        if (count > 0) std::memcpy(numbers.data(), raw.data(), raw.size());
    }

    /// Checks the count before anything is allocated for it, so that a damaged count cannot exhaust memory.
    std::uint32_t next_count(std::size_t bytes_each);

  private:
    std::string_view take(std::size_t size);
    [[noreturn]] void end_reached() const;

    std::string_view bytes_;
    std::string where_;
};

/// The line of JSON that says where samples come from, and the reverse. Throw std::logic_error for an
/// impossible schema, core::InputError (`where`: file and line) for a damaged line.
std::string origin_line(const SampleOrigin& origin);
SampleOrigin read_origin(std::string_view line, const std::string& where);

/// Collects the samples of one run in memory and writes them as one file.
class SampleFileWriter {
  public:
    std::size_t sample_count() const { return sample_count_; }
    /// Writes the file atomically. Throws core::EnvironmentError (folder not writable, disk full).
    void write(const std::filesystem::path& file) const;

  protected:
    SampleFileWriter(std::string_view first_line, const SampleOrigin& origin);
    /// Where the numbers of a sample are appended. Throws std::logic_error when `fault` says something: a bug
    /// in the recorder.
    std::string& bytes_of_sample(const std::string& fault);

  private:
    std::string bytes_;
    std::size_t sample_count_ = 0;
};

/// The content of a file, taken apart.
struct SampleBytes {
    std::string content;
    std::string_view samples;  ///< Refers to `content`: do not move the struct.
    SampleOrigin origin;
    std::size_t sample_count = 0;
    std::string content_hash;
};
/// Throws core::InputError for a file that is missing, of another kind or version, cut short, or changed
/// since it was written.
void read_sample_bytes(const std::filesystem::path& file, std::string_view first_line, SampleBytes& bytes);

/// What is said of a sample that is damaged, and of a file that holds another number of samples than it says.
[[noreturn]] void refuse_sample(const std::filesystem::path& file, std::size_t number,
                                const std::string& fault);
[[noreturn]] void refuse_count(const std::filesystem::path& file, std::size_t found, std::size_t stated);

/// Samples by `read(reader)`, of which `fault` finds nothing wrong; `result` gets origin, samples and hash.
/// Throws core::InputError otherwise.
template <class File, class Read, class Fault>
void read_all(const std::filesystem::path& file, const SampleBytes& bytes, const Read& read,
              const Fault& fault, File& result) {
    result.origin = bytes.origin;
    result.content_hash = bytes.content_hash;
    ByteReader reader(bytes.samples, file.string());
    while (!reader.empty()) {
        result.samples.push_back(read(reader));
        if (const std::string wrong = fault(result.samples.back()); !wrong.empty())
            refuse_sample(file, result.samples.size() - 1, wrong);
    }
    if (result.samples.size() != bytes.sample_count)
        refuse_count(file, result.samples.size(), bytes.sample_count);
}

/// The files in `folder` and the folders in it whose names end in `ending`, sorted by name. Throws
/// core::InputError, with `what` they are and the `cure`, when there is none.
std::vector<std::filesystem::path> find_files(const std::filesystem::path& folder, std::string_view ending,
                                              std::string_view what, std::string_view cure);

inline constexpr const char* cure_remake =
    "Record the samples again with `clearway links dataset SCENARIO --samples`, for `train graphsage` and "
    "`train "
    "gradient_boosting` with `--net graphsage`";

}  // namespace clearway::samples::detail
