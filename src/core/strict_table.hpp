#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <toml++/toml.h>

#include "core/error.hpp"
#include "core/spellings.hpp"

namespace clearway::core {

/// Reads one table of a TOML file and collects its problems. Every key that is asked for counts as known;
/// `finish` reports all others.
class StrictTable {
  public:
    StrictTable(const toml::table& table, std::string path, std::string file,
                std::vector<core::Problem>& problems);

    void text(const std::string& key, std::string& target);
    void texts(const std::string& key, std::vector<std::string>& target);
    void number(const std::string& key, std::optional<double>& target);
    template <class Integer>
    void integer(const std::string& key, Integer minimum, Integer maximum, Integer& target) {
        const auto value = whole_number(key, minimum, maximum);
        if (value) target = static_cast<Integer>(*value);
    }
    /// One of the words of an enumeration; `Target` is `Enum` or `std::optional<Enum>`.
    template <Spelled Enum, class Target>
    void word(const std::string& key, Target& target) {
        std::string found;
        text(key, found);
        if (found.empty()) return;
        if (const auto value = value_from<Enum>(found)) {
            target = *value;
        } else {
            problem(key, "\"" + found + "\" is not known", spelling_list<Enum>(), "");
        }
    }
    /// A list of such words.
    template <Spelled Enum>
    void words(const std::string& key, std::vector<Enum>& target) {
        std::vector<std::string> found;
        texts(key, found);
        for (const std::string& one : found) {
            if (const auto value = value_from<Enum>(one)) {
                target.push_back(*value);
            } else {
                problem(key, "\"" + one + "\" is not known", spelling_list<Enum>(), "");
            }
        }
    }
    /// A subtable, or nullptr.
    const toml::table* table(const std::string& key);
    /// The tables of `[[key]]`.
    std::vector<const toml::table*> tables(const std::string& key);
    void finish();
    bool has(const std::string& key) const { return table_.contains(key); }

    /// `study.toml:3:1: condition.name`; for a missing key the place of the table.
    std::string where(const std::string& key) const;
    void problem(const std::string& key, std::string what, std::string allowed, std::string cure);

  private:
    const toml::node* find(const std::string& key);
    std::optional<std::int64_t> whole_number(const std::string& key, std::uint64_t minimum,
                                             std::uint64_t maximum);

    const toml::table& table_;
    std::string path_;
    std::string file_;
    std::vector<core::Problem>& problems_;
    std::set<std::string> known_;
};

/// Throws core::InputError with line and column for text that is not TOML.
toml::table parse_toml(const std::string& text, const std::string& file);

}  // namespace clearway::core
