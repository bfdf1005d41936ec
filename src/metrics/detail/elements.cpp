#include "metrics/detail/elements.hpp"

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>

#include <expat.h>
#include <fmt/format.h>

namespace clearway::metrics::detail {
namespace {

constexpr int chunk_bytes = 1 << 16;

using ParserHandle = std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)>;
struct CloseFile {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
};

/// What the callback needs. Exceptions must not cross expat, which is C: they wait in `failure`.
struct Job {
    XML_Parser parser;
    const std::function<void(const Element&)>& visit;
    std::string failure;
};

void on_start(void* user, const XML_Char* name, const XML_Char** attributes) {
    auto& job = *static_cast<Job*>(user);
    if (!job.failure.empty()) return;
    try {
        job.visit(Element(name, attributes, XML_GetCurrentLineNumber(job.parser)));
    } catch (const std::exception& error) {
        job.failure = error.what();
        XML_StopParser(job.parser, XML_FALSE);
    }
}

[[noreturn]] void fail(const std::filesystem::path& file, const Job& job, const std::string& what) {
    throw std::runtime_error(
        fmt::format("{}:{}: {}", file.string(), XML_GetCurrentLineNumber(job.parser), what));
}

}  // namespace

std::string_view Element::text(std::string_view attribute) const {
    for (const char** pair = attributes_; *pair != nullptr; pair += 2) {
        if (attribute == pair[0]) return pair[1];
    }
    return {};
}

double Element::number(std::string_view attribute) const {
    const std::string_view word = text(attribute);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
        throw std::invalid_argument(fmt::format("{}: {}=\"{}\" is not a number", name_, attribute, word));
    }
    return value;
}

void for_each_element(const std::filesystem::path& file, const std::function<void(const Element&)>& visit) {
    const std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(file.c_str(), "rb"));
    if (!stream) throw std::runtime_error(fmt::format("{}: {}", file.string(), std::strerror(errno)));
    const ParserHandle parser(XML_ParserCreate(nullptr), &XML_ParserFree);
    if (!parser) throw std::bad_alloc();
    Job job{parser.get(), visit, {}};
    XML_SetUserData(parser.get(), &job);
    XML_SetStartElementHandler(parser.get(), on_start);
    for (bool at_end = false; !at_end;) {
        void* buffer = XML_GetBuffer(parser.get(), chunk_bytes);
        if (buffer == nullptr) throw std::bad_alloc();
        const std::size_t count = std::fread(buffer, 1, chunk_bytes, stream.get());
        if (std::ferror(stream.get()) != 0) fail(file, job, "cannot be read");
        at_end = count == 0;
        const XML_Status status = XML_ParseBuffer(parser.get(), static_cast<int>(count), at_end ? 1 : 0);
        if (!job.failure.empty()) fail(file, job, job.failure);
        if (status == XML_STATUS_ERROR) fail(file, job, XML_ErrorString(XML_GetErrorCode(parser.get())));
    }
}

}  // namespace clearway::metrics::detail
