#include "core/near_file.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

#include "core/error.hpp"

namespace clearway::core {

std::string did_you_mean_file(const std::filesystem::path& file, const std::string& otherwise) {
    namespace fs = std::filesystem;
    if (file.empty()) return otherwise;
    const fs::path folder = file.parent_path();
    std::vector<std::string> names;
    std::error_code none;
    for (auto entry = fs::directory_iterator(folder.empty() ? "." : folder, none);
         !none && entry != fs::directory_iterator(); entry.increment(none)) {
        const fs::path name = entry->path().filename();
        if (name.extension() == file.extension()) names.push_back((folder / name).string());
    }
    std::ranges::sort(names);
    return did_you_mean(file.string(), names, otherwise);
}

}  // namespace clearway::core
