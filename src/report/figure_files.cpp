#include "report/figure_files.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/style.hpp"
#include "report/detail/table_files.hpp"
#include "report/sections/sections.hpp"
#include "report/text.hpp"

namespace clearway::report {
namespace {

namespace fs = std::filesystem;
using detail::Figure;
using detail::Table;

/// Names of the figures and tables that an export has written, a line each, without endings; behind a tab of
/// how many seeds they are.
constexpr const char* list_name = ".clearway-figures";

constexpr std::array drawing_endings = {".svg", ".pdf", ".png"};

/// What an export has written, and of how many seeds: `10 seeds`; empty where an older one did not note it.
struct Written {
    std::string name, seeds;
};

/// What earlier exports have written. Throws core::InputError for a folder that holds something else.
std::vector<Written> former_files(const fs::path& folder) {
    core::require_own(folder, figure_folder());
    core::remove_abandoned_parts(folder);
    std::vector<Written> found;
    if (!fs::exists(folder / list_name)) return found;
    std::istringstream lines(core::read_file(folder / list_name));
    for (std::string line; std::getline(lines, line);) {
        const std::size_t tab = std::min(line.find('\t'), line.size());
        Written former{line.substr(0, tab), line.substr(std::min(tab + 1, line.size()))};
        if (former.name.find_first_of("/.") == std::string::npos) found.push_back(std::move(former));
    }
    return found;
}

void remove_files(const fs::path& folder, const std::string& name) {
    for (const char* const ending : {".csv", ".tex"})
        fs::remove(folder / (name + ending));
    for (const char* const ending : drawing_endings)
        fs::remove(folder / (name + ending));
}

/// Whether `only` names a figure or table, by its whole name or what it begins with.
bool is_meant(const std::string& only, const std::string& name) {
    return name == only || name.starts_with(only + "-");
}

/// Collects the names of all figures and tables.
class NameWriter : public detail::Writer {
  public:
    void markup(std::string_view /*html*/) override {}
    const std::vector<std::string>& names() const { return names_; }

  private:
    void put(const Figure& figure) override { names_.push_back(figure.name); }
    void put(const Table& table) override { names_.push_back(table.name); }

    std::vector<std::string> names_;
};

template <class Begin>
void write_sections(const StudyFacts& study, detail::Writer& writer, const Begin& begin) {
    for (const detail::Section& section : detail::sections()) {
        if (!section.applies(study)) continue;
        begin(section.title);
        section.write(study, writer);
    }
}

/// What names begin with that end in the name of a scenario, so that few words list them all.
std::vector<std::string> stems_of(const std::vector<std::string>& names) {
    std::vector<std::string> stems;
    for (const std::string& name : names) {
        const std::string stem = name.substr(0, name.find('-'));
        if (!core::contains(stems, stem)) stems.push_back(stem);
    }
    return stems;
}

/// Throws core::InputError for names that nothing has.
void check_only(const StudyFacts& study, const std::vector<std::string>& only) {
    if (only.empty()) return;
    NameWriter writer;
    write_sections(study, writer, [](const char* /*section*/) {});
    std::vector<core::Problem> problems;
    for (const std::string& word : only) {
        const bool is_there = std::ranges::any_of(
            writer.names(), [&](const std::string& name) { return is_meant(word, name); });
        if (is_there) continue;
        std::vector<std::string> known = stems_of(writer.names());
        const std::string all = core::listed(known);
        known.insert(known.end(), writer.names().begin(), writer.names().end());
        problems.push_back({"--only", fmt::format("`{}` names no figure and no table", word),
                            all + ", or a whole name of index.html", core::did_you_mean(word, known)});
    }
    if (!problems.empty()) throw core::InputError(std::move(problems));
}

class FileWriter : public detail::Writer {
  public:
    FileWriter(const std::filesystem::path& folder, const StudyFacts& study, const FigureChoice& choice)
        : folder_(folder), study_(study), choice_(choice), former_(former_files(folder)) {
        core::make_folder(folder_);
        if (choice_.only.empty()) fs::remove(folder_ / "index.html");
    }

    void begin(const char* section) { section_ = topic_ = section; }

    void markup(std::string_view /*html*/) override {}
    void heading(const std::string& text) override { topic_ = text; }
    /// Removes what the earlier export has written and this one would have replaced.
    FigureFiles finish() {
        std::erase_if(former_, [&](const Written& former) {
            const bool is_gone = is_chosen(former.name) && !is_written(former.name);
            if (is_gone) remove_files(folder_, former.name);
            return is_gone;
        });
        write_list();
        files_.title = study_.title;
        files_.keeps_others = !choice_.only.empty();
        for (const Written& former : former_)
            if (!is_written(former.name) && former.seeds != sample_of(former.name))
                files_.of_other_seeds[former.seeds].push_back(former.name);
        return std::move(files_);
    }

  private:
    /// Of this and of the earlier export: until it ends, each has files there.
    void write_list() const {
        std::string lines;
        for (const Written& former : former_)
            lines += fmt::format("{}\t{}\n", former.name,
                                 is_written(former.name) ? sample_of(former.name) : former.seeds);
        for (const std::string& name : names_)
            if (!core::contains(former_, name, &Written::name))
                lines += fmt::format("{}\t{}\n", name, sample_of(name));
        core::write_output(folder_ / list_name, lines);
    }
    bool is_written(const std::string& name) const { return core::contains(names_, name); }
    fs::path write(const std::string& name, const char* ending, const std::string& text) {
        fs::path file = folder_ / (name + ending);
        if (names_.empty() || names_.back() != name) {
            names_.push_back(name);
            write_list();
        }
        core::write_output(file, text);
        return file;
    }
    /// Pictures of an earlier export stay where they are of the same drawing.
    fs::path write_drawing(const std::string& name, const std::string& drawing) {
        const fs::path file = folder_ / (name + ".svg");
        if (!fs::exists(file) || core::read_file(file) != drawing) remove_files(folder_, name);
        return write(name, ".svg", drawing);
    }
    /// With the name of what conditions are compared with in place of `the baseline`.
    std::string named(std::string text, const std::string& reference) const {
        constexpr std::string_view usual = "the baseline";
        if (study_.reference.empty()) return text;
        for (std::size_t at = text.find(usual); at != std::string::npos;
             at = text.find(usual, at + reference.size()))
            text.replace(at, usual.size(), reference);
        return text;
    }
    /// For axes, where a long name would run out of the drawing; captions have it in full.
    std::string short_reference() const {
        constexpr std::string_view same = "its counterpart with ";
        constexpr std::size_t longest = 24;
        std::string words = study_.reference;
        if (words.starts_with(same)) words.erase(0, same.size());
        return words.size() > longest ? "its opponent" : words;
    }
    /// Two exports of a study may stand in one paper.
    std::string label(const std::string& name) const {
        return study_.reference.empty() ? name : name + "-against-" + plain_name(study_.reference);
    }
    std::string caption(const std::string& text) const {
        const std::string words = named(text, study_.reference);
        return study_.reference.empty() || words != text
                   ? words
                   : fmt::format("{} (against {})", text, study_.reference);
    }
    /// A caption that can stand alone, with what is drawn, of which scenario and compared with what.
    std::string full(const std::string& text, const std::string& name) const {
        return caption(with_scenario(text, name));
    }
    std::string with_scenario(const std::string& caption, const std::string& name) const {
        for (const ScenarioFacts& scenario : study_.scenarios) {
            if (caption == scenario.name || caption.starts_with(scenario.name + " ("))
                return topic_ + (topic_.ends_with('?') ? " " : ": ") + caption;
            if (name.ends_with("-" + plain_name(scenario.name)) && !caption.starts_with(scenario.name))
                return scenario.name + ": " + caption;
        }
        return caption;
    }
    bool is_chosen(const std::string& name) const {
        return choice_.only.empty() ||
               std::ranges::any_of(choice_.only, [&](const auto& only) { return is_meant(only, name); });
    }
    /// `8 seeds`, of what a figure shows, by its name; `5, 8 seeds` where not all of it has as many.
    std::string sample_of(const std::string& name) const {
        std::set<std::uint64_t> seeds;
        for (const ScenarioFacts& scenario : study_.scenarios) {
            if (name.find("-" + plain_name(scenario.name)) != std::string::npos)
                return counted(scenario.replications, "seed");
            seeds.insert(scenario.replications);
        }
        return seeds.size() == 1 ? counted(*seeds.begin(), "seed")
                                 : fmt::format("{} seeds", fmt::join(seeds, ", "));
    }
    std::string title_of(const Figure& figure) const {
        return full(figure.caption, figure.name) + "; " + sample_of(figure.name);
    }
    std::string drawing_of(const Figure& figure) const {
        const std::string drawing = named(figure.drawing, escaped(short_reference()));
        if (choice_.words == FigureChoice::Words::bare) return detail::standalone(drawing);
        return detail::standalone(drawing, title_of(figure), named(figure.note, study_.reference));
    }
    void put(const Figure& figure) override {
        if (!is_chosen(figure.name)) return;
        files_.drawings.push_back(write_drawing(figure.name, drawing_of(figure)));
        if (!figure.data.rows.empty())
            files_.tables.push_back(write(figure.name, ".csv", detail::to_csv(figure.data)));
        files_.entries.push_back({section_, figure.name, label(figure.name), title_of(figure),
                                  named(figure.note, study_.reference), true, !figure.data.rows.empty()});
    }
    void put(const Table& table) override {
        if (!is_chosen(table.name)) return;
        Table typeset = table;
        bool has_reference = false;
        for (std::string& head : typeset.whole.head)
            head = named(head, short_reference());
        for (std::string& head : typeset.data.head) {
            head = named(head, short_reference());
            has_reference = has_reference || head.find(short_reference()) != std::string::npos ||
                            head.find("difference") != std::string::npos;
        }
        files_.tables.push_back(write(table.name, ".csv", detail::to_csv(typeset.csv())));
        // A plan compares what it names.
        typeset.caption = has_reference && table.name != "plan" ? caption(table.caption)
                                                                : named(table.caption, study_.reference);
        typeset.name = label(table.name);
        files_.typeset.push_back(write(table.name, ".tex", detail::to_latex(typeset)));
        files_.entries.push_back({section_, table.name, typeset.name,
                                  typeset.caption + "; " + sample_of(table.name), "", false, true,
                                  detail::to_html(typeset.data)});
    }

    std::filesystem::path folder_;
    const StudyFacts& study_;
    const FigureChoice& choice_;
    std::vector<Written> former_;
    std::string section_;
    std::string topic_;  ///< The latest heading, or the section.
    std::vector<std::string> names_;
    FigureFiles files_;
};

std::string link(const std::string& name, const std::string& ending) {
    return fmt::format(" <a href=\"{0}.{1}\">{1}</a>", name, ending);
}

/// `folder` is the name by which LaTeX finds the files from beside it.
std::string entry_markup(const FigureEntry& entry, const fs::path& files, const std::string& folder) {
    std::string html = fmt::format("<figure id=\"{}\"><figcaption>{}<span class=\"save\">", entry.name,
                                   escaped(entry.caption));
    const auto has = [&](const char* ending) { return fs::exists(files / (entry.name + ending)); };
    for (const char* const ending : drawing_endings)
        if (entry.is_drawing && has(ending)) html += link(entry.name, ending + 1);
    if (entry.has_data) html += link(entry.name, "csv");
    if (!entry.is_drawing) html += link(entry.name, "tex");
    html += "</span></figcaption>\n";
    if (entry.is_drawing) {
        html += fmt::format(
            "<a href=\"{0}.svg\"><img src=\"{0}.svg\" alt=\"{1}\"></a>\n<p class=\"note\">{2}</p>\n"
            "<details><summary>LaTeX</summary><pre>{3}</pre></details>\n",
            entry.name, escaped(entry.caption), escaped(entry.note),
            escaped(fmt::format(
                "\\begin{{figure}}\n\\centering\n\\includegraphics[width=\\linewidth,"
                "height=.8\\textheight,keepaspectratio]{{{4}/{0}{1}}}\n"
                "\\caption{{{2}}}\n\\label{{fig:{3}}}\n\\end{{figure}}",
                entry.name, has(".pdf") ? ".pdf" : "",
                detail::latex_escaped(entry.caption + "." + (entry.note.empty() ? "" : " " + entry.note)),
                entry.label, folder)));
    }
    if (!entry.markup.empty()) html += "<details><summary>Table</summary>" + entry.markup + "</details>\n";
    return html + "</figure>\n";
}

/// An entry of `index.html`.
struct Block {
    std::string section, name, markup;
};

/// Those of a page that `write_index` wrote.
std::vector<Block> blocks_in(const std::string& page) {
    constexpr std::string_view section_begin = "<h2>";
    constexpr std::string_view begin = "<figure id=\"";
    constexpr std::string_view end = "</figure>\n";
    std::vector<Block> blocks;
    std::string section;
    for (std::size_t at = page.find(section_begin); at < page.size();) {
        if (page.compare(at, section_begin.size(), section_begin) == 0) {
            at += section_begin.size();
            section = page.substr(at, page.find("</h2>", at) - at);
        } else {
            const std::size_t name = at + begin.size();
            const std::size_t after = page.find(end, at);
            blocks.push_back({section, page.substr(name, page.find('"', name) - name),
                              page.substr(at, after - at + end.size())});
            at = name;
        }
        at = std::min(page.find(section_begin, at), page.find(begin, at));
    }
    return blocks;
}

/// In place of the one of this name, else behind the last one of its section.
void put(const Block& block, std::vector<Block>& blocks) {
    const auto former = std::ranges::find(blocks, block.name, &Block::name);
    if (former != blocks.end()) {
        *former = block;
        return;
    }
    const auto last = std::find_if(blocks.rbegin(), blocks.rend(),
                                   [&](const Block& one) { return one.section == block.section; });
    blocks.insert(last == blocks.rend() ? blocks.end() : last.base(), block);
}

}  // namespace

void write_index(const FigureFiles& files, const std::filesystem::path& folder) {
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<link rel=\"icon\" href=\"data:,\">\n<title>{0}: figures</title>\n<style>{1}\n"
        "img{{display:block;width:100%;background:#fff}}</style>\n</head>\n<body>\n"
        "<header>\n<h1>{0}: figures and tables</h1>\n</header>\n<main>\n",
        escaped(files.title), detail::page_style());
    const std::string name = std::filesystem::canonical(folder).filename().string();
    std::vector<Block> blocks;
    if (files.keeps_others && fs::exists(folder / "index.html"))
        blocks = blocks_in(core::read_file(folder / "index.html"));
    for (const FigureEntry& entry : files.entries)
        put({entry.section, entry.name, entry_markup(entry, folder, name)}, blocks);
    std::erase_if(blocks, [&](const Block& block) {
        return !fs::exists(folder / (block.name + ".svg")) && !fs::exists(folder / (block.name + ".csv"));
    });
    std::string section;
    for (const Block& block : blocks) {
        if (block.section != section)
            html += fmt::format("{}<h2>{}</h2>\n<div class=\"figures\">\n", section.empty() ? "" : "</div>\n",
                                block.section);
        section = block.section;
        html += block.markup;
    }
    html += section.empty() ? "<p>Nothing to draw.</p>\n" : "</div>\n";
    core::write_output(folder / "index.html", html + "</main>\n</body>\n</html>\n");
}

core::OwnFolder figure_folder() {
    return {"clearway export figures", {list_name}};
}

FigureFiles write_figures(const StudyFacts& study, const std::filesystem::path& folder,
                          const FigureChoice& choice) {
    check_only(study, choice.only);
    StudyFacts shown = study;
    shown.headline_leads = choice.words != FigureChoice::Words::bare;
    FileWriter writer(folder, shown, choice);
    write_sections(shown, writer, [&](const char* section) { writer.begin(section); });
    return writer.finish();
}

}  // namespace clearway::report
