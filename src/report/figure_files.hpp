#pragma once

#include <filesystem>
#include <vector>

#include "report/facts.hpp"

namespace clearway::report {

/// What `write_figures` wrote.
struct FigureFiles {
    std::vector<std::filesystem::path> drawings;  ///< SVG.
    std::vector<std::filesystem::path> tables;    ///< CSV, of figures and of tables.
    std::vector<std::filesystem::path> typeset;   ///< LaTeX, of tables.
};

/// Writes every figure of the report as NAME.svg, on white paper, and its data as NAME.csv; every table as
/// NAME.csv and NAME.tex. Names are those of the page's downloads. Makes the folder. Throws
/// core::EnvironmentError when it cannot be written.
FigureFiles write_figures(const StudyFacts& study, const std::filesystem::path& folder);

}  // namespace clearway::report
