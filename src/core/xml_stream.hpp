#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace clearway::core {

/// Deepest element that is read; SUMO's files and maps have less than ten levels. More would exhaust the
/// stack of readers that follow the levels.
inline constexpr int most_xml_levels = 200;

/// The attributes of one element, valid while it is handled.
class XmlAttributes {
  public:
    explicit XmlAttributes(const char** pairs) : pairs_(pairs) {}
    /// Nothing when the element has no such attribute.
    std::optional<std::string_view> find(std::string_view name) const;
    /// Calls `visit(name, value)` for each, in the order of the file.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (const char** pair = pairs_; *pair != nullptr; pair += 2)
            visit(std::string_view(pair[0]), std::string_view(pair[1]));
    }

  private:
    const char** pairs_;
};

/// Receives the elements of a document in document order.
class XmlHandler {
  public:
    XmlHandler() = default;
    XmlHandler(const XmlHandler&) = delete;
    XmlHandler& operator=(const XmlHandler&) = delete;
    virtual ~XmlHandler() = default;

    /// `line` is where the element begins, from 1. Exceptions thrown here leave `stream_xml`.
    virtual void start(std::string_view element, const XmlAttributes& attributes, unsigned long line) = 0;
    virtual void end(std::string_view element) = 0;
    /// A piece of the text between elements; one text may come in several pieces. Ignored by default.
    virtual void characters(std::string_view) {}
};

/// Streams an XML file, plain or gzipped, to `handler` in a fixed amount of memory. Throws core::InputError
/// naming file and line when it is missing, damaged, not XML, has a document type or is nested deeper than
/// `most_xml_levels`.
void stream_xml(const std::filesystem::path& file, XmlHandler& handler);

/// The problem of a file with more levels; `where` is the file, with the line where it is known.
Problem too_many_levels(const std::string& where);

}  // namespace clearway::core
