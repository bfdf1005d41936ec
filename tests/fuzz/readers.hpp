#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace clearway::fuzz {

/// A reader of bytes that others may have made. It must return, or throw core::Error.
struct Reader {
    std::string name;
    std::function<void(std::string_view bytes)> read;
    std::vector<std::string> seeds = {};  ///< Files that it reads; at least one.
    std::vector<std::string> words = {};  ///< What a change may put in, beside bytes.

    friend void PrintTo(const Reader& reader, std::ostream* out) { *out << reader.name; }
};

/// All of them, by name, with the files of the tree as seeds.
std::vector<Reader> readers();
/// Those of TOML, CSV, JSON and XML.
std::vector<Reader> text_readers();
/// Those of models, recordings and frames.
std::vector<Reader> binary_readers();

/// Bytes of a file below the source folder.
std::string source_file(const std::string& path);
/// Writes `bytes` where they stay until the next call with this name. Returns the file.
std::string scratch_file(const std::string& name, std::string_view bytes);

}  // namespace clearway::fuzz
