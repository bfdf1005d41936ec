// Writes a page of made-up results with names that try to break out of it: report_sample_page FILE FOLDER.
#include <filesystem>
#include <fstream>
#include <iostream>

#include "report/figure_files.hpp"
#include "report/html.hpp"
#include "report/sample.hpp"

int main(int argument_count, char** arguments) {
    using namespace clearway::report;
    if (argument_count != 3) {
        std::cerr << "report_sample_page FILE FOLDER\n";
        return 2;
    }
    StudyFacts study =
        tests::study({"merge", "intersection", "city", "<script>fetch('http://127.0.0.1:9/')</script>"});
    study.scenarios[0].conditions[3].condition.safety_checks = clearway::traffic::SafetyChecks::off;
    study.scenarios[0].conditions[2].failed = {{3, "<img src=http://127.0.0.1:9/x onerror=alert(1)>"}};
    study.scenarios[1].network_svg =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 960 540\" class=\"network\">"
        "<path class=\"bar\" d=\"M30 270H930M480 30V510\" stroke=\"currentColor\"/></svg>";
    std::ofstream page(arguments[1]);
    write_html(study, page);
    page.close();
    std::filesystem::remove_all(arguments[2]);
    write_figures(study, arguments[2], {.only = {}, .words = FigureChoice::Words::bare});  // as the page's
    return page ? 0 : 1;
}
