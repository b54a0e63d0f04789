# Writes a C file that holds the files of a folder as rows of a table:
#   cmake -DFOLDER=materials -DPATTERN=*.yaml -DTABLE=scene_builtins -DOUTPUT=builtin.c [-DWHOLE_NAMES=ON]
#         -P embed.cmake
# A row's name is the file's, without its ending unless WHOLE_NAMES.
file(GLOB files "${FOLDER}/${PATTERN}")
list(SORT files)
set(arrays "")
set(rows "")
foreach(file IN LISTS files)
  if(WHOLE_NAMES)
    get_filename_component(name "${file}" NAME)
  else()
    get_filename_component(name "${file}" NAME_WE)
  endif()
  string(MAKE_C_IDENTIFIER "${name}" array)
  file(READ "${file}" bytes HEX)
  string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "static const unsigned char ${array}[] = {\n${bytes}};\n")
  string(APPEND rows "    {\"${name}\", (const char *)${array}, sizeof ${array}},\n")
endforeach()
get_filename_component(folder "${FOLDER}" NAME)
file(WRITE "${OUTPUT}" "// made by scripts/packaging/cmake/embed.cmake from ${folder}/${PATTERN}
#include \"scene/builtin.h\"

${arrays}
extern const SceneBuiltin ${TABLE}[];
const SceneBuiltin ${TABLE}[] = {
${rows}    {0},
};
")
