#include "core/markup.hpp"

namespace clearway::core {

std::string escaped(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (const char letter : text) {
        switch (letter) {
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '&':
                result += "&amp;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&#39;";
                break;
            default: {
                const auto code = static_cast<unsigned char>(letter);
                const bool control = (code < 0x20 && letter != '\t' && letter != '\n') || code == 0x7f;
                if (control) {
                    result += "\xEF\xBF\xBD";
                } else {
                    result += letter;
                }
            }
        }
    }
    return result;
}

}  // namespace clearway::core
