#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "core/spellings.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): its own name
class App;
class Option;
}  // namespace CLI

namespace clearway::cli {

// What the verbs need of CLI11, under its names. A file that includes CLI11 compiles for seconds longer, so
// the verbs include this header.

/// A handle of an option that was added to an App.
class Option {
  public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option required() const;
    /// Stands behind the name in the help.
    Option option_text(const std::string& text) const;
    Option description(const std::string& text) const;
    /// How many values follow it.
    Option expected(int count) const;
    Option expected(int least, int most) const;
    /// Whether more than one value may follow it each time that it is given.
    Option allow_extra_args(bool value) const;
    /// `problem` returns what is wrong with a value; an empty text for nothing.
    Option check(const std::function<std::string(const std::string&)>& problem) const;
    /// Only whole numbers from `least` to `most`. `Number`: those that app.cpp instantiates.
    template <class Number>
    Option range(Number least, Number most) const;
    /// Only numbers from `least` to `most`.
    Option range(double least, double most) const;
    Option one_of(const std::vector<std::string>& words) const;
    Option one_of(std::initializer_list<int> numbers) const;
    Option needs(const Option& other) const;
    Option excludes(const Option& other) const;
    Option excludes(const std::string& name) const;

    /// How many values were given.
    std::size_t count() const;

  private:
    CLI::Option* option_;
};

/// A handle of the options of a verb.
class App {
  public:
    explicit App(CLI::App& app) : app_(&app) {}

    /// An option that sets `value`, which must outlive the parsing. A name without dashes is an argument.
    /// `Value`: those that app.cpp instantiates.
    template <class Value>
    Option add_option(const std::string& name, Value& value, const std::string& help);
    /// `Value`: std::string or a vector of it.
    template <class Value>
    Option add_option_function(const std::string& name, const std::function<void(const Value&)>& set,
                               const std::string& help);
    /// An option that sets `value` to what one of `words` means.
    template <class Value>
    Option add_choice(const std::string& name, Value& value, const std::map<std::string, Value>& words,
                      const std::string& help) {
        std::vector<std::string> names;
        for (const auto& entry : words)
            names.push_back(entry.first);
        const auto set = [&value, words](const std::string& word) { value = words.at(word); };
        return add_option_function<std::string>(name, set, help).one_of(names);
    }
    /// The same with all words of an enumeration.
    template <core::Spelled Value>
    Option add_choice(const std::string& name, Value& value, const std::string& help) {
        std::map<std::string, Value> words;
        for (const auto& [meant, word] : spellings(Value{}))
            words.emplace(word, meant);
        return add_choice(name, value, words, help);
    }
    Option add_flag(const std::string& name, bool& value, const std::string& help);
    Option add_flag_callback(const std::string& name, const std::function<void()>& set,
                             const std::string& help);
    std::vector<Option> get_options() const;

    /// Options that are added later stand in this group of the help. Returns the group before.
    std::string set_group(const std::string& name);
    /// These options and --help become the first group of the help, apart from all others. Call it last.
    void set_everyday(const std::vector<std::string>& names);
    void footer(const std::string& text);
    std::string get_footer() const;

    /// Takes `--help` away.
    void set_help_flag();
    /// Everything behind the verb is left in remaining().
    void prefix_command();
    std::vector<std::string> remaining() const;

  private:
    CLI::App* app_;
};

/// While it lives, options that are added stand in this group of the help.
class OptionGroup {
  public:
    OptionGroup(App& app, const std::string& name) : app_(app), before_(app_.set_group(name)) {}
    ~OptionGroup() { app_.set_group(before_); }
    OptionGroup(const OptionGroup&) = delete;
    OptionGroup& operator=(const OptionGroup&) = delete;

  private:
    App& app_;
    std::string before_;
};

}  // namespace clearway::cli
