#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/spellings.hpp"

namespace clearway::scenario::detail {

/// What reading a file collects: problems, and where each key was.
struct Reading {
    std::string file;
    std::vector<core::Problem> problems;
    std::map<std::string, std::string> origins;

    std::string place(const toml::source_region& source, const std::string& key) const {
        if (source.begin.line == 0) return fmt::format("{}: {}, set by a factor", file, key);
        return fmt::format("{}:{}:{}: {}", file, source.begin.line, source.begin.column, key);
    }
    void add(const std::string& where, std::string what, std::string allowed, std::string cure = "") {
        problems.push_back({where, std::move(what), std::move(allowed), std::move(cure)});
    }
};

/// `12`, `0.5`; no exponent for the magnitudes used here.
std::string number_text(double value);

/// One table of a strict TOML file. Every key that is asked for counts as valid; `finish` reports the others.
class TableReader {
  public:
    TableReader(const toml::table& table, std::string path, Reading& reading)
        : table_(table), path_(std::move(path)), reading_(reading) {}

    /// Reads every member of the struct's field table that the file sets.
    template <class Struct>
    void read(Struct& target) {
        core::for_each_field<Struct>([&](const auto& field) { value(field, target.*field.member); });
    }
    /// A subtable, or nullptr when the file has none.
    const toml::table* table(const std::string& key);
    /// The tables of `[[key]]`; empty when the file has none.
    std::vector<const toml::table*> tables(const std::string& key);
    void text(const std::string& key, std::string& target);
    void texts(const std::string& key, std::vector<std::string>& target);
    /// Reports every key that was never asked for, with the nearest valid one.
    void finish();
    std::string full(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

  private:
    const toml::node* find(const std::string& key);
    void wrong_type(const toml::node& node, const std::string& key, const char* wanted);
    void number(const toml::node& node, const std::string& key, double minimum, double maximum,
                double& target);
    void number(const toml::node& node, const std::string& key, double minimum, double maximum, int& target);

    template <class Field, class Member>
    void value(const Field& field, Member& target) {
        if constexpr (std::is_same_v<Member, std::string>) {
            text(field.name, target);
        } else {
            const toml::node* node = find(field.name);
            if (node == nullptr) return;
            if constexpr (std::is_enum_v<Member>) {
                enumerator(*node, field.name, target);
            } else if constexpr (std::is_same_v<Member, std::optional<double>>) {
                number(*node, field.name, field.minimum, field.maximum, target.emplace(field.minimum));
            } else {
                number(*node, field.name, field.minimum, field.maximum, target);
            }
        }
    }

    template <class Enum>
    void enumerator(const toml::node& node, const std::string& key, Enum& target) {
        const auto word = node.value_exact<std::string>();
        if (!word) return wrong_type(node, key, "text");
        if (const auto value = core::value_from<Enum>(*word)) {
            target = *value;
        } else {
            reading_.add(reading_.origins.at(full(key)), fmt::format("\"{}\" is not known", *word),
                         core::spelling_list<Enum>());
        }
    }

    const toml::table& table_;
    std::string path_;
    Reading& reading_;
    std::set<std::string> known_;
};

}  // namespace clearway::scenario::detail
