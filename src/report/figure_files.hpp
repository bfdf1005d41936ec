#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/own_output.hpp"
#include "report/facts.hpp"

namespace clearway::report {

/// A figure or a table among the files.
struct FigureEntry {
    std::string section;  ///< Title of the section that it is from.
    std::string name;     ///< Of its files, without ending.
    std::string label;    ///< In LaTeX; another one where conditions are not compared with their baselines.
    std::string caption, note;
    bool is_drawing = false;
    bool has_data = false;    ///< Whether there is a CSV file.
    std::string markup = {};  ///< HTML of a table.
};

/// What `write_figures` wrote.
struct FigureFiles {
    std::string title;                            ///< Of the study.
    std::vector<std::filesystem::path> drawings;  ///< SVG.
    std::vector<std::filesystem::path> tables;    ///< CSV, of figures and of tables.
    std::vector<std::filesystem::path> typeset;   ///< LaTeX, of tables.
    std::vector<FigureEntry> entries;             ///< In the order of the report.
    bool keeps_others = false;                    ///< Whether the folder has others of an earlier call, too.
    /// Names of those that are of another number of seeds than this call's would be, by that number: `5
    /// seeds`, empty where it is not known.
    std::map<std::string, std::vector<std::string>> of_other_seeds;
};

/// By what `clearway export figures` knows the folders that it has written.
core::OwnFolder figure_folder();

/// Which figures and tables are written, and how.
struct FigureChoice {
    /// Names, or their beginnings up to a hyphen: `tradeoff` for `tradeoff-city`; none: all.
    std::vector<std::string> only = {};
    /// Whether a drawing has its title, seeds and note in it, and lets the condition of the headline stand
    /// out.
    enum class Words { framed, bare } words = Words::framed;
};

/// Writes every figure of the report as NAME.svg, on white paper, and its data as NAME.csv; every table as
/// NAME.csv and NAME.tex. Names are those of the page's downloads. Makes the folder, and removes what an
/// earlier call has written there and this one replaces: of other names than the chosen ones nothing, and
/// pictures made of a drawing only if it changed. Throws core::InputError for a folder with other content,
/// and for a name of `choice` that nothing has; core::EnvironmentError when it cannot be written.
FigureFiles write_figures(const StudyFacts& study, const std::filesystem::path& folder,
                          const FigureChoice& choice = {});

/// Writes `index.html` into the folder of the files: every figure and table with its caption and its files,
/// those of earlier calls that it keeps as their `index.html` had them, and the LaTeX that includes a figure.
void write_index(const FigureFiles& files, const std::filesystem::path& folder);

}  // namespace clearway::report
