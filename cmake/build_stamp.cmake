# Writes OUTPUT, a C++ file with the stamp of the sources which the file LIST names, one a line below ROOT: a hash of their
# names and contents. Times, commits and the place of the tree do not matter, so that a clean tree and a dirty one with
# equal sources have one stamp.
file(STRINGS ${LIST} files)
set(facts)
foreach(file ${files})
    file(SHA256 ${ROOT}/${file} hash)
    string(APPEND facts "${hash} ${file}\n")
endforeach()
string(SHA256 stamp "${facts}")
string(SUBSTRING ${stamp} 0 16 stamp)
file(WRITE ${OUTPUT}.new "#include \"core/build_stamp.hpp\"\n
namespace clearway::core {\n
std::string_view build_stamp() {
    return \"${stamp}\";
}\n
}  // namespace clearway::core\n")
file(RENAME ${OUTPUT}.new ${OUTPUT})
