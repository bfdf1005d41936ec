#include "core/toml_levels.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "core/error.hpp"

namespace clearway::core {
namespace {

/// Most parts of a dotted key, and levels of arrays and tables in a value. Clearway's own keys have at most
/// four parts. toml++ follows both by calling itself.
constexpr std::size_t most_toml_levels = 50;

/// Counts the levels of TOML text without parsing it.
class TomlLevels {
  public:
    TomlLevels(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    void check() {
        while (at_ < text_.size()) {
            const char letter = text_[at_];
            if (letter == '"' || letter == '\'') {
                skip_text(letter);
                continue;
            }
            if (letter == '#') at_ = std::min(text_.find('\n', at_), text_.size() - 1);
            count(text_[at_++]);
        }
    }

  private:
    void count(char letter) {
        if (letter == '\n') ++line_;
        if (letter == '.') ++parts_;
        if (letter == '[' || letter == '{') ++open_;
        if ((letter == ']' || letter == '}') && open_ > 0) --open_;
        if (std::string_view("=,[]{}\n").find(letter) != std::string_view::npos) parts_ = 1;
        if (std::max(parts_, open_) <= most_toml_levels) return;
        throw InputError({fmt::format("{}:{}", file_, line_),
                          fmt::format("has a {} of more than {} levels", parts_ > open_ ? "key" : "value",
                                      most_toml_levels),
                          fmt::format("at most {} levels", most_toml_levels), "Correct this line"});
    }

    /// Over a text in quotes of one kind, single or triple.
    void skip_text(char quote) {
        const std::string triple(3, quote);
        const std::string end = text_.substr(at_, 3) == triple ? triple : std::string(1, quote);
        at_ += end.size();
        while (at_ < text_.size() && text_.substr(at_, end.size()) != end) {
            if (text_[at_] == '\n') ++line_;
            at_ += quote == '"' && text_[at_] == '\\' ? 2 : 1;
        }
        at_ += end.size();
        if (end.size() == 1) return;
        for (int more = 0; more < 2 && at_ < text_.size() && text_[at_] == quote; ++more)
            ++at_;  // a text in triple quotes may end with two of its own
    }

    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
    std::size_t parts_ = 1;
    std::size_t open_ = 0;
};

}  // namespace

void check_toml_levels(std::string_view text, const std::string& file) {
    TomlLevels(text, file).check();
}

}  // namespace clearway::core
