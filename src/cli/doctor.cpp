#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "campaign/printout.hpp"
#include "campaign/programs.hpp"
#include "cli/detail/app.hpp"
#include "cli/detail/common_options.hpp"
#include "cli/verb.hpp"
#include "core/build_stamp.hpp"
#include "study/plan.hpp"

namespace clearway::cli {
namespace {

/// The SUMO series that the gateway is written for and tested with.
const std::string supported_sumo = "1.15";

enum class Severity { required, optional };

/// Of what was looked for.
enum class Finding { fit, missing, unfit };

struct Check {
    std::string name;
    Finding finding = Finding::missing;
    Severity severity = Severity::required;
    std::string found;
    std::string cure;

    bool passed() const { return finding == Finding::fit; }
};

Finding fit_if(bool condition, Finding otherwise = Finding::unfit) {
    return condition ? Finding::fit : otherwise;
}

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

Check check_sumo(const std::string& program) {
    Check check{program, Finding::missing, Severity::required, "missing",
                "Install the packages sumo and sumo-tools"};
    const std::string text = first_line(campaign::output_of(program, {"--version"}).value_or(""));
    if (text.empty()) return check;
    check.found = text;
    check.finding = fit_if(text.find(" " + supported_sumo + ".") != std::string::npos);
    check.cure = fmt::format("Clearway is made for SUMO {}.x; install that version", supported_sumo);
    return check;
}

Check check_sumo_home() {
    const char* const home = std::getenv("SUMO_HOME");
    Check check{"SUMO_HOME", Finding::missing, Severity::required, home == nullptr ? "not set" : home,
                "Start through ./clearway, or set SUMO_HOME to the folder that holds tools/ and data/"};
    if (home != nullptr)
        check.finding = fit_if(std::filesystem::is_directory(std::filesystem::path(home) / "tools"));
    return check;
}

/// One of Clearway's own programs. It starts only if all of its libraries are found.
Check check_sister(const std::string& program, const std::string& purpose) {
    Check check{program, Finding::missing, Severity::required, "cannot be started",
                fmt::format("Build it ({}). A missing shared library also causes this", purpose)};
    const std::optional<std::string> text =
        campaign::output_of(campaign::sister_program(program), {"--version"});
    check.finding = fit_if(text.has_value(), Finding::missing);
    if (text) check.found = first_line(*text);
    return check;
}

/// The worker must also be of the same build as this program.
Check check_worker() {
    Check check = check_sister("clearway-run", "the worker that holds SUMO");
    if (!check.passed()) return check;
    const auto worker = campaign::versions_from(
        campaign::output_of(campaign::sister_program("clearway-run"), {"--version"}).value_or(""));
    check.finding = fit_if(worker && campaign::is_of_this_build(*worker));
    if (check.passed()) return check;
    check.found += fmt::format(", of another build than this clearway: {}, not {}",
                               worker ? worker->build : "unknown", core::build_stamp());
    check.cure = campaign::cure_of_another_build;
    return check;
}

/// Needed for training only.
Check check_trainer() {
    Check check = check_sister("clearway-train", "");
    check.severity = Severity::optional;
    check.cure = fmt::format("Not an error: {}", campaign::why_no_trainer);
    return check;
}

Check check_osmium() {
    const std::string text = first_line(campaign::output_of("osmium", {"--version"}).value_or(""));
    return {"osmium", fit_if(!text.empty(), Finding::missing), Severity::optional,
            text.empty() ? "missing" : text, "Install the package osmium-tool to import .osm.pbf files"};
}

Check check_rasteriser() {
    const std::string text = first_line(campaign::output_of("rsvg-convert", {"--version"}).value_or(""));
    return {"rsvg-convert", fit_if(!text.empty(), Finding::missing), Severity::optional,
            text.empty() ? "missing" : text, "Install the package librsvg2-bin to write figures as PNG"};
}

Check check_folder() {
    const std::filesystem::path here = std::filesystem::current_path();
    const bool writable = ::access(here.c_str(), W_OK) == 0;
    std::error_code error;
    const double free_gb = static_cast<double>(std::filesystem::space(here, error).available) / 1e9;
    return {"current folder", fit_if(writable && free_gb > 1.0), Severity::required,
            fmt::format("{}, {:.1f} GB free", writable ? "writable" : "not writable", free_gb),
            "Runs are written below the current folder; choose another with --out"};
}

std::vector<Check> all_checks() {
    return {check_sumo("sumo"),
            check_sumo("netconvert"),
            check_sumo_home(),
            check_worker(),
            check_trainer(),
            check_osmium(),
            check_rasteriser(),
            check_folder(),
            {"processors", Finding::fit, Severity::optional,
             std::to_string(std::thread::hardware_concurrency()), ""}};
}

const char* mark_of(const Check& check) {
    if (check.passed()) return "ok";
    if (check.finding == Finding::unfit) return "UNFIT";
    return check.severity == Severity::required ? "MISSING" : "missing";
}

campaign::Printout printout_of(const std::vector<Check>& checks) {
    campaign::Table table{
        "", {{"", "state"}, {"check", "check"}, {"passed", ""}, {"required", ""}, {"found", "found"}}, {}};
    for (const Check& check : checks) {
        campaign::Row row{
            {mark_of(check), check.name, check.passed(), check.severity == Severity::required, check.found}};
        if (!check.passed()) row.below.push_back(check.cure);
        table.rows.push_back(std::move(row));
    }
    return {.tables = {table}};
}

}  // namespace

Action configure_doctor(App& app) {
    const auto printing = std::make_shared<Printing>(Printing::text);
    add_json_option(app, *printing, "the findings");
    return [printing](const Invocation&) {
        const std::vector<Check> checks = all_checks();
        campaign::print(printout_of(checks), *printing);
        const bool healthy = std::ranges::all_of(checks, [](const Check& check) {
            return check.passed() || check.severity == Severity::optional;
        });
        return healthy ? core::ExitCode::ok : core::ExitCode::environment;
    };
}

}  // namespace clearway::cli
