#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "campaign/programs.hpp"
#include "cli/detail/app.hpp"
#include "cli/verb.hpp"
#include "core/error.hpp"

namespace clearway::cli {

namespace {

/// What `clearway links train --help` says where the trainer cannot say it.
constexpr const char* help_without_trainer =
    "Train a net of link prediction.\n"
    "Usage: clearway links train NET --data DIR --out DIR [OPTIONS]\n\n"
    "Nets:\n"
    "  graphsage                recommended: the net that repairs links best\n"
    "  gradient_boosting        boosted trees on the same data\n"
    "To compare, and to repeat the dissertation:\n"
    "  logistic, graphsage_corrected, gcn, gat, graphsage_as_published\n\n"
    "The program that trains, clearway-train, is not built yet: only training needs\n"
    "libtorch and XGBoost. `./clearway links train` installs them and builds it.\n"
    "Then `clearway links train NET --help` describes the options of a net.\n\n"
    "Example:\n"
    "  clearway links train graphsage --data data/graphsage --out trained/graphsage\n";

bool asks_for_help(const std::vector<std::string>& words) {
    return std::ranges::any_of(words,
                               [](const std::string& word) { return word == "--help" || word == "-h"; });
}

/// OpenBLAS 0.3.21 has kernels for processors with AVX512-BF16 that multiply matrices of single precision
/// with errors of 1e-4 (RepairNet.agrees_with_libtorch shows them). Those for earlier processors have none.
void multiply_in_single_precision() {
#ifdef __x86_64__
    constexpr int keep = 0;  // what the user has set
    if (__builtin_cpu_supports("avx512bf16")) ::setenv("OPENBLAS_CORETYPE", "SkylakeX", keep);
#endif
}

}  // namespace

/// clearway-train parses its own arguments, so that this program does not need libtorch.
Action configure_train(App& app) {
    app.set_help_flag();  // clearway-train prints its own help
    app.prefix_command();
    return [command = app](const Invocation&) -> core::ExitCode {
        const std::string trainer = campaign::sister_program("clearway-train");
        const bool is_built = std::filesystem::exists(trainer);
        if (!is_built && asks_for_help(command.remaining())) {
            fmt::print("{}", help_without_trainer);
            return core::ExitCode::ok;
        }
        if (!is_built)
            throw core::EnvironmentError(
                fmt::format("clearway-train is not built, because {}", campaign::why_no_trainer));
        multiply_in_single_precision();
        campaign::become(trainer, command.remaining());
    };
}

}  // namespace clearway::cli
