# Avoid multiple calls to find_package to append duplicated properties to the targets
include_guard()########### VARIABLES #######################################################################
#############################################################################################
set(singe_FRAMEWORKS_FOUND_RELEASE "") # Will be filled later
conan_find_apple_frameworks(singe_FRAMEWORKS_FOUND_RELEASE "${singe_FRAMEWORKS_RELEASE}" "${singe_FRAMEWORK_DIRS_RELEASE}")

set(singe_LIBRARIES_TARGETS "") # Will be filled later


######## Create an interface target to contain all the dependencies (frameworks, system and conan deps)
if(NOT TARGET singe_DEPS_TARGET)
    add_library(singe_DEPS_TARGET INTERFACE IMPORTED)
endif()

set_property(TARGET singe_DEPS_TARGET
             APPEND PROPERTY INTERFACE_LINK_LIBRARIES
             $<$<CONFIG:Release>:${singe_FRAMEWORKS_FOUND_RELEASE}>
             $<$<CONFIG:Release>:${singe_SYSTEM_LIBS_RELEASE}>
             $<$<CONFIG:Release>:singe::singe>)

####### Find the libraries declared in cpp_info.libs, create an IMPORTED target for each one and link the
####### singe_DEPS_TARGET to all of them
conan_package_library_targets("${singe_LIBS_RELEASE}"    # libraries
                              "${singe_LIB_DIRS_RELEASE}" # package_libdir
                              "${singe_BIN_DIRS_RELEASE}" # package_bindir
                              "${singe_LIBRARY_TYPE_RELEASE}"
                              "${singe_IS_HOST_WINDOWS_RELEASE}"
                              singe_DEPS_TARGET
                              singe_LIBRARIES_TARGETS  # out_libraries_targets
                              "_RELEASE"
                              "singe"    # package_name
                              "${singe_NO_SONAME_MODE_RELEASE}")  # soname

# FIXME: What is the result of this for multi-config? All configs adding themselves to path?
set(CMAKE_MODULE_PATH ${singe_BUILD_DIRS_RELEASE} ${CMAKE_MODULE_PATH})

########## COMPONENTS TARGET PROPERTIES Release ########################################

    ########## COMPONENT singe::input #############

        set(singe_singe_input_FRAMEWORKS_FOUND_RELEASE "")
        conan_find_apple_frameworks(singe_singe_input_FRAMEWORKS_FOUND_RELEASE "${singe_singe_input_FRAMEWORKS_RELEASE}" "${singe_singe_input_FRAMEWORK_DIRS_RELEASE}")

        set(singe_singe_input_LIBRARIES_TARGETS "")

        ######## Create an interface target to contain all the dependencies (frameworks, system and conan deps)
        if(NOT TARGET singe_singe_input_DEPS_TARGET)
            add_library(singe_singe_input_DEPS_TARGET INTERFACE IMPORTED)
        endif()

        set_property(TARGET singe_singe_input_DEPS_TARGET
                     APPEND PROPERTY INTERFACE_LINK_LIBRARIES
                     $<$<CONFIG:Release>:${singe_singe_input_FRAMEWORKS_FOUND_RELEASE}>
                     $<$<CONFIG:Release>:${singe_singe_input_SYSTEM_LIBS_RELEASE}>
                     $<$<CONFIG:Release>:${singe_singe_input_DEPENDENCIES_RELEASE}>
                     )

        ####### Find the libraries declared in cpp_info.component["xxx"].libs,
        ####### create an IMPORTED target for each one and link the 'singe_singe_input_DEPS_TARGET' to all of them
        conan_package_library_targets("${singe_singe_input_LIBS_RELEASE}"
                              "${singe_singe_input_LIB_DIRS_RELEASE}"
                              "${singe_singe_input_BIN_DIRS_RELEASE}" # package_bindir
                              "${singe_singe_input_LIBRARY_TYPE_RELEASE}"
                              "${singe_singe_input_IS_HOST_WINDOWS_RELEASE}"
                              singe_singe_input_DEPS_TARGET
                              singe_singe_input_LIBRARIES_TARGETS
                              "_RELEASE"
                              "singe_singe_input"
                              "${singe_singe_input_NO_SONAME_MODE_RELEASE}")


        ########## TARGET PROPERTIES #####################################
        set_property(TARGET singe::input
                     APPEND PROPERTY INTERFACE_LINK_LIBRARIES
                     $<$<CONFIG:Release>:${singe_singe_input_OBJECTS_RELEASE}>
                     $<$<CONFIG:Release>:${singe_singe_input_LIBRARIES_TARGETS}>
                     )

        if("${singe_singe_input_LIBS_RELEASE}" STREQUAL "")
            # If the component is not declaring any "cpp_info.components['foo'].libs" the system, frameworks etc are not
            # linked to the imported targets and we need to do it to the global target
            set_property(TARGET singe::input
                         APPEND PROPERTY INTERFACE_LINK_LIBRARIES
                         singe_singe_input_DEPS_TARGET)
        endif()

        set_property(TARGET singe::input APPEND PROPERTY INTERFACE_LINK_OPTIONS
                     $<$<CONFIG:Release>:${singe_singe_input_LINKER_FLAGS_RELEASE}>)
        set_property(TARGET singe::input APPEND PROPERTY INTERFACE_INCLUDE_DIRECTORIES
                     $<$<CONFIG:Release>:${singe_singe_input_INCLUDE_DIRS_RELEASE}>)
        set_property(TARGET singe::input APPEND PROPERTY INTERFACE_LINK_DIRECTORIES
                     $<$<CONFIG:Release>:${singe_singe_input_LIB_DIRS_RELEASE}>)
        set_property(TARGET singe::input APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS
                     $<$<CONFIG:Release>:${singe_singe_input_COMPILE_DEFINITIONS_RELEASE}>)
        set_property(TARGET singe::input APPEND PROPERTY INTERFACE_COMPILE_OPTIONS
                     $<$<CONFIG:Release>:${singe_singe_input_COMPILE_OPTIONS_RELEASE}>)


    ########## COMPONENT singe::singe #############

        set(singe_singe_singe_FRAMEWORKS_FOUND_RELEASE "")
        conan_find_apple_frameworks(singe_singe_singe_FRAMEWORKS_FOUND_RELEASE "${singe_singe_singe_FRAMEWORKS_RELEASE}" "${singe_singe_singe_FRAMEWORK_DIRS_RELEASE}")

        set(singe_singe_singe_LIBRARIES_TARGETS "")

        ######## Create an interface target to contain all the dependencies (frameworks, system and conan deps)
        if(NOT TARGET singe_singe_singe_DEPS_TARGET)
            add_library(singe_singe_singe_DEPS_TARGET INTERFACE IMPORTED)
        endif()

        set_property(TARGET singe_singe_singe_DEPS_TARGET
                     APPEND PROPERTY INTERFACE_LINK_LIBRARIES
                     $<$<CONFIG:Release>:${singe_singe_singe_FRAMEWORKS_FOUND_RELEASE}>
                     $<$<CONFIG:Release>:${singe_singe_singe_SYSTEM_LIBS_RELEASE}>
                     $<$<CONFIG:Release>:${singe_singe_singe_DEPENDENCIES_RELEASE}>
                     )

        ####### Find the libraries declared in cpp_info.component["xxx"].libs,
        ####### create an IMPORTED target for each one and link the 'singe_singe_singe_DEPS_TARGET' to all of them
        conan_package_library_targets("${singe_singe_singe_LIBS_RELEASE}"
                              "${singe_singe_singe_LIB_DIRS_RELEASE}"
                              "${singe_singe_singe_BIN_DIRS_RELEASE}" # package_bindir
                              "${singe_singe_singe_LIBRARY_TYPE_RELEASE}"
                              "${singe_singe_singe_IS_HOST_WINDOWS_RELEASE}"
                              singe_singe_singe_DEPS_TARGET
                              singe_singe_singe_LIBRARIES_TARGETS
                              "_RELEASE"
                              "singe_singe_singe"
                              "${singe_singe_singe_NO_SONAME_MODE_RELEASE}")


        ########## TARGET PROPERTIES #####################################
        set_property(TARGET singe::singe
                     APPEND PROPERTY INTERFACE_LINK_LIBRARIES
                     $<$<CONFIG:Release>:${singe_singe_singe_OBJECTS_RELEASE}>
                     $<$<CONFIG:Release>:${singe_singe_singe_LIBRARIES_TARGETS}>
                     )

        if("${singe_singe_singe_LIBS_RELEASE}" STREQUAL "")
            # If the component is not declaring any "cpp_info.components['foo'].libs" the system, frameworks etc are not
            # linked to the imported targets and we need to do it to the global target
            set_property(TARGET singe::singe
                         APPEND PROPERTY INTERFACE_LINK_LIBRARIES
                         singe_singe_singe_DEPS_TARGET)
        endif()

        set_property(TARGET singe::singe APPEND PROPERTY INTERFACE_LINK_OPTIONS
                     $<$<CONFIG:Release>:${singe_singe_singe_LINKER_FLAGS_RELEASE}>)
        set_property(TARGET singe::singe APPEND PROPERTY INTERFACE_INCLUDE_DIRECTORIES
                     $<$<CONFIG:Release>:${singe_singe_singe_INCLUDE_DIRS_RELEASE}>)
        set_property(TARGET singe::singe APPEND PROPERTY INTERFACE_LINK_DIRECTORIES
                     $<$<CONFIG:Release>:${singe_singe_singe_LIB_DIRS_RELEASE}>)
        set_property(TARGET singe::singe APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS
                     $<$<CONFIG:Release>:${singe_singe_singe_COMPILE_DEFINITIONS_RELEASE}>)
        set_property(TARGET singe::singe APPEND PROPERTY INTERFACE_COMPILE_OPTIONS
                     $<$<CONFIG:Release>:${singe_singe_singe_COMPILE_OPTIONS_RELEASE}>)


    ########## AGGREGATED GLOBAL TARGET WITH THE COMPONENTS #####################
    set_property(TARGET singe::singe APPEND PROPERTY INTERFACE_LINK_LIBRARIES singe::input)
    set_property(TARGET singe::singe APPEND PROPERTY INTERFACE_LINK_LIBRARIES singe::singe)

########## For the modules (FindXXX)
set(singe_LIBRARIES_RELEASE singe::singe)
