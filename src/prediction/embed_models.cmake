# Writes OUTPUT, a C++ file with the text of FILES (a list of .weights files), each under its name without ending. Text is
# cut into literals of at most 8000 characters, which every compiler takes.
set(rows)
foreach(file ${FILES})
    get_filename_component(name ${file} NAME_WE)
    file(READ ${file} text)
    string(LENGTH "${text}" length)
    set(literals)
    set(at 0)
    while(at LESS length)
        string(SUBSTRING "${text}" ${at} 8000 part)
        string(APPEND literals "        R\"model(${part})model\"\n")
        math(EXPR at "${at} + 8000")
    endwhile()
    string(APPEND rows "    {\"${name}\",\n${literals}    },\n")
endforeach()
file(WRITE ${OUTPUT}.new "#include <vector>\n
#include \"prediction/detail/model_texts.hpp\"\n
namespace clearway::prediction::detail {\n
std::span<const ModelText> model_texts() {
    static const std::vector<ModelText> texts = {\n${rows}    };
    return texts;
}\n
}  // namespace clearway::prediction::detail\n")
file(RENAME ${OUTPUT}.new ${OUTPUT})
