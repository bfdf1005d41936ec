#include "fuzz/readers.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/files.hpp"
#include "core/temporary_folder.hpp"

namespace clearway::fuzz {

std::string source_file(const std::string& path) {
    return core::read_file(std::string(CLEARWAY_SOURCE_DIR) + "/" + path);
}

std::string scratch_file(const std::string& name, std::string_view bytes) {
    static const core::TemporaryFolder folder;
    const std::string file = (folder.path() / name).string();
    std::filesystem::remove(file);  // a new file: many file systems flush one that is written anew
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
}

std::vector<Reader> readers() {
    std::vector<Reader> all = text_readers();
    std::ranges::move(binary_readers(), std::back_inserter(all));
    return all;
}

}  // namespace clearway::fuzz
