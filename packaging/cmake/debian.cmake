# Run by cpack before it packs: what Debian wants of a package beside its files. Manuals are compressed, and there is a
# changelog, of the day of SOURCE_DATE_EPOCH where that is set.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  return()
endif()
string(TIMESTAMP day "%a, %d %b %Y 00:00:00 +0000" UTC)
file(GLOB documents ${CPACK_TEMPORARY_DIRECTORY}/*/usr/share/doc/*)
foreach(folder IN LISTS documents)
  get_filename_component(package ${folder} NAME)
  file(WRITE ${folder}/changelog "${package} (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium\n\n"
       "  * As CHANGELOG.md of the sources says.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${day}\n")
  # nobody's address: whoever publishes the packages names a maintainer
  get_filename_component(root ${folder}/../../../.. ABSOLUTE)
  file(WRITE ${root}/usr/share/lintian/overrides/${package}
       "${package}: bogus-mail-host\n${package}: bogus-mail-host-in-debian-changelog\n")
  execute_process(COMMAND gzip -9n ${folder}/changelog RESULT_VARIABLE failed)
  file(GLOB pages ${root}/usr/share/man/man1/*.1)
  if(pages AND NOT failed)
    execute_process(COMMAND gzip -9n ${pages} RESULT_VARIABLE failed)
  endif()
  if(failed)
    message(FATAL_ERROR "gzip: ${failed}")
  endif()
endforeach()
