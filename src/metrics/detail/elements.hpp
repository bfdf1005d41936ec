#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace clearway::metrics::detail {

/// One element of SUMO's XML, valid while it is handled.
class Element {
  public:
    Element(std::string_view name, const char** attributes, unsigned long line)
        : name_(name), attributes_(attributes), line_(line) {}

    std::string_view name() const { return name_; }
    unsigned long line() const { return line_; }
    /// Text of an attribute; empty when there is none.
    std::string_view text(std::string_view attribute) const;
    /// Number of an attribute. Throws std::invalid_argument naming the attribute when it is none.
    double number(std::string_view attribute) const;

  private:
    std::string_view name_;
    const char** attributes_;
    unsigned long line_;
};

/// Calls `visit` for the start of every element of a file, in its order, with a fixed amount of memory.
/// Throws std::runtime_error (`FILE:LINE: what`) when the file is missing, cut off or not XML, and for
/// whatever `visit` throws.
void for_each_element(const std::filesystem::path& file, const std::function<void(const Element&)>& visit);

}  // namespace clearway::metrics::detail
