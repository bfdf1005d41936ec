#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "campaign/stored_folder.hpp"
#include "cli/detail/app.hpp"
#include "cli/verb.hpp"
#include "core/error.hpp"
#include "results/table_reader.hpp"
#include "results/table_writer.hpp"

namespace clearway::cli {
namespace {

enum class Asked : std::uint8_t { table, names };

struct ResultsArguments {
    std::string folder;
    std::string table = "runs";
    Asked asked = Asked::table;
    results::TableFormat format = results::TableFormat::csv;
};

/// Folders of others and archives may be read-only. Then what there is is printed, with a warning.
void update_tables(const results::Store& store) {
    if (results::tables_are_current(store)) return;
    try {
        results::write_tables(store);
    } catch (const core::EnvironmentError& error) {
        const std::filesystem::path database = store.folder() / "results.sqlite";
        if (!std::filesystem::exists(database)) throw;
        fmt::print(stderr,
                   "clearway: warning: {}. Rows are those of {} as it is; it may not be of all runs\n",
                   error.what(), database.string());
    }
}

core::ExitCode print_results(const ResultsArguments& arguments) {
    const results::Store store = results::Store::open(arguments.folder);
    campaign::renew_edited_tables(store);
    update_tables(store);
    if (arguments.asked == Asked::names) {
        for (const std::string& name : results::table_names(store))
            fmt::print("{}\n", name);
        return core::ExitCode::ok;
    }
    results::print_table(store, arguments.table, arguments.format, std::cout);
    if (!std::cout.flush())
        throw core::EnvironmentError(
            "standard output cannot be written. Check where it goes and give the same command again");
    return core::ExitCode::ok;
}

}  // namespace

Action configure_results(App& app) {
    const auto arguments = std::make_shared<ResultsArguments>();
    app.add_option("folder", arguments->folder, "Run folder, complete or not")
        .required()
        .option_text("DIR (required)");
    app.add_option("table,--table", arguments->table, "Table to print; --list names them")
        .option_text(fmt::format("TABLE [{}]", arguments->table));
    const Option csv = app.add_flag_callback(
        "--csv", [arguments] { arguments->format = results::TableFormat::csv; },
        "Print comma-separated values, column names first [on]");
    const Option json = app.add_flag_callback(
        "--json", [arguments] { arguments->format = results::TableFormat::json; },
        "Print a JSON array with an object for each row [off]");
    csv.excludes(json);
    app.add_flag_callback(
           "--list", [arguments] { arguments->asked = Asked::names; }, "Print the names of the tables [off]")
        .excludes(csv)
        .excludes(json);
    return [arguments](const Invocation&) { return print_results(*arguments); };
}

}  // namespace clearway::cli
