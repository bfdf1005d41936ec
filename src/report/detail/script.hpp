#pragma once

#include <string>
#include <string_view>

namespace clearway::report::detail {

/// The page's script: downloads of figures and tables, unfolding for print and for links. The page says all
/// that it has to say without it. From page/report.js.
extern const char* const script_text;
/// Its SHA-256, 64 hexadecimal digits.
extern const char* const script_sha256;

/// A hash in hexadecimal digits as a content policy names it: `sha256-` and base64 (RFC 4648).
std::string policy_source(std::string_view sha256);

}  // namespace clearway::report::detail
