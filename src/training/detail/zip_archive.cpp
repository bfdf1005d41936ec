#include "training/detail/zip_archive.hpp"

#include <cassert>
#include <cstring>

#include <zlib.h>

namespace clearway::training::detail {
namespace {

constexpr std::size_t alignment = 64;
constexpr std::size_t local_header_size = 30;
constexpr std::size_t padding_header_size = 4;
constexpr std::uint16_t version_needed = 20;
constexpr std::uint16_t first_of_january_1980 = 0x0021;
constexpr std::uint16_t padding_id = 0x4246;  // "FB", the id under which PyTorch stores its padding.

template <class Number>
void append(std::string& bytes, Number number) {
    char raw[sizeof(Number)];
    std::memcpy(raw, &number, sizeof(Number));
    bytes.append(raw, sizeof(Number));
}

/// The fields that the local header and the directory share, from `version needed` to `length of the name`.
std::string common_fields(const std::string& name, std::string_view content) {
    const auto* data = reinterpret_cast<const Bytef*>(content.data());
    const auto size = static_cast<std::uint32_t>(content.size());
    std::string fields;
    append(fields, version_needed);
    append(fields, std::uint16_t{0});  // flags
    append(fields, std::uint16_t{0});  // method: stored
    append(fields, std::uint16_t{0});  // time
    append(fields, first_of_january_1980);
    append(fields, static_cast<std::uint32_t>(crc32(crc32(0, nullptr, 0), data, size)));
    append(fields, size);  // compressed
    append(fields, size);
    append(fields, static_cast<std::uint16_t>(name.size()));
    return fields;
}

}  // namespace

void ZipArchive::add(const std::string& name, std::string_view content) {
    assert(bytes_.size() + content.size() < 0xf0000000U && name.size() < 0xffffU);
    const auto offset = static_cast<std::uint32_t>(bytes_.size());
    const std::string fields = common_fields(name, content);

    const std::size_t unpadded = bytes_.size() + local_header_size + name.size() + padding_header_size;
    const auto padding = static_cast<std::uint16_t>((alignment - unpadded % alignment) % alignment);
    append(bytes_, std::uint32_t{0x04034b50});
    bytes_ += fields;
    append(bytes_, static_cast<std::uint16_t>(padding_header_size + padding));
    bytes_ += name;
    append(bytes_, padding_id);
    append(bytes_, padding);
    bytes_.append(padding, 'Z');
    bytes_ += content;

    append(directory_, std::uint32_t{0x02014b50});
    append(directory_, version_needed);  // made by
    directory_ += fields;
    append(directory_, std::uint16_t{0});  // extra field
    append(directory_, std::uint16_t{0});  // comment
    append(directory_, std::uint16_t{0});  // disk
    append(directory_, std::uint16_t{0});  // internal attributes
    append(directory_, std::uint32_t{0});  // external attributes
    append(directory_, offset);
    directory_ += name;
    ++members_;
}

std::string ZipArchive::finish() && {
    const auto directory_offset = static_cast<std::uint32_t>(bytes_.size());
    bytes_ += directory_;
    append(bytes_, std::uint32_t{0x06054b50});
    append(bytes_, std::uint16_t{0});  // this disk
    append(bytes_, std::uint16_t{0});  // disk of the directory
    append(bytes_, members_);
    append(bytes_, members_);
    append(bytes_, static_cast<std::uint32_t>(directory_.size()));
    append(bytes_, directory_offset);
    append(bytes_, std::uint16_t{0});  // comment
    return std::move(bytes_);
}

}  // namespace clearway::training::detail
