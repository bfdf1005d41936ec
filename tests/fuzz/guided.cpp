// One reader under libFuzzer, which keeps inputs that reach new branches: scripts/fuzz starts it.
//   CLEARWAY_FUZZ_READER=NAME fuzz_guided [OPTION ...] FOLDER | FILE
// The reader's seeds are written into FOLDER, its words into the dictionary FOLDER.words. Without the
// variable: prints the names of all readers.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "fuzz/readers.hpp"

namespace clearway::fuzz {
namespace {

const Reader* chosen = nullptr;

/// A line of libFuzzer's dictionary.
std::string dictionary_line(const std::string& word) {
    std::string line = "\"";
    for (const unsigned char letter : word)
        line += fmt::format("\\x{:02x}", letter);
    return line + "\"\n";
}

void choose_reader() {
    static const std::vector<Reader> all = readers();
    const char* const name = std::getenv("CLEARWAY_FUZZ_READER");
    const auto found = std::ranges::find(all, name == nullptr ? "" : name, &Reader::name);
    if (found != all.end()) {
        chosen = &*found;
        return;
    }
    for (const Reader& reader : all)
        std::puts(reader.name.c_str());
    std::exit(name == nullptr ? 0 : 2);
}

}  // namespace
}  // namespace clearway::fuzz

using namespace clearway::fuzz;

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
    choose_reader();
    const std::string folder = (*arguments)[*count - 1];
    if (std::filesystem::is_directory(folder)) {  // otherwise an input that is to be repeated
        for (std::size_t number = 0; number < chosen->seeds.size(); ++number)
            clearway::core::write_atomically(fmt::format("{}/seed_{}", folder, number),
                                             chosen->seeds[number]);
        std::string lines;
        for (const std::string& word : chosen->words)
            lines += dictionary_line(word);
        clearway::core::write_atomically(folder + ".words", lines);
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, std::size_t size) {
    try {
        chosen->read({reinterpret_cast<const char*>(bytes), size});
    } catch (const clearway::core::Error&) {  // anything else ends the process, and libFuzzer keeps the input
    }
    return 0;
}
