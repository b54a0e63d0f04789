########### AGGREGATED COMPONENTS AND DEPENDENCIES FOR THE MULTI CONFIG #####################
#############################################################################################

list(APPEND singe_COMPONENT_NAMES singe::singe singe::input)
list(REMOVE_DUPLICATES singe_COMPONENT_NAMES)
if(DEFINED singe_FIND_DEPENDENCY_NAMES)
  list(APPEND singe_FIND_DEPENDENCY_NAMES )
  list(REMOVE_DUPLICATES singe_FIND_DEPENDENCY_NAMES)
else()
  set(singe_FIND_DEPENDENCY_NAMES )
endif()

########### VARIABLES #######################################################################
#############################################################################################
set(singe_PACKAGE_FOLDER_RELEASE "/work/tmp/pk/conan-home/p/b/singe9721563072122/p")
set(singe_BUILD_MODULES_PATHS_RELEASE )


set(singe_INCLUDE_DIRS_RELEASE "${singe_PACKAGE_FOLDER_RELEASE}/include")
set(singe_RES_DIRS_RELEASE )
set(singe_DEFINITIONS_RELEASE )
set(singe_SHARED_LINK_FLAGS_RELEASE )
set(singe_EXE_LINK_FLAGS_RELEASE )
set(singe_OBJECTS_RELEASE )
set(singe_COMPILE_DEFINITIONS_RELEASE )
set(singe_COMPILE_OPTIONS_C_RELEASE )
set(singe_COMPILE_OPTIONS_CXX_RELEASE )
set(singe_LIB_DIRS_RELEASE "${singe_PACKAGE_FOLDER_RELEASE}/lib")
set(singe_BIN_DIRS_RELEASE )
set(singe_LIBRARY_TYPE_RELEASE STATIC)
set(singe_IS_HOST_WINDOWS_RELEASE 0)
set(singe_LIBS_RELEASE singe_input singe)
set(singe_SYSTEM_LIBS_RELEASE m pthread)
set(singe_FRAMEWORK_DIRS_RELEASE )
set(singe_FRAMEWORKS_RELEASE )
set(singe_BUILD_DIRS_RELEASE )
set(singe_NO_SONAME_MODE_RELEASE FALSE)


# COMPOUND VARIABLES
set(singe_COMPILE_OPTIONS_RELEASE)
if (NOT "${singe_COMPILE_OPTIONS_CXX_RELEASE}" STREQUAL "")
    list(APPEND singe_COMPILE_OPTIONS_RELEASE
        "$<$<COMPILE_LANGUAGE:CXX>:${singe_COMPILE_OPTIONS_CXX_RELEASE}>")
endif ()
if (NOT "${singe_COMPILE_OPTIONS_C_RELEASE}" STREQUAL "")
    list(APPEND singe_COMPILE_OPTIONS_RELEASE
        "$<$<COMPILE_LANGUAGE:C>:${singe_COMPILE_OPTIONS_C_RELEASE}>")
endif ()
set(singe_LINKER_FLAGS_RELEASE)
if (NOT "${singe_SHARED_LINK_FLAGS_RELEASE}" STREQUAL "")
    list(APPEND singe_LINKER_FLAGS_RELEASE
        "$<$<OR:$<STREQUAL:$<TARGET_PROPERTY:TYPE>,SHARED_LIBRARY>,$<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>>:${singe_SHARED_LINK_FLAGS_RELEASE}>")
endif ()
if (NOT "${singe_EXE_LINK_FLAGS_RELEASE}" STREQUAL "")
    list(APPEND singe_LINKER_FLAGS_RELEASE
        "$<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:${singe_EXE_LINK_FLAGS_RELEASE}>")
endif ()


set(singe_COMPONENTS_RELEASE singe::singe singe::input)
########### COMPONENT singe::input VARIABLES ############################################

set(singe_singe_input_INCLUDE_DIRS_RELEASE "${singe_PACKAGE_FOLDER_RELEASE}/include")
set(singe_singe_input_LIB_DIRS_RELEASE "${singe_PACKAGE_FOLDER_RELEASE}/lib")
set(singe_singe_input_BIN_DIRS_RELEASE )
set(singe_singe_input_LIBRARY_TYPE_RELEASE STATIC)
set(singe_singe_input_IS_HOST_WINDOWS_RELEASE 0)
set(singe_singe_input_RES_DIRS_RELEASE )
set(singe_singe_input_DEFINITIONS_RELEASE )
set(singe_singe_input_OBJECTS_RELEASE )
set(singe_singe_input_COMPILE_DEFINITIONS_RELEASE )
set(singe_singe_input_COMPILE_OPTIONS_C_RELEASE "")
set(singe_singe_input_COMPILE_OPTIONS_CXX_RELEASE "")
set(singe_singe_input_LIBS_RELEASE singe_input)
set(singe_singe_input_SYSTEM_LIBS_RELEASE )
set(singe_singe_input_FRAMEWORK_DIRS_RELEASE )
set(singe_singe_input_FRAMEWORKS_RELEASE )
set(singe_singe_input_DEPENDENCIES_RELEASE singe::singe)
set(singe_singe_input_SHARED_LINK_FLAGS_RELEASE )
set(singe_singe_input_EXE_LINK_FLAGS_RELEASE )
set(singe_singe_input_NO_SONAME_MODE_RELEASE FALSE)

# COMPOUND VARIABLES
set(singe_singe_input_LINKER_FLAGS_RELEASE)
if (NOT "${singe_singe_input_SHARED_LINK_FLAGS_RELEASE}" STREQUAL "")
    list(APPEND singe_singe_input_LINKER_FLAGS_RELEASE
        $<$<OR:$<STREQUAL:$<TARGET_PROPERTY:TYPE>,SHARED_LIBRARY>,$<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>>:${singe_singe_input_SHARED_LINK_FLAGS_RELEASE}>)
endif ()
if (NOT "${singe_singe_input_EXE_LINK_FLAGS_RELEASE}" STREQUAL "")
    list(APPEND singe_singe_input_LINKER_FLAGS_RELEASE
        $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:${singe_singe_input_EXE_LINK_FLAGS_RELEASE}>)
endif ()
set(singe_singe_input_COMPILE_OPTIONS_RELEASE)
if (NOT "${singe_singe_input_COMPILE_OPTIONS_CXX_RELEASE}" STREQUAL "")
    list(APPEND singe_singe_input_COMPILE_OPTIONS_RELEASE
        "$<$<COMPILE_LANGUAGE:CXX>:${singe_singe_input_COMPILE_OPTIONS_CXX_RELEASE}>")
endif ()
if (NOT "${singe_singe_input_COMPILE_OPTIONS_C_RELEASE}" STREQUAL "")
    list(APPEND singe_singe_input_COMPILE_OPTIONS_RELEASE
        "$<$<COMPILE_LANGUAGE:C>:${singe_singe_input_COMPILE_OPTIONS_C_RELEASE}>")
endif ()
########### COMPONENT singe::singe VARIABLES ############################################

set(singe_singe_singe_INCLUDE_DIRS_RELEASE "${singe_PACKAGE_FOLDER_RELEASE}/include")
set(singe_singe_singe_LIB_DIRS_RELEASE "${singe_PACKAGE_FOLDER_RELEASE}/lib")
set(singe_singe_singe_BIN_DIRS_RELEASE )
set(singe_singe_singe_LIBRARY_TYPE_RELEASE STATIC)
set(singe_singe_singe_IS_HOST_WINDOWS_RELEASE 0)
set(singe_singe_singe_RES_DIRS_RELEASE )
set(singe_singe_singe_DEFINITIONS_RELEASE )
set(singe_singe_singe_OBJECTS_RELEASE )
set(singe_singe_singe_COMPILE_DEFINITIONS_RELEASE )
set(singe_singe_singe_COMPILE_OPTIONS_C_RELEASE "")
set(singe_singe_singe_COMPILE_OPTIONS_CXX_RELEASE "")
set(singe_singe_singe_LIBS_RELEASE singe)
set(singe_singe_singe_SYSTEM_LIBS_RELEASE m pthread)
set(singe_singe_singe_FRAMEWORK_DIRS_RELEASE )
set(singe_singe_singe_FRAMEWORKS_RELEASE )
set(singe_singe_singe_DEPENDENCIES_RELEASE )
set(singe_singe_singe_SHARED_LINK_FLAGS_RELEASE )
set(singe_singe_singe_EXE_LINK_FLAGS_RELEASE )
set(singe_singe_singe_NO_SONAME_MODE_RELEASE FALSE)

# COMPOUND VARIABLES
set(singe_singe_singe_LINKER_FLAGS_RELEASE)
if (NOT "${singe_singe_singe_SHARED_LINK_FLAGS_RELEASE}" STREQUAL "")
    list(APPEND singe_singe_singe_LINKER_FLAGS_RELEASE
        $<$<OR:$<STREQUAL:$<TARGET_PROPERTY:TYPE>,SHARED_LIBRARY>,$<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>>:${singe_singe_singe_SHARED_LINK_FLAGS_RELEASE}>)
endif ()
if (NOT "${singe_singe_singe_EXE_LINK_FLAGS_RELEASE}" STREQUAL "")
    list(APPEND singe_singe_singe_LINKER_FLAGS_RELEASE
        $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:${singe_singe_singe_EXE_LINK_FLAGS_RELEASE}>)
endif ()
set(singe_singe_singe_COMPILE_OPTIONS_RELEASE)
if (NOT "${singe_singe_singe_COMPILE_OPTIONS_CXX_RELEASE}" STREQUAL "")
    list(APPEND singe_singe_singe_COMPILE_OPTIONS_RELEASE
        "$<$<COMPILE_LANGUAGE:CXX>:${singe_singe_singe_COMPILE_OPTIONS_CXX_RELEASE}>")
endif ()
if (NOT "${singe_singe_singe_COMPILE_OPTIONS_C_RELEASE}" STREQUAL "")
    list(APPEND singe_singe_singe_COMPILE_OPTIONS_RELEASE
        "$<$<COMPILE_LANGUAGE:C>:${singe_singe_singe_COMPILE_OPTIONS_C_RELEASE}>")
endif ()