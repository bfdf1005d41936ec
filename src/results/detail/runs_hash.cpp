#include "results/detail/runs_hash.hpp"

#include <fmt/format.h>

#include "core/files.hpp"

namespace clearway::results::detail {

std::string runs_hash(const Store& store) {
    std::string text;
    store.manifest().for_each_run([&](const experiment::RunKey& key) {
        text += experiment::to_text(key);
        if (store.complete(key)) {
            text += " ok " + core::content_hash(core::read_file(store.run_folder(key) / "run.json"));
        } else if (const auto error = store.read_error(key)) {
            text += fmt::format(" {} {}", name(error->cause), error->message);
        }
        text += '\n';
    });
    return core::content_hash(text);
}

}  // namespace clearway::results::detail
