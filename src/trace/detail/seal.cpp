#include "trace/detail/seal.hpp"

#include <cassert>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/open_file.hpp"
#include "core/read_failure.hpp"
#include "core/running_hash.hpp"

namespace clearway::trace::detail {
namespace {

constexpr std::string_view first_words = "CLEARWAY recording, format ";
constexpr std::size_t piece_length = std::size_t{1} << 20U;

std::string seal_text(std::uint64_t length, const std::string& hash) {
    std::string text = fmt::format("{}{}\nHDF5 follows this block.\nlength {:020}\nhash {}\n", first_words,
                                   recording_format, length, hash);
    assert(text.size() < seal_length);
    text.resize(seal_length, '\0');
    return text;
}

/// Hashes what follows the seal. False when the stream cannot be read to its end.
bool hash_rest(std::ifstream& stream, core::RunningHash& hash, std::uint64_t& length) {
    std::vector<char> piece(piece_length);
    stream.seekg(seal_length);
    while (stream) {
        stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        const auto count = static_cast<std::size_t>(stream.gcount());
        hash.add({piece.data(), count});
        length += count;
    }
    return stream.eof() && !stream.bad();
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
    throw core::InputError({file.string(), what, "", "Record the run again, or take the file from a backup"});
}

void refuse_other_formats(const std::filesystem::path& file, const std::string& head) {
    if (!head.starts_with(first_words))
        throw core::InputError({file.string(), "is not a recording",
                                "a file written with --record, in recordings/ of a run folder",
                                "Give the file as Clearway wrote it: tools that rewrite HDF5 drop its seal"});
    int format = 0;
    const char* const begin = head.data() + first_words.size();
    std::from_chars(begin, head.data() + head.size(), format);
    if (format == recording_format) return;
    throw core::InputError({file.string(), fmt::format("is a recording of format {}", format),
                            fmt::format("{}", recording_format),
                            "Read it with the version of Clearway that wrote it, or record the run again"});
}

}  // namespace

std::string seal_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    core::RunningHash hash;
    std::uint64_t length = 0;
    if (!stream || !hash_rest(stream, hash, length)) throw core::write_error(file, errno);
    return seal_text(length, hash.digest());
}

void check_seal(const std::filesystem::path& file) {
    const core::OpenFile is_a_file(file);  // a stream waits at a pipe
    std::ifstream stream(file, std::ios::binary);
    std::error_code error;
    const std::uint64_t size = std::filesystem::file_size(file, error);
    if (!stream || error) core::fail_to_read(file, error ? error.value() : errno);
    std::string head(seal_length, '\0');
    stream.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(stream.gcount()));
    if (stream.bad()) core::fail_to_read(file, errno);
    stream.clear();
    refuse_other_formats(file, head);
    if (head.size() < seal_length) fail(file, "is cut short: it has no end");

    const std::size_t number = head.find("\nlength ");
    std::uint64_t length = 0;
    if (number != std::string::npos)
        std::from_chars(head.data() + number + 8, head.data() + head.size(), length);
    if (size - seal_length < length) fail(file, "is cut short: it has no end");
    core::RunningHash hash;
    std::uint64_t found = 0;
    if (!hash_rest(stream, hash, found)) core::fail_to_read(file, errno);
    if (length != 0 && found > length) fail(file, "is damaged: something follows its end");
    if (head != seal_text(found, hash.digest())) fail(file, "is damaged: it does not fit its hash");
}

}  // namespace clearway::trace::detail
