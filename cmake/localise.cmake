# Makes the installed libsinge.a one object in which only the public names are global, so that the library's own
# (pool_for, wind_check) cannot meet a client's. Tests link the library as it was built.
# Set by the caller: singe_archive (below the prefix), singe_cc, singe_objcopy, singe_ar.
set(archive "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${singe_archive}")
set(object "${archive}.o")
execute_process(COMMAND ${singe_cc} -r -nostdlib -Wl,--whole-archive ${archive} -o ${object} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${singe_objcopy} --localize-hidden ${object} COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE ${archive})
execute_process(COMMAND ${singe_ar} rcs ${archive} ${object} COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE ${object})
