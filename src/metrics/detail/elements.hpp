#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "core/xml_stream.hpp"

namespace clearway::metrics::detail {

/// One element of SUMO's XML, valid while it is handled.
class Element {
  public:
    Element(std::string_view name, const core::XmlAttributes& attributes)
        : name_(name), attributes_(attributes) {}

    std::string_view name() const { return name_; }
    /// Text of an attribute; empty when there is none.
    std::string_view text(std::string_view attribute) const {
        return attributes_.find(attribute).value_or(std::string_view());
    }
    /// Number of an attribute. Throws std::invalid_argument, naming the attribute, when it is not a number.
    double number(std::string_view attribute) const;

  private:
    std::string_view name_;
    const core::XmlAttributes& attributes_;
};

/// Calls `visit` for the start of every element of a file, in order, using a fixed amount of memory. Throws
/// core::InputError when the file is missing, cut off or not XML, and std::runtime_error (`FILE:LINE: what`)
/// for whatever `visit` throws.
void for_each_element(const std::filesystem::path& file, const std::function<void(const Element&)>& visit);

}  // namespace clearway::metrics::detail
