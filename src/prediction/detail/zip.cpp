#include "prediction/detail/zip.hpp"

#include <algorithm>
#include <cassert>
#include <optional>

#include <fmt/format.h>
#include <zlib.h>

#include "core/error.hpp"
#include "prediction/detail/bytes.hpp"

namespace clearway::prediction::detail {
namespace {

constexpr std::string_view local_signature("PK\x03\x04", 4);
constexpr std::string_view directory_signature("PK\x01\x02", 4);
constexpr std::string_view end_signature("PK\x05\x06", 4);
constexpr std::size_t local_size = 30;
constexpr std::size_t directory_size = 46;
constexpr std::size_t end_size = 22;
constexpr std::size_t longest_comment = 0xffff;
constexpr std::uint16_t most_members = 4096;  // A state dict has one for each tensor, and three to five more.
constexpr std::uint16_t encrypted = 0x0001;
constexpr std::uint16_t version_needed = 20;
/// In place of a number that stands elsewhere, for archives beyond 4 GB or 65,534 members.
constexpr std::uint32_t elsewhere = 0xffffffffU;

constexpr const char* save_again = "Save it again with torch.save(model.state_dict(), file)";

[[noreturn]] void refuse(const std::string& source, const std::string& what, const std::string& allowed = "",
                         const std::string& cure = save_again) {
    throw core::InputError({source, what, allowed, cure});
}

template <class Number>
Number required(std::string_view bytes, std::size_t at, const std::string& source) {
    const std::optional<Number> number = number_at<Number>(bytes, at);
    if (!number) refuse(source, fmt::format("is cut off: {} bytes, its directory goes on", bytes.size()));
    return *number;
}

std::uint32_t checksum(std::string_view bytes) {
    return static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

/// Where the record stands that ends an archive; a comment may follow it.
std::size_t end_of_directory(std::string_view bytes, const std::string& source) {
    if (bytes.size() >= end_size) {
        const std::size_t last = bytes.size() - end_size;
        const std::size_t first = last > longest_comment ? last - longest_comment : 0;
        for (std::size_t at = last + 1; at-- > first;) {
            if (bytes.substr(at).starts_with(end_signature)) return at;
        }
    }
    refuse(source,
           fmt::format("is cut off: {} bytes, and no directory of the archive at their end", bytes.size()));
}

/// One entry of the directory; moves `at` behind it.
ZipEntry entry_at(std::string_view bytes, std::size_t& at, const std::string& source) {
    if (!bytes.substr(std::min(at, bytes.size())).starts_with(directory_signature))
        refuse(source, "has a damaged directory of the archive");
    const auto flags = required<std::uint16_t>(bytes, at + 8, source);
    const auto method = required<std::uint16_t>(bytes, at + 10, source);
    const auto crc = required<std::uint32_t>(bytes, at + 16, source);
    const auto packed = required<std::uint32_t>(bytes, at + 20, source);
    const auto size = required<std::uint32_t>(bytes, at + 24, source);
    const auto name_length = required<std::uint16_t>(bytes, at + 28, source);
    const auto extra_length = required<std::uint16_t>(bytes, at + 30, source);
    const auto comment_length = required<std::uint16_t>(bytes, at + 32, source);
    const auto local = required<std::uint32_t>(bytes, at + 42, source);
    const std::optional<std::string_view> name = part_of(bytes, at + directory_size, name_length);
    if (!name) refuse(source, fmt::format("is cut off: {} bytes, its directory goes on", bytes.size()));
    at += directory_size + name_length + extra_length + comment_length;

    if ((flags & encrypted) != 0) refuse(source, fmt::format("{} is encrypted", *name), "plain members");
    if (method != 0)
        refuse(source, fmt::format("{} is compressed (method {})", *name, method),
               "stored members, as torch.save writes them");
    if (size == elsewhere || packed == elsewhere || local == elsewhere)
        refuse(source, fmt::format("{} has its size in a zip64 field", *name), "archives below 4 GB");
    if (size != packed)
        refuse(source, fmt::format("{} has {} bytes, stored as {}", *name, size, packed), "equal sizes");

    // The names of both headers agree in length, their extra fields do not.
    const bool has_header =
        bytes.substr(std::min<std::size_t>(local, bytes.size())).starts_with(local_signature);
    if (!has_header) refuse(source, fmt::format("{} is not where the directory says", *name));
    const std::size_t begin = std::size_t{local} + local_size +
                              required<std::uint16_t>(bytes, local + 26, source) +
                              required<std::uint16_t>(bytes, local + 28, source);
    const std::optional<std::string_view> content = part_of(bytes, begin, size);
    if (!content) refuse(source, fmt::format("is cut off within {}", *name));
    return {std::string(*name), *content, crc};
}

void check_content(const ZipEntry& entry, const std::string& source) {
    const std::uint32_t crc = checksum(entry.content);
    if (crc == entry.crc) return;
    refuse(source, fmt::format("{} is damaged: its checksum is {:08x}", entry.name, crc),
           fmt::format("{:08x}, as its directory says", entry.crc));
}

/// The fields that the local header and the directory share, from `version needed` to `length of the name`.
std::string common_fields(const std::string& name, std::string_view content) {
    constexpr std::uint16_t first_of_january_1980 = 0x0021;
    const auto size = static_cast<std::uint32_t>(content.size());
    std::string fields;
    append_number(fields, version_needed);
    append_number(fields, std::uint16_t{0});  // flags
    append_number(fields, std::uint16_t{0});  // method: stored
    append_number(fields, std::uint16_t{0});  // time
    append_number(fields, first_of_january_1980);
    append_number(fields, checksum(content));
    append_number(fields, size);  // compressed
    append_number(fields, size);
    append_number(fields, static_cast<std::uint16_t>(name.size()));
    return fields;
}

}  // namespace

bool starts_as_zip(std::string_view bytes) {
    return bytes.starts_with(local_signature) || bytes.starts_with(end_signature);
}

std::vector<ZipEntry> zip_entries(std::string_view bytes, const std::string& source) {
    if (!starts_as_zip(bytes)) refuse(source, "is no zip archive", "an archive of torch.save");
    const std::size_t end = end_of_directory(bytes, source);
    const auto disk = required<std::uint16_t>(bytes, end + 4, source);
    const auto count_here = required<std::uint16_t>(bytes, end + 8, source);
    const auto count = required<std::uint16_t>(bytes, end + 10, source);
    std::size_t at = required<std::uint32_t>(bytes, end + 16, source);
    if (disk != 0 || count_here != count) refuse(source, "is an archive of several volumes", "one file");
    if (count == 0xffff || at == elsewhere)
        refuse(source, "has its directory in zip64 fields", "archives below 4 GB and 65,535 members");
    if (count > most_members)
        refuse(source, fmt::format("has {} members", count), fmt::format("{} at most", most_members));
    std::vector<ZipEntry> entries;
    std::size_t size = 0;
    for (std::uint16_t entry = 0; entry < count; ++entry) {
        entries.push_back(entry_at(bytes, at, source));
        const std::string& name = entries.back().name;
        if (std::ranges::count(entries, name, &ZipEntry::name) > 1)
            refuse(source, fmt::format("holds {} twice", name));
        size += entries.back().content.size();
        if (size > bytes.size()) refuse(source, fmt::format("holds members that overlap, {} is one", name));
    }
    for (const ZipEntry& entry : entries)
        check_content(entry, source);
    return entries;
}

void ZipArchive::add(const std::string& name, std::string_view content) {
    constexpr std::size_t alignment = 64;
    constexpr std::size_t padding_header_size = 4;
    constexpr std::uint16_t padding_id = 0x4246;  // "FB", the id under which PyTorch stores its padding.
    assert(bytes_.size() + content.size() < 0xf0000000U && name.size() < 0xffffU);
    const auto offset = static_cast<std::uint32_t>(bytes_.size());
    const std::string fields = common_fields(name, content);
    const std::size_t unpadded = bytes_.size() + local_size + name.size() + padding_header_size;
    const auto padding = static_cast<std::uint16_t>((alignment - unpadded % alignment) % alignment);
    bytes_ += local_signature;
    bytes_ += fields;
    append_number(bytes_, static_cast<std::uint16_t>(padding_header_size + padding));
    bytes_ += name;
    append_number(bytes_, padding_id);
    append_number(bytes_, padding);
    bytes_.append(padding, 'Z');
    bytes_ += content;

    directory_ += directory_signature;
    append_number(directory_, version_needed);  // made by
    directory_ += fields;
    directory_.append(12, '\0');  // extra field, comment, disk, internal and external attributes
    append_number(directory_, offset);
    directory_ += name;
    ++members_;
}

std::string ZipArchive::finish() && {
    const auto directory_offset = static_cast<std::uint32_t>(bytes_.size());
    bytes_ += directory_;
    bytes_ += end_signature;
    bytes_.append(4, '\0');  // this disk, disk of the directory
    append_number(bytes_, members_);
    append_number(bytes_, members_);
    append_number(bytes_, static_cast<std::uint32_t>(directory_.size()));
    append_number(bytes_, directory_offset);
    bytes_.append(2, '\0');  // comment
    return std::move(bytes_);
}

}  // namespace clearway::prediction::detail
