# Makes each installed archive one object in which only the public names are global, so that the libraries' own
# (pool_for, wind_check) cannot meet a client's. Tests link the libraries as they were built.
# Set by the caller: singe_archives (below the prefix), singe_cc, singe_objcopy, singe_ar.
foreach(singe_archive IN LISTS singe_archives)
  set(archive "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${singe_archive}")
  set(object "${archive}.o")
  execute_process(COMMAND ${singe_cc} -r -nostdlib -Wl,--whole-archive ${archive} -o ${object}
                  COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${singe_objcopy} --localize-hidden ${object} COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE ${archive})
  execute_process(COMMAND ${singe_ar} rcs ${archive} ${object} COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE ${object})
endforeach()
