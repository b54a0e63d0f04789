# Gives every target below the part of POSIX that Windows lacks (posix.h), and headers of POSIX that lead to it.
foreach(header alloca dirent poll spawn termios sys/ioctl sys/mman sys/random sys/resource sys/select sys/wait)
  file(WRITE ${PROJECT_BINARY_DIR}/posix/${header}.h "#include \"${CMAKE_CURRENT_LIST_DIR}/posix.h\"\n")
endforeach()
include_directories(BEFORE ${PROJECT_BINARY_DIR}/posix)
add_compile_options(-include ${CMAKE_CURRENT_LIST_DIR}/posix.h)
