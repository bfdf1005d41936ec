#pragma once

#include <optional>
#include <type_traits>

namespace clearway::core {

/// One row of a field table. A configuration, metrics or record struct lists its members once, as
///
///     static constexpr void fields(const auto& table) {
///         table(core::Field{"radius_m", "m", &Config::radius_m, 1.0, 1000.0, "Link radius.",
///                           "dissertation 4.1; 50 m assumed"},
///               ...);
///     }
///
/// and parsing, range checks, printing, hashing, CSV headers and reference pages all come from that list. It
/// may call `table` several times and the `fields` of a base. (A std::tuple of a hundred fields costs each
/// source that includes it seconds to compile.) The default of a field is the member's initialiser. `minimum`
/// and `maximum` are inclusive and in the field's unit; they are ignored for text, for booleans and for
/// enumerations.
template <class Struct, class Member>
struct Field {
    const char* name;
    const char* unit;  ///< SI symbol; "1" for ratios and counts, "" for text.
    Member Struct::*member;
    double minimum;
    double maximum;
    const char* doc;
    const char* source;  ///< Where the default comes from.
};

template <class Struct, class Member>
Field(const char*, const char*, Member Struct::*, double, double, const char*, const char*)
    -> Field<Struct, Member>;

/// A struct with a field table.
template <class Struct>
concept HasFields = requires {
    Struct::fields([](const auto&...) {});
};

/// Calls `visit(field)` for every field of `Struct`, in the order of its table.
template <class Struct, class Visitor>
constexpr void for_each_field(Visitor&& visit) {
    Struct::fields([&](const auto&... field) { (visit(field), ...); });
}

/// Whether a member may be absent.
template <class Member>
struct OptionalMember : std::false_type {};
template <class Value>
struct OptionalMember<std::optional<Value>> : std::true_type {};

}  // namespace clearway::core
