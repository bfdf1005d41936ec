#include "scenario/detail/xml_text.hpp"

#include <array>
#include <cerrno>
#include <memory>

#include <fmt/format.h>
#include <zlib.h>

#include "core/error.hpp"
#include "core/machine_failure.hpp"
#include "core/open_file.hpp"
#include "core/read_failure.hpp"
#include "core/xml_stream.hpp"
#include "traffic/written_files.hpp"

namespace clearway::scenario::detail {
namespace {

struct TextWriter : pugi::xml_writer {
    std::string text;
    void write(const void* data, std::size_t size) override {
        text.append(static_cast<const char*>(data), size);
    }
};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what,
                         const std::string& kind) {
    throw core::InputError(core::Problem{file.string(), what, kind, "choose another file"});
}

/// Largest document that is loaded as a whole, unpacked: some 400,000 edges, and about 2 GiB of memory. A
/// packed file of blanks could fill any memory.
constexpr std::size_t most_bytes = std::size_t{512} << 20;

/// The bytes of a file, unpacked if it is gzipped.
std::string inflated(const std::filesystem::path& file, const std::string& kind) {
    const core::OpenFile is_no_pipe(file);
    errno = 0;
    const std::unique_ptr<gzFile_s, decltype(&gzclose_r)> stream(gzopen(file.c_str(), "rb"), &gzclose_r);
    if (!stream) core::fail_to_read(file, errno == 0 ? ENOMEM : errno);
    std::string bytes;
    std::array<char, 1 << 16> buffer{};
    int count = 0;
    while ((count = gzread(stream.get(), buffer.data(), buffer.size())) > 0) {
        bytes.append(buffer.data(), static_cast<std::size_t>(count));
        if (bytes.size() > most_bytes)
            refuse(file, fmt::format("has more than {} MiB unpacked", most_bytes >> 20),
                   fmt::format("{} of at most {} MiB", kind, most_bytes >> 20));
    }
    int code = Z_OK;
    gzerror(stream.get(), &code);
    if (code == Z_ERRNO) core::fail_to_read(file, errno);
    if (count < 0) refuse(file, "is damaged or cut short", kind);
    return bytes;
}

/// Stops at an element that is too deep; pugixml itself follows the levels without calling itself.
struct LevelWatch : pugi::xml_tree_walker {
    bool for_each(pugi::xml_node&) override { return depth() < core::most_xml_levels; }
};

}  // namespace

pugi::xml_document load_xml(const std::filesystem::path& file, const std::string& kind, unsigned options) {
    const std::string bytes = inflated(file, kind);
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(bytes.data(), bytes.size(), options);
    if (result.status == pugi::status_out_of_memory) throw core::no_memory();
    if (!result)
        refuse(file, fmt::format("is not XML: {} at byte {}", result.description(), result.offset), kind);
    LevelWatch levels;
    if (!document.traverse(levels)) throw core::InputError(core::too_many_levels(file.string()));
    return document;
}

std::string element_text(pugi::xml_node element) {
    const auto writes = [](pugi::xml_node child) {
        return std::string_view(child.name()) == "param" &&
               traffic::lets_vehicles_write(child.attribute("key").value());
    };
    while (const pugi::xml_node parameter = element.find_child(writes))
        element.remove_child(parameter);
    TextWriter writer;
    element.print(writer, "    ", pugi::format_indent, pugi::encoding_utf8, 1);
    return std::move(writer.text);
}

std::string document_text(const pugi::xml_document& document) {
    TextWriter writer;
    document.save(writer, "    ", pugi::format_indent, pugi::encoding_utf8);
    return std::move(writer.text);
}

}  // namespace clearway::scenario::detail
