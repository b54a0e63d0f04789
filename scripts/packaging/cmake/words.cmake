# Writes the command's manual pages and completion, by the command itself:
#   cmake -DSINGE=build/singe -DOUTPUT=build/words -P words.cmake
execute_process(COMMAND ${SINGE} manual -o ${OUTPUT}/man1 RESULT_VARIABLE failed)
foreach(file IN ITEMS bash:singe.bash zsh:_singe fish:singe.fish)
  string(REGEX MATCH "([a-z]+):(.*)" file ${file})
  if(NOT failed)
    execute_process(COMMAND ${SINGE} completion ${CMAKE_MATCH_1} OUTPUT_FILE ${OUTPUT}/${CMAKE_MATCH_2}
                    RESULT_VARIABLE failed)
  endif()
endforeach()
if(failed)
  message(FATAL_ERROR "${SINGE} could not write its manual and completion: ${failed}")
endif()
