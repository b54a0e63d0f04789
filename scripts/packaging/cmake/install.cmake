# Installs the library with its headers, find_package and pkg-config files, and the program.
include(CMakePackageConfigHelpers)

# Components: `program`, the command, and `development`, the libraries with their headers.
install(TARGETS singe singe_input EXPORT singeTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT development)
if(NOT BUILD_SHARED_LIBS AND CMAKE_OBJCOPY AND CMAKE_SYSTEM_NAME STREQUAL Linux
   AND NOT CMAKE_INTERPROCEDURAL_OPTIMIZATION)
  install(CODE "
    set(singe_archives \"${CMAKE_INSTALL_LIBDIR}/libsinge.a\" \"${CMAKE_INSTALL_LIBDIR}/libsinge_input.a\")
    set(singe_cc \"${CMAKE_C_COMPILER}\")
    set(singe_objcopy \"${CMAKE_OBJCOPY}\")
    set(singe_ar \"${CMAKE_AR}\")" COMPONENT development)
  install(SCRIPT scripts/packaging/cmake/localise.cmake COMPONENT development)
endif()
set_target_properties(singe singe_input PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
install(DIRECTORY include/singe DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.h" PATTERN "*.def")

set(singe_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/singe)
install(EXPORT singeTargets NAMESPACE singe:: DESTINATION ${singe_package_dir} COMPONENT development)
configure_package_config_file(scripts/packaging/cmake/singeConfig.cmake.in ${PROJECT_BINARY_DIR}/singeConfig.cmake
                              INSTALL_DESTINATION ${singe_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/singeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/singeConfig.cmake ${PROJECT_BINARY_DIR}/singeConfigVersion.cmake
        DESTINATION ${singe_package_dir} COMPONENT development)

# whoever links a static library has to name its own libraries
set(singe_pc_private "-lm -pthread")
if(WIN32)
  set(singe_pc_private "-lm")
endif()
set(singe_pc_public "")
if(NOT BUILD_SHARED_LIBS)
  set(singe_pc_public " ${singe_pc_private}")
  set(singe_pc_private "")
endif()
file(RELATIVE_PATH singe_pc_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
string(REGEX REPLACE "/$" "" singe_pc_prefix ${singe_pc_prefix})
configure_file(scripts/packaging/cmake/singe.pc.in ${PROJECT_BINARY_DIR}/singe.pc @ONLY)
configure_file(scripts/packaging/cmake/singe-input.pc.in ${PROJECT_BINARY_DIR}/singe-input.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/singe.pc ${PROJECT_BINARY_DIR}/singe-input.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT development)

if(SINGE_PROGRAM)
  if(BUILD_SHARED_LIBS) # the command finds the library after both have been moved
    file(RELATIVE_PATH singe_bin_to_lib /prefix/${CMAKE_INSTALL_BINDIR} /prefix/${CMAKE_INSTALL_LIBDIR})
    set_target_properties(singe_program PROPERTIES INSTALL_RPATH "$ORIGIN/${singe_bin_to_lib}")
  endif()
  add_dependencies(singe_program singe singe_input) # who has built the command can install everything
  install(TARGETS singe_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  if(NOT CMAKE_CROSSCOMPILING) # where man, bash, zsh and fish look
    set(words ${PROJECT_BINARY_DIR}/words)
    install(DIRECTORY ${words}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
    install(FILES ${words}/singe.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME singe
            COMPONENT program)
    install(FILES ${words}/_singe DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT program)
    install(FILES ${words}/singe.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
  endif()
  # the command contains the materials; these are for reading and copying
  install(DIRECTORY src/materials DESTINATION ${CMAKE_INSTALL_DATADIR}/singe COMPONENT program FILES_MATCHING PATTERN "*.yaml")
endif()
