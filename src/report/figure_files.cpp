#include "report/figure_files.hpp"

#include <string>
#include <string_view>

#include "core/files.hpp"
#include "report/detail/figures.hpp"
#include "report/detail/table_files.hpp"
#include "report/sections/sections.hpp"

namespace clearway::report {
namespace {

using detail::Figure;
using detail::Table;

class FileWriter : public detail::Writer {
  public:
    explicit FileWriter(const std::filesystem::path& folder) : folder_(folder) {}

    void markup(std::string_view /*html*/) override {}
    const FigureFiles& files() const { return files_; }

  private:
    std::filesystem::path write(const std::string& name, const char* ending, const std::string& text) {
        std::filesystem::path file = folder_ / (name + ending);
        core::write_atomically(file, text);
        return file;
    }
    void put(const Figure& figure) override {
        files_.drawings.push_back(write(figure.name, ".svg", detail::standalone(figure.drawing)));
        if (!figure.data.rows.empty())
            files_.tables.push_back(write(figure.name, ".csv", detail::to_csv(figure.data)));
    }
    void put(const Table& table) override {
        files_.tables.push_back(write(table.name, ".csv", detail::to_csv(table.data)));
        files_.typeset.push_back(write(table.name, ".tex", detail::to_latex(table.data)));
    }

    std::filesystem::path folder_;
    FigureFiles files_;
};

}  // namespace

FigureFiles write_figures(const StudyFacts& study, const std::filesystem::path& folder) {
    core::make_folder(folder);
    FileWriter writer(folder);
    for (const detail::Section& section : detail::sections()) {
        if (section.applies(study)) section.write(study, writer);
    }
    return writer.files();
}

}  // namespace clearway::report
