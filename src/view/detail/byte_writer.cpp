#include "view/detail/byte_writer.hpp"

namespace clearway::view::detail {

void ByteWriter::number(std::uint64_t value) {
    constexpr std::uint64_t more = 0x80;
    while (value >= more) {
        byte(static_cast<std::uint8_t>(value | more));
        value >>= 7U;
    }
    byte(static_cast<std::uint8_t>(value));
}

void ByteWriter::signed_number(std::int64_t value) {
    number((static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63U));
}

void ByteWriter::text(std::string_view text) {
    number(text.size());
    bytes_.append(text);
}

}  // namespace clearway::view::detail
