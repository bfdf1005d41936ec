#include "results/detail/csv.hpp"

namespace clearway::results::detail {

std::string csv_text(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
    std::string quoted = "\"";
    for (const char letter : text) {
        if (letter == '"') quoted += '"';
        quoted += letter;
    }
    return quoted + '"';
}

std::vector<std::vector<std::string>> parse_csv(std::string_view text) {
    std::vector<std::vector<std::string>> rows;
    bool quoted = false;
    bool row_open = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char letter = text[at];
        if (!row_open) {
            rows.push_back({""});
            row_open = true;
        }
        std::string& cell = rows.back().back();
        if (quoted && letter == '"' && at + 1 < text.size() && text[at + 1] == '"') {
            cell += '"';
            ++at;
        } else if (letter == '"') {
            quoted = !quoted;
        } else if (!quoted && letter == ',') {
            rows.back().emplace_back();
        } else if (!quoted && letter == '\n') {
            row_open = false;
        } else {
            cell += letter;
        }
    }
    if (quoted) throw std::runtime_error("a quote does not end");
    return rows;
}

}  // namespace clearway::results::detail
