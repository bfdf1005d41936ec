#include "report/figure_files.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/files.hpp"
#include "core/leftovers.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/style.hpp"
#include "report/detail/table_files.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report {
namespace {

namespace fs = std::filesystem;
using detail::Figure;
using detail::Table;

/// Names of the figures and tables that an export has written, a line each, without endings.
constexpr const char* list_name = ".clearway-figures";

/// Removes what an earlier export has written. Throws core::InputError for a folder that holds something
/// else.
void remove_former(const fs::path& folder) {
    core::require_own(folder, figure_folder());
    core::remove_abandoned_parts(folder);
    if (!fs::exists(folder / list_name)) return;
    std::istringstream names(core::read_file(folder / list_name));
    for (std::string name; std::getline(names, name);) {
        if (name.find_first_of("/.") != std::string::npos) continue;
        for (const char* const ending : {".svg", ".pdf", ".png", ".csv", ".tex"})
            fs::remove(folder / (name + ending));
    }
    fs::remove(folder / "index.html");
    fs::remove(folder / list_name);
}

class FileWriter : public detail::Writer {
  public:
    FileWriter(const std::filesystem::path& folder, const StudyFacts& study)
        : folder_(folder), study_(study) {}

    void begin(const char* section) { section_ = topic_ = section; }

    void markup(std::string_view /*html*/) override {}
    void heading(const std::string& text) override { topic_ = text; }
    const FigureFiles& files() const { return files_; }

  private:
    fs::path write(const std::string& name, const char* ending, const std::string& text) {
        fs::path file = folder_ / (name + ending);
        if (names_.empty() || names_.back() != name) {
            names_.push_back(name);
            core::write_output(folder_ / list_name, fmt::format("{}\n", fmt::join(names_, "\n")));
        }
        core::write_output(file, text);
        return file;
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
            if (caption == scenario.name) return topic_ + ": " + caption;
            if (name.ends_with("-" + plain_name(scenario.name)) &&
                caption.find(scenario.name) == std::string::npos)
                return scenario.name + ": " + caption;
        }
        return caption;
    }
    void put(const Figure& figure) override {
        const std::string drawing = named(figure.drawing, escaped(study_.reference));
        files_.drawings.push_back(write(figure.name, ".svg", detail::standalone(drawing)));
        if (!figure.data.rows.empty())
            files_.tables.push_back(write(figure.name, ".csv", detail::to_csv(figure.data)));
        files_.entries.push_back({section_, figure.name, label(figure.name),
                                  full(figure.caption, figure.name), named(figure.note, study_.reference),
                                  true, !figure.data.rows.empty()});
    }
    void put(const Table& table) override {
        files_.tables.push_back(write(table.name, ".csv", detail::to_csv(table.data)));
        Table typeset = table;
        typeset.caption = caption(table.caption);
        typeset.name = label(table.name);
        files_.typeset.push_back(write(table.name, ".tex", detail::to_latex(typeset)));
        files_.entries.push_back({section_, table.name, typeset.name, typeset.caption, "", false, true});
    }

    std::filesystem::path folder_;
    const StudyFacts& study_;
    std::string section_;
    std::string topic_;  ///< The latest heading, or the section.
    std::vector<std::string> names_;
    FigureFiles files_;
};

std::string link(const std::string& name, const std::string& ending) {
    return fmt::format(" <a href=\"{0}.{1}\">{1}</a>", name, ending);
}

std::string entry_markup(const FigureEntry& entry, const std::vector<std::string>& more) {
    std::string html = fmt::format("<figure id=\"{}\"><figcaption>{}<span class=\"save\">", entry.name,
                                   escaped(entry.caption));
    if (entry.is_drawing) {
        html += link(entry.name, "svg");
        for (const std::string& ending : more)
            html += link(entry.name, ending);
    }
    if (entry.has_data) html += link(entry.name, "csv");
    if (!entry.is_drawing) html += link(entry.name, "tex");
    html += "</span></figcaption>\n";
    if (entry.is_drawing) {
        const bool has_pdf = std::ranges::find(more, "pdf") != more.end();
        html += fmt::format(
            "<a href=\"{0}.svg\"><img src=\"{0}.svg\" alt=\"{1}\"></a>\n<p class=\"note\">{2}</p>\n"
            "<details><summary>LaTeX</summary><pre>{3}</pre></details>\n",
            entry.name, escaped(entry.caption), escaped(entry.note),
            escaped(fmt::format(
                "\\begin{{figure}}\n\\centering\n\\includegraphics[width=\\linewidth]{{{0}{1}}}\n"
                "\\caption{{{2}}}\n\\label{{fig:{3}}}\n\\end{{figure}}",
                entry.name, has_pdf ? ".pdf" : "", detail::latex_escaped(entry.caption), entry.label)));
    }
    return html + "</figure>\n";
}

}  // namespace

void write_index(const FigureFiles& files, const std::filesystem::path& folder,
                 const std::vector<std::string>& more) {
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<link rel=\"icon\" href=\"data:,\">\n<title>{0}: figures</title>\n<style>{1}\n"
        "img{{display:block;width:100%;background:#fff}}</style>\n</head>\n<body>\n"
        "<header>\n<h1>{0}: figures and tables</h1>\n</header>\n<main>\n",
        escaped(files.title), detail::page_style());
    std::string section;
    for (const FigureEntry& entry : files.entries) {
        if (entry.section != section)
            html += fmt::format("{}<h2>{}</h2>\n<div class=\"figures\">\n", section.empty() ? "" : "</div>\n",
                                entry.section);
        section = entry.section;
        html += entry_markup(entry, more);
    }
    html += section.empty() ? "<p>Nothing to draw.</p>\n" : "</div>\n";
    core::write_output(folder / "index.html", html + "</main>\n</body>\n</html>\n");
}

core::OwnFolder figure_folder() {
    return {"clearway export figures", {list_name}};
}

FigureFiles write_figures(const StudyFacts& study, const std::filesystem::path& folder) {
    remove_former(folder);
    core::make_folder(folder);
    FileWriter writer(folder, study);
    for (const detail::Section& section : detail::sections()) {
        if (!section.applies(study)) continue;
        writer.begin(section.title);
        section.write(study, writer);
    }
    FigureFiles files = writer.files();
    files.title = study.title;
    return files;
}

}  // namespace clearway::report
