#include "cli/detail/app.hpp"

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <type_traits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/number_range.hpp"

namespace clearway::cli {
namespace {

std::string without_leading_zeros(std::string word) {
    const std::size_t first = word.find_first_not_of('0');
    if (first == std::string::npos) return word.empty() ? word : "0";
    return word[first] >= '1' && word[first] <= '9' ? word.substr(first) : word;
}

}  // namespace

Option Option::required() const {
    return Option(option_->required());
}

Option Option::option_text(const std::string& text) const {
    return Option(option_->option_text(text));
}

Option Option::description(const std::string& text) const {
    return Option(option_->description(text));
}

Option Option::expected(int count) const {
    return Option(option_->expected(count));
}

Option Option::expected(int least, int most) const {
    return Option(option_->expected(least, most));
}

Option Option::allow_extra_args(bool value) const {
    return Option(option_->allow_extra_args(value));
}

Option Option::check(const std::function<std::string(const std::string&)>& problem) const {
    return Option(option_->check(problem));
}

template <class Number>
Option Option::range(Number least, Number most) const {
    return check([least, most](const std::string& word) {
        const char* const end = word.data() + word.size();
        Number number{};
        const std::from_chars_result read = std::from_chars(word.data(), end, number);
        const bool is_whole = read.ec == std::errc() && read.ptr == end;
        // The words of CLI11, which takes the greatest number for one that is greater (core/usage.cpp).
        return is_whole && least <= number && number <= most
                   ? std::string()
                   : fmt::format("Value {} not in range {} to {}", word, least, most);
    });
}

Option Option::range(double least, double most) const {
    return check(core::NumberRange{least, most});
}

Option Option::one_of(const std::vector<std::string>& words) const {
    return Option(option_->check(CLI::IsMember(words)));
}

Option Option::one_of(std::initializer_list<int> numbers) const {
    return Option(option_->check(CLI::IsMember(numbers)));
}

Option Option::needs(const Option& other) const {
    return Option(option_->needs(other.option_));
}

Option Option::excludes(const Option& other) const {
    return Option(option_->excludes(other.option_));
}

Option Option::excludes(const std::string& name) const {
    return Option(option_->excludes(name));
}

std::size_t Option::count() const {
    return option_->count();
}

template <class Value>
Option App::add_option(const std::string& name, Value& value, const std::string& help) {
    CLI::Option* const option = app_->add_option(name, value, help);
    // CLI11 reads 010 as 8.
    if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>)
        option->transform(without_leading_zeros);
    return Option(option);
}

template <class Value>
Option App::add_option_function(const std::string& name, const std::function<void(const Value&)>& set,
                                const std::string& help) {
    return Option(app_->add_option_function<Value>(name, set, help));
}

Option App::add_flag(const std::string& name, bool& value, const std::string& help) {
    return Option(app_->add_flag(name, value, help));
}

Option App::add_flag_callback(const std::string& name, const std::function<void()>& set,
                              const std::string& help) {
    return Option(app_->add_flag_callback(name, set, help));
}

std::vector<Option> App::get_options() const {
    std::vector<Option> options;
    for (CLI::Option* const option : app_->get_options())
        options.emplace_back(option);
    return options;
}

std::string App::set_group(const std::string& name) {
    const std::string before = app_->option_defaults()->get_group();
    app_->option_defaults()->group(name);
    return before;
}

void App::set_everyday(const std::vector<std::string>& names) {
    const std::string everyday = "Everyday options (names: clearway list)";
    const std::string usual = app_->get_help_ptr()->get_group();
    for (CLI::Option* const option : app_->get_options())
        if (option->get_group() == usual) option->group("Further options");
    app_->get_help_ptr()->group(everyday);
    for (const std::string& name : names)
        app_->get_option(name)->group(everyday);
}

void App::footer(const std::string& text) {
    app_->footer(text);
}

std::string App::get_footer() const {
    return app_->get_footer();
}

void App::set_help_flag() {
    app_->set_help_flag();
}

void App::prefix_command() {
    app_->prefix_command();
}

std::vector<std::string> App::remaining() const {
    return app_->remaining();
}

using Text = const std::string&;
using Texts = std::vector<std::string>;

template Option Option::range(std::uint32_t, std::uint32_t) const;
template Option Option::range(std::uint64_t, std::uint64_t) const;
template Option Option::range(std::int64_t, std::int64_t) const;
template Option App::add_option(Text, bool&, Text);
template Option App::add_option(Text, int&, Text);
template Option App::add_option(Text, long&, Text);
template Option App::add_option(Text, double&, Text);
template Option App::add_option(Text, std::uint16_t&, Text);
template Option App::add_option(Text, std::uint32_t&, Text);
template Option App::add_option(Text, std::uint64_t&, Text);
template Option App::add_option(Text, std::string&, Text);
template Option App::add_option(Text, std::filesystem::path&, Text);
template Option App::add_option(Text, Texts&, Text);
template Option App::add_option(Text, std::vector<int>&, Text);
template Option App::add_option(Text, std::optional<double>&, Text);
template Option App::add_option(Text, std::optional<std::string>&, Text);
template Option App::add_option(Text, std::optional<Texts>&, Text);
template Option App::add_option_function(Text, const std::function<void(Text)>&, Text);
template Option App::add_option_function(Text, const std::function<void(const Texts&)>&, Text);

}  // namespace clearway::cli
