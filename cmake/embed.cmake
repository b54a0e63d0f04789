# Writes a C file that holds the files of a folder: cmake -DFOLDER=materials -DOUTPUT=materials.c -P embed.cmake
file(GLOB files "${FOLDER}/*.yaml")
list(SORT files)
set(arrays "")
set(rows "")
foreach(file IN LISTS files)
  get_filename_component(name "${file}" NAME_WE)
  string(MAKE_C_IDENTIFIER "${name}" array)
  file(READ "${file}" bytes HEX)
  string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "static const unsigned char ${array}[] = {\n${bytes}};\n")
  string(APPEND rows "    {\"${name}\", (const char *)${array}, sizeof ${array}},\n")
endforeach()
file(WRITE "${OUTPUT}" "// made by cmake/embed.cmake from materials/*.yaml
#include \"scene/builtin.h\"

${arrays}
const SceneBuiltin scene_builtins[] = {
${rows}    {0},
};
")
