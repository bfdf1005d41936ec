#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include <toml++/toml.h>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/spellings.hpp"

namespace clearway::core {

/// What reading a TOML file collects: problems, and where each key stood.
struct TomlReading {
    std::string file;
    std::vector<Problem> problems;
    std::map<std::string, std::string>
        origins;                          ///< `time.window_s` -> `merge/scenario.toml:14:1: time.window_s`.
    std::set<std::string> misspelt = {};  ///< Tables with an unknown key, `time`.
    std::set<std::string> meant = {};     ///< The known keys nearest to unknown ones, `time.window_s`.
};

/// Reads one table of a TOML file and collects its problems. Every key that is asked for counts as known;
/// `finish` reports all others. A key that the file does not have leaves its target as it is.
class StrictTable {
  public:
    /// `path` is the table's own key, empty for the root. `table` and `reading` must outlive this.
    StrictTable(const toml::table& table, std::string path, TomlReading& reading);

    /// Reads every member of the struct's field table that the file sets. A floating-point member that is
    /// wrong there becomes NaN, for which no later comparison finds a second fault.
    template <class Struct>
    void read(Struct& target) {
        for_each_field<Struct>([&](const auto& field) { member(field, target.*field.member); });
    }
    /// Text that is not empty.
    void text(const std::string& key, std::string& target);
    /// Empty for what is no text, too.
    void text_or_empty(const std::string& key, std::string& target);
    void texts(const std::string& key, std::vector<std::string>& target);
    /// An array of arrays of texts.
    void text_lists(const std::string& key, std::vector<std::vector<std::string>>& target);
    void number(const std::string& key, std::optional<double>& target);
    template <class Integer>
    void integer(const std::string& key, std::int64_t minimum, std::int64_t maximum, Integer& target) {
        const auto value = whole_number(key, minimum, maximum);
        if (value) target = static_cast<Integer>(*value);
    }
    /// One of the words of an enumeration; `Target` is `Enum` or `std::optional<Enum>`.
    template <Spelled Enum, class Target>
    void word(const std::string& key, Target& target) {
        std::vector<Enum> found;
        if (const auto text = any_text(key)) add_word(key, *text, found);
        if (!found.empty()) target = found.front();
    }
    /// A list of such words.
    template <Spelled Enum>
    void words(const std::string& key, std::vector<Enum>& target) {
        std::vector<std::string> found;
        texts(key, found);
        for (const std::string& one : found)
            add_word(key, one, target);
    }
    /// A subtable, or nullptr when the file has none.
    const toml::table* table(const std::string& key);
    /// A reader of the subtable, or nothing when the file has none.
    std::optional<StrictTable> below(const std::string& key);
    /// The tables of `[[key]]`; empty when the file has none.
    std::vector<const toml::table*> tables(const std::string& key);
    /// Readers of the tables of `[[key]]`, called `key[0]`, `key[1]`, ...
    std::vector<StrictTable> rows(const std::string& key);
    /// Reports every key that was never asked for, with the nearest valid one.
    void finish();
    bool has(const std::string& key) const { return table_.contains(key); }

    /// `study.toml:3:1: condition.name`; for a missing key the place of the table.
    std::string where(const std::string& key) const;
    void problem(const std::string& key, std::string what, std::string allowed, std::string cure);

  private:
    const toml::node* find(const std::string& key);
    std::string full(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
    std::string place(const toml::source_region& source, const std::string& name) const;
    void wrong_type(const toml::node& node, const std::string& key, std::string wanted);
    std::optional<std::string> any_text(const std::string& key);
    std::optional<double> number_within(const std::string& key, double minimum, double maximum);
    std::optional<std::int64_t> whole_number(const std::string& key, std::int64_t minimum,
                                             std::int64_t maximum);

    template <Spelled Enum>
    void add_word(const std::string& key, const std::string& word, std::vector<Enum>& target) {
        if (const auto value = value_from<Enum>(word)) {
            target.push_back(*value);
        } else {
            problem(key, "\"" + word + "\" is not known", spelling_list<Enum>(), "");
        }
    }

    template <class Field, class Member>
    void member(const Field& field, Member& target) {
        if constexpr (std::is_same_v<Member, std::string>) {
            text_or_empty(field.name, target);
        } else if constexpr (std::is_enum_v<Member>) {
            word<Member>(field.name, target);
        } else if constexpr (std::is_integral_v<Member> || std::is_same_v<Member, std::optional<int>>) {
            integer(field.name, static_cast<std::int64_t>(field.minimum),
                    static_cast<std::int64_t>(field.maximum), target);
        } else {
            const auto value = number_within(field.name, field.minimum, field.maximum);
            if (value) target = *value;
        }
    }

    const toml::table& table_;
    std::string path_;
    TomlReading& reading_;
    std::set<std::string> known_;
};

/// Throws core::InputError with line and column for text that is not TOML.
toml::table parse_toml(const std::string& text, const std::string& file);

/// Puts `value`, as TOML writes it, in the place of what stands at `key`. It stands nowhere in the file:
/// problems with it are "set by a factor".
void set_value(toml::table& table, const std::string& key, const std::string& value);

}  // namespace clearway::core
