#include "core/csv.hpp"

#include <algorithm>

namespace clearway::core {

std::string_view take_line(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

std::string csv_text(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
    std::string quoted = "\"";
    for (const char letter : text) {
        if (letter == '"') quoted += '"';
        quoted += letter;
    }
    return quoted + '"';
}

bool CsvReader::next() {
    cells_.clear();
    unquoted_.clear();
    if (at_ >= text_.size()) return false;
    while (read_cell()) {
    }
    return true;
}

bool CsvReader::read_cell() {
    const std::size_t start = at_;
    while (at_ < text_.size() && text_[at_] != ',' && text_[at_] != '\n') {
        if (text_[at_] == '"') return read_quoted_cell(start);
        ++at_;
    }
    std::string_view cell = text_.substr(start, at_ - start);
    if (is_at_end_of_row() && cell.ends_with('\r')) cell.remove_suffix(1);
    cells_.push_back(cell);
    return pass_separator();
}

bool CsvReader::read_quoted_cell(std::size_t start) {
    std::string& cell = unquoted_.emplace_back();
    bool quoted = false;
    for (at_ = start; at_ < text_.size(); ++at_) {
        const char letter = text_[at_];
        if (!quoted && (letter == ',' || letter == '\n')) break;
        if (letter != '"') {
            cell += letter;
        } else if (quoted && at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
            cell += text_[++at_];
        } else {
            quoted = !quoted;
        }
    }
    if (quoted) throw std::runtime_error("a quote is not closed");
    if (is_at_end_of_row() && text_[at_ - 1] == '\r') cell.pop_back();
    cells_.emplace_back(cell);
    return pass_separator();
}

bool CsvReader::is_at_end_of_row() const {
    return at_ >= text_.size() || text_[at_] == '\n';
}

bool CsvReader::pass_separator() {
    if (at_ >= text_.size()) return false;
    return text_[at_++] == ',';
}

}  // namespace clearway::core
