CMakeFiles/consumer.dir/consumer.c.o: \
 /work/main/packaging/conan/test_package/consumer.c \
 /usr/include/stdc-predef.h \
 /work/tmp/pk/conan-home/p/b/singe9721563072122/p/include/singe/singe.h \
 /work/tmp/pk/conan-home/p/b/singe9721563072122/p/include/singe/base.h \
 /usr/lib/gcc/x86_64-linux-gnu/12/include/stdbool.h \
 /usr/lib/gcc/x86_64-linux-gnu/12/include/stddef.h \
 /usr/lib/gcc/x86_64-linux-gnu/12/include/stdint.h /usr/include/stdint.h \
 /usr/include/x86_64-linux-gnu/bits/libc-header-start.h \
 /usr/include/features.h /usr/include/features-time64.h \
 /usr/include/x86_64-linux-gnu/bits/wordsize.h \
 /usr/include/x86_64-linux-gnu/bits/timesize.h \
 /usr/include/x86_64-linux-gnu/sys/cdefs.h \
 /usr/include/x86_64-linux-gnu/bits/long-double.h \
 /usr/include/x86_64-linux-gnu/gnu/stubs.h \
 /usr/include/x86_64-linux-gnu/gnu/stubs-64.h \
 /usr/include/x86_64-linux-gnu/bits/types.h \
 /usr/include/x86_64-linux-gnu/bits/typesizes.h \
 /usr/include/x86_64-linux-gnu/bits/time64.h \
 /usr/include/x86_64-linux-gnu/bits/wchar.h \
 /usr/include/x86_64-linux-gnu/bits/stdint-intn.h \
 /usr/include/x86_64-linux-gnu/bits/stdint-uintn.h \
 /work/tmp/pk/conan-home/p/b/singe9721563072122/p/include/singe/material.h \
 /work/tmp/pk/conan-home/p/b/singe9721563072122/p/include/singe/material.def \
 /work/tmp/pk/conan-home/p/b/singe9721563072122/p/include/singe/types.h \
 /work/tmp/pk/conan-home/p/b/singe9721563072122/p/include/singe/mesh.h \
 /work/tmp/pk/conan-home/p/b/singe9721563072122/p/include/singe/surface.h \
 /work/tmp/pk/conan-home/p/b/singe9721563072122/p/include/singe/sim.h \
 /work/tmp/pk/conan-home/p/b/singe9721563072122/p/include/singe/research.h \
 /usr/include/stdio.h /usr/lib/gcc/x86_64-linux-gnu/12/include/stdarg.h \
 /usr/include/x86_64-linux-gnu/bits/types/__fpos_t.h \
 /usr/include/x86_64-linux-gnu/bits/types/__mbstate_t.h \
 /usr/include/x86_64-linux-gnu/bits/types/__fpos64_t.h \
 /usr/include/x86_64-linux-gnu/bits/types/__FILE.h \
 /usr/include/x86_64-linux-gnu/bits/types/FILE.h \
 /usr/include/x86_64-linux-gnu/bits/types/struct_FILE.h \
 /usr/include/x86_64-linux-gnu/bits/stdio_lim.h \
 /usr/include/x86_64-linux-gnu/bits/floatn.h \
 /usr/include/x86_64-linux-gnu/bits/floatn-common.h \
 /usr/include/x86_64-linux-gnu/bits/stdio.h
