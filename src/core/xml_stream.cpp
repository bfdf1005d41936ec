#include "core/xml_stream.hpp"

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>

#include <expat.h>
#include <fmt/format.h>
#include <zlib.h>

#include "core/error.hpp"
#include "core/machine_failure.hpp"
#include "core/open_file.hpp"
#include "core/read_failure.hpp"

namespace clearway::core {
namespace {

constexpr int chunk_bytes = 1 << 18;

using ParserHandle = std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)>;
using GzipHandle = std::unique_ptr<gzFile_s, decltype(&gzclose_r)>;

/// What the callbacks need. Exceptions must not pass through expat, which is C, so they are kept in
/// `failure`.
struct Job {
    XML_Parser parser;
    XmlHandler& handler;
    const std::filesystem::path& file;
    std::exception_ptr failure = {};
    int level = 0;

    template <class Action>
    void guarded(const Action& action) {
        if (failure) return;
        try {
            action();
        } catch (...) {
            failure = std::current_exception();
            XML_StopParser(parser, XML_FALSE);
        }
    }
};

void on_start(void* user, const XML_Char* element, const XML_Char** attributes) {
    auto& job = *static_cast<Job*>(user);
    job.guarded([&] {
        const unsigned long line = XML_GetCurrentLineNumber(job.parser);
        if (++job.level > most_xml_levels)
            throw InputError(too_many_levels(fmt::format("{}:{}", job.file.string(), line)));
        job.handler.start(element, XmlAttributes(attributes), line);
    });
}

void on_end(void* user, const XML_Char* element) {
    auto& job = *static_cast<Job*>(user);
    --job.level;
    job.guarded([&] { job.handler.end(element); });
}

void on_text(void* user, const XML_Char* text, int length) {
    auto& job = *static_cast<Job*>(user);
    job.guarded([&] { job.handler.characters({text, static_cast<std::size_t>(length)}); });
}

/// With a document type come entities: SUMO would put text, or a file, where this reader sees nothing.
void on_document_type(void* user, const XML_Char* name, const XML_Char*, const XML_Char*, int) {
    auto& job = *static_cast<Job*>(user);
    job.guarded([&] {
        throw InputError({fmt::format("{}:{}", job.file.string(), XML_GetCurrentLineNumber(job.parser)),
                          fmt::format("declares the document type \"{}\"", name), "XML without <!DOCTYPE>",
                          "Remove it, and write what its entities stand for in their place"});
    });
}

[[noreturn]] void fail_unreadable(const std::filesystem::path& file, const std::string& reason) {
    throw core::InputError({file.string(), "cannot be read: " + reason, "",
                            "Check that the file exists, is readable and is complete"});
}

/// Reads the next chunk of the file and returns its size; 0 at the end.
int read_chunk(gzFile input, void* buffer, const std::filesystem::path& file) {
    const int count = gzread(input, buffer, chunk_bytes);
    int code = Z_OK;
    const char* reason = gzerror(input, &code);
    if (count < 0 || code == Z_BUF_ERROR || code == Z_DATA_ERROR) {
        if (code == Z_ERRNO) fail_to_read(file, errno);
        fail_unreadable(file, reason);
    }
    return count;
}

[[noreturn]] void fail_at_parser(XML_Parser parser, const std::filesystem::path& file) {
    if (XML_GetErrorCode(parser) == XML_ERROR_NO_MEMORY) throw no_memory();
    throw core::InputError({fmt::format("{}:{}", file.string(), XML_GetCurrentLineNumber(parser)),
                            fmt::format("is not valid XML: {}", XML_ErrorString(XML_GetErrorCode(parser))),
                            "", "Check that the file is complete and was not edited by mistake"});
}

}  // namespace

std::optional<std::string_view> XmlAttributes::find(std::string_view name) const {
    for (const char** pair = pairs_; *pair != nullptr; pair += 2) {
        if (name == pair[0]) return std::string_view(pair[1]);
    }
    return std::nullopt;
}

Problem too_many_levels(const std::string& where) {
    return {where, fmt::format("has more than {} levels of elements", most_xml_levels),
            fmt::format("at most {} levels", most_xml_levels), "Check that it is the right file"};
}

void stream_xml(const std::filesystem::path& file, XmlHandler& handler) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) fail_unreadable(file, "it is a folder");
    const OpenFile is_no_pipe(file);
    errno = 0;
    const GzipHandle input(gzopen(file.c_str(), "rb"), &gzclose_r);
    if (!input) fail_to_read(file, errno == 0 ? ENOMEM : errno);
    const ParserHandle parser(XML_ParserCreate(nullptr), &XML_ParserFree);
    if (!parser) throw no_memory();

    Job job{parser.get(), handler, file};
    XML_SetUserData(parser.get(), &job);
    XML_SetElementHandler(parser.get(), on_start, on_end);
    XML_SetCharacterDataHandler(parser.get(), on_text);
    XML_SetStartDoctypeDeclHandler(parser.get(), on_document_type);
    for (bool at_end = false; !at_end;) {
        void* buffer = XML_GetBuffer(parser.get(), chunk_bytes);
        if (buffer == nullptr) throw no_memory();
        const int count = read_chunk(input.get(), buffer, file);
        at_end = count == 0;
        const XML_Status status = XML_ParseBuffer(parser.get(), count, at_end ? XML_TRUE : XML_FALSE);
        if (job.failure) std::rethrow_exception(job.failure);
        if (status == XML_STATUS_ERROR) fail_at_parser(parser.get(), file);
    }
}

}  // namespace clearway::core
