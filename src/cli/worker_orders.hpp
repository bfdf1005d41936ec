#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace clearway::cli {

/// Work for one process: `clearway-run OPTION FILE`.
struct WorkerOrder {
    std::string label;  ///< `merge replication 3`, for messages.
    std::string option;
    std::filesystem::path file;  ///< Written with `text` before the worker starts.
    std::string text;
    std::filesystem::path log;   ///< Both streams of the worker.
    std::filesystem::path work;  ///< Removed when the worker fails or is ended.
};

/// How the work ended.
struct WorkerResult {
    core::ExitCode exit_code = core::ExitCode::ok;
    std::vector<std::string> lines;  ///< Logs of the workers that did not fail, in the order of the orders.
};

/// Works on orders with `jobs` processes at one time (0: one per core), with progress on standard error. A
/// worker that fails is reported there and the others go on; the first failure decides the exit code. SIGINT
/// and SIGTERM end the workers. `title` names what is counted. Throws core::EnvironmentError when no worker
/// can be started.
WorkerResult work_on(const std::vector<WorkerOrder>& orders, unsigned jobs, const std::string& title);

}  // namespace clearway::cli
