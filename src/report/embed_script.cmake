# Writes OUTPUT, a C++ file with the text of SCRIPT and its SHA-256, by which a page allows it to run.
file(READ ${SCRIPT} text)
file(SHA256 ${SCRIPT} hash)
file(WRITE ${OUTPUT}.new "#include \"report/detail/script.hpp\"\n
namespace clearway::report::detail {\n
const char* const script_text = R\"script(${text})script\";
const char* const script_sha256 = \"${hash}\";\n
}  // namespace clearway::report::detail\n")
file(RENAME ${OUTPUT}.new ${OUTPUT})
