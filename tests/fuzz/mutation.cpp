#include "fuzz/mutation.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace clearway::fuzz {
namespace {

/// Uniform enough, and alike on every machine.
std::size_t below(std::size_t bound, std::mt19937_64& draw) {
    return bound == 0 ? 0 : draw() % bound;
}

const std::string& one_of(const std::vector<std::string>& texts, std::mt19937_64& draw) {
    return texts[below(texts.size(), draw)];
}

/// A piece, mostly short.
std::pair<std::size_t, std::size_t> piece(const std::string& text, std::mt19937_64& draw) {
    const std::size_t at = below(text.size() + 1, draw);
    const std::size_t most = below(4, draw) == 0 ? text.size() : 16;
    return {at, below(std::min(most, text.size() - at) + 1, draw)};
}

void exchange_number(std::string& text, std::mt19937_64& draw) {
    static const std::vector<std::string> numbers = {"0",           "-1",
                                                     "1",           "0.5",
                                                     "1e9",         "4294967296",
                                                     "-2147483649", "9223372036854775807",
                                                     "1e-320",      "1e308",
                                                     "nan",         "255",
                                                     "65536",       "000000000000000000001"};
    const auto is_digit = [](unsigned char letter) { return std::isdigit(letter) != 0; };
    const auto from = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(below(text.size(), draw)),
                                   text.end(), is_digit);
    const auto to = std::find_if_not(from, text.end(), is_digit);
    if (from != to) text.replace(from, to, one_of(numbers, draw));
}

void change(std::string& text, const Reader& reader, std::mt19937_64& draw) {
    const auto [at, length] = piece(text, draw);
    switch (below(9, draw)) {
        case 0:
            if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1U << below(8, draw)));
            break;
        case 1:
            if (at < text.size()) text[at] = static_cast<char>(draw());
            break;
        case 2:
            text.erase(at, length);
            break;
        case 3:
            text.insert(at, text.substr(at, length));
            break;
        case 4: {
            const std::string moved = text.substr(at, length);
            text.erase(at, length);
            text.insert(below(text.size() + 1, draw), moved);
            break;
        }
        case 5:
            exchange_number(text, draw);
            break;
        case 6: {
            const std::string& other = one_of(reader.seeds, draw);
            text.resize(at);
            text += other.substr(below(other.size() + 1, draw));
            break;
        }
        case 7: {
            static constexpr std::array<char, 4> ends = {'\0', '\x7f', '\x80', '\xff'};
            text.insert(at, 1 + below(8, draw), ends[below(ends.size(), draw)]);
            break;
        }
        default:
            if (reader.words.empty()) break;
            text.replace(at, below(2, draw) * length, one_of(reader.words, draw));
    }
}

}  // namespace

std::string changed_seed(const Reader& reader, std::mt19937_64& draw) {
    std::string text = one_of(reader.seeds, draw);
    const std::size_t most = 2 * std::ranges::max(reader.seeds, {}, &std::string::size).size() + 64;
    for (std::size_t left = 1 + below(4, draw); left > 0; --left)
        change(text, reader, draw);
    text.resize(std::min(text.size(), most));
    return text;
}

}  // namespace clearway::fuzz
