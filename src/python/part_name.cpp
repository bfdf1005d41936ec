#include "python/part_name.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "python/sources.hpp"

namespace clearway::python {
namespace {

constexpr std::size_t hash_digits = 32;

/// Splits `@` and a hash off the end of a word.
std::string take_hash(std::string_view& word) {
    const std::size_t at = word.rfind('@');
    if (at == std::string_view::npos || word.size() - at - 1 != hash_digits) return {};
    const std::string_view digits = word.substr(at + 1);
    if (digits.find_first_not_of("0123456789abcdef") != std::string_view::npos) return {};
    word = word.substr(0, at);
    return std::string(digits);
}

bool is_torch_script(std::string_view file) {
    return file.ends_with(".pt") || file.ends_with(".pth");
}

}  // namespace

std::optional<PartName> part_name_from(std::string_view word) {
    PartName name;
    name.hash = take_hash(word);
    if (is_torch_script(word)) {
        name.file = word;
        return name;
    }
    const std::size_t colon = word.rfind(':');
    const std::string_view file = word.substr(0, colon);
    if (!file.ends_with(".py")) return std::nullopt;
    name.file = file;
    if (colon != std::string_view::npos) name.object = word.substr(colon + 1);
    return name;
}

std::string to_text(const PartName& name) {
    std::string text = name.file.string();
    if (!name.object.empty()) text += ":" + name.object;
    if (!name.hash.empty()) text += "@" + name.hash;
    return text;
}

std::string resolved(const std::string& word, const std::filesystem::path& folder, const std::string& where) {
    std::optional<PartName> name = part_name_from(word);
    if (!name) return word;
    const bool is_nameless = name->object.empty() && !is_torch_script(name->file.string());
    if (is_nameless || name->object.find('/') != std::string::npos)
        throw core::InputError({where, fmt::format("`{}` does not name a class", word), "FILE.py:CLASS",
                                "Add a colon and the class"});
    if (name->file.is_relative()) name->file = folder / name->file;
    name->file = std::filesystem::absolute(name->file).lexically_normal();
    if (!std::filesystem::is_regular_file(name->file))
        throw core::InputError(
            {where, fmt::format("{} is not a file", name->file.string()), "FILE.py:CLASS or FILE.pt",
             "File names are relative to the current folder, or to that of the study file"});
    const std::vector<std::filesystem::path> files = sources_of(name->file, where);
    const std::string hash = hash_of(files);
    if (!name->hash.empty() && name->hash != hash)
        // No run is to blame: once the file is restored, the same command continues.
        throw core::ConflictError(core::format_problem(
            {where,
             fmt::format("{}{} changed since the study began", name->file.string(),
                         files.size() > 1 ? " or a file that it imports has" : " has"),
             "content hash " + name->hash,
             "Restore it and give the same command again, or start a new study with another --out"}));
    name->hash = hash;
    return to_text(*name);
}

std::string located(const std::string& word, const std::vector<std::filesystem::path>& folders,
                    const std::string& where) {
    std::optional<PartName> name = part_name_from(word);
    if (!name || name->hash.empty()) return word;
    name->file = located_file(name->file, name->hash, folders, where, [&](const std::filesystem::path& file) {
        return hash_of(sources_of(file, where));
    });
    return to_text(*name);
}

std::string short_name(std::string_view word) {
    const std::optional<PartName> name = part_name_from(word);
    if (!name) return std::string(word);
    return name->object.empty() ? name->file.stem().string() : name->object;
}

}  // namespace clearway::python
