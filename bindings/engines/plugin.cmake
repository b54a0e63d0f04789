# singe_plugin(NAME SOURCE...)    a shared library for an engine: its sources, the sheet that engines share, and both libraries
# inside, with the mathematics that both have once
function(singe_plugin name)
  add_library(${name} SHARED ${ARGN} ${PROJECT_SOURCE_DIR}/bindings/engines/burning_sheet.c $<TARGET_OBJECTS:singe>
    $<FILTER:$<TARGET_OBJECTS:singe_input>,EXCLUDE,common/real> $<TARGET_OBJECTS:singe_mesh_objects>)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/bindings/engines ${PROJECT_SOURCE_DIR}/include)
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE C C_VISIBILITY_PRESET hidden
                        LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  target_link_libraries(${name} PRIVATE Threads::Threads m)
endfunction()
