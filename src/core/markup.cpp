#include "core/markup.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace clearway::core {
namespace {

using Entity = std::pair<char, const char*>;
constexpr std::array<Entity, 5> entities = {
    {{'<', "&lt;"}, {'>', "&gt;"}, {'&', "&amp;"}, {'"', "&quot;"}, {'\'', "&#39;"}}};

}  // namespace

std::string escaped(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (const char letter : text) {
        const auto code = static_cast<unsigned char>(letter);
        const auto* const entity = std::ranges::find(entities, letter, &Entity::first);
        if (entity != entities.end())
            result += entity->second;
        else if ((code < 0x20 && letter != '\t' && letter != '\n') || code == 0x7f)
            result += "\xEF\xBF\xBD";
        else
            result += letter;
    }
    return result;
}

}  // namespace clearway::core
