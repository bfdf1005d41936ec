# Writes OUTPUT, a C++ file with the text of TABLE.
file(READ ${TABLE} text)
file(WRITE ${OUTPUT}.new "#include \"scenario_import/osm/driving_side.hpp\"\n
namespace clearway::scenario_import::detail {\n
const char* const driving_sides = R\"table(${text})table\";\n
}  // namespace clearway::scenario_import::detail\n")
file(RENAME ${OUTPUT}.new ${OUTPUT})
