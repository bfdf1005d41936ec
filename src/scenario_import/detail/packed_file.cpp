#include "scenario_import/detail/packed_file.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <string_view>

#include <bzlib.h>
#include <zlib.h>

#include "core/error.hpp"
#include "core/open_file.hpp"
#include "core/read_failure.hpp"

namespace clearway::scenario_import::detail {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
    throw core::InputError(core::Problem{file.string(), what, "a complete, readable file",
                                         "check the path, or download it again"});
}

Packing packing_of(const std::filesystem::path& file) {
    std::FILE* stream = std::fopen(file.c_str(), "rb");
    if (stream == nullptr) core::fail_to_read(file, errno);
    std::array<char, 3> head{};
    const std::size_t count = std::fread(head.data(), 1, head.size(), stream);
    const int failure = std::ferror(stream) != 0 ? errno : 0;
    std::fclose(stream);
    if (failure != 0) core::fail_to_read(file, failure);
    const std::string_view bytes(head.data(), count);
    if (bytes.starts_with("\x1f\x8b")) return Packing::gzip;
    return bytes == "BZh" ? Packing::bzip2 : Packing::none;
}

}  // namespace

/// zlib reads plain files too.
struct PackedFile::Streams {
    gzFile gzip = nullptr;
    BZFILE* bzip2 = nullptr;
    ~Streams() {
        if (gzip != nullptr) gzclose(gzip);
        if (bzip2 != nullptr) BZ2_bzclose(bzip2);
    }
};

PackedFile::PackedFile(const std::filesystem::path& file)
    : file_(file), streams_(std::make_unique<Streams>()) {
    if (std::filesystem::is_directory(file)) refuse(file, "is a folder");
    const core::OpenFile is_no_pipe(file);  // the libraries wait at one
    packing_ = packing_of(file);
    if (packing_ == Packing::bzip2)
        streams_->bzip2 = BZ2_bzopen(file.c_str(), "rb");
    else
        streams_->gzip = gzopen(file.c_str(), "rb");
    if (streams_->gzip == nullptr && streams_->bzip2 == nullptr) core::fail_to_read(file, errno);
}

PackedFile::~PackedFile() = default;

std::size_t PackedFile::read(std::span<char> buffer) {
    int error = 0;
    int count = 0;
    if (packing_ == Packing::bzip2) {
        count = BZ2_bzread(streams_->bzip2, buffer.data(), static_cast<int>(buffer.size()));
        BZ2_bzerror(streams_->bzip2, &error);
        if (error == BZ_IO_ERROR) core::fail_to_read(file_, errno);
        if (error != BZ_OK && error != BZ_STREAM_END) count = -1;
    } else {
        count = gzread(streams_->gzip, buffer.data(), static_cast<unsigned>(buffer.size()));
        gzerror(streams_->gzip, &error);
        if (error == Z_ERRNO) core::fail_to_read(file_, errno);
        if (error == Z_BUF_ERROR || error == Z_DATA_ERROR) count = -1;
    }
    if (count < 0) refuse(file_, "is damaged or cut short");
    return static_cast<std::size_t>(count);
}

}  // namespace clearway::scenario_import::detail
