#pragma once

#include <exception>
#include <filesystem>
#include <optional>
#include <string_view>

namespace clearway::core {

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

/// Receives the elements of a document in their order.
class XmlHandler {
  public:
    XmlHandler() = default;
    XmlHandler(const XmlHandler&) = delete;
    XmlHandler& operator=(const XmlHandler&) = delete;
    virtual ~XmlHandler() = default;

    /// `line` is that of the element's first letter, from 1. Whatever this throws leaves `stream_xml`.
    virtual void start(std::string_view element, const XmlAttributes& attributes, unsigned long line) = 0;
    virtual void end(std::string_view element) = 0;
    /// A part of the text between elements; one text may come in several parts. Ignored by default.
    virtual void characters(std::string_view) {}
};

/// Reads an XML file, packed with gzip or not, through `handler` with a fixed amount of memory. Throws
/// core::InputError naming file and line when it is missing, damaged or not XML.
void stream_xml(const std::filesystem::path& file, XmlHandler& handler);

}  // namespace clearway::core
