# overfly_compile_with_clang()
#
# Lets clang compile the calling folder and those below it, if it is installed and the project's compiler is
# GCC: without optimisation it takes half to two thirds of GCC's time. Both use the same standard library and
# C++ ABI, and GCC links. CMake has one compiler per language and project, so that this replaces the rules
# that CMake reads from variables of the folder. Sanitized programs keep the project's compiler, because the two
# compilers have different sanitizer libraries.
macro(overfly_compile_with_clang)
  find_program(OVERFLY_CLANG clang++)
  if(OVERFLY_CLANG AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT OVERFLY_SANITIZE)
    # Asked each time: clang may have been removed, and it looks for GCC's standard library by itself, of which
    # it may find a version without headers.
    file(WRITE ${CMAKE_BINARY_DIR}/clang_works.cpp "#include <ranges>\n#include <span>\n#include <vector>\n")
    execute_process(COMMAND ${OVERFLY_CLANG} -std=c++20 -fsyntax-only ${CMAKE_BINARY_DIR}/clang_works.cpp
                    RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(failed)
      message(STATUS "${OVERFLY_CLANG} does not work with the standard library; GCC compiles the tests")
    else()
      set(CMAKE_CXX_COMPILER_ID Clang)
      set(CMAKE_CXX_COMPILE_OBJECT "${OVERFLY_CLANG} <DEFINES> <INCLUDES> <FLAGS> -o <OBJECT> -c <SOURCE>")
      # As in CMake's own Compiler/Clang.cmake.
      set(CMAKE_PCH_EXTENSION .pch)
      set(CMAKE_PCH_PROLOGUE "#pragma clang system_header")
      set(CMAKE_CXX_COMPILE_OPTIONS_INSTANTIATE_TEMPLATES_PCH -fpch-instantiate-templates)
      set(CMAKE_CXX_COMPILE_OPTIONS_USE_PCH
          -Xclang -include-pch -Xclang <PCH_FILE> -Xclang -include -Xclang <PCH_HEADER>)
      # Without times: an upgraded package has headers of another time, but older than the precompiled ones, and
      # ccache returns headers that were precompiled from equal files of another time. Clang refuses both.
      set(CMAKE_CXX_COMPILE_OPTIONS_CREATE_PCH
          -Xclang -emit-pch -Xclang -fno-pch-timestamp -Xclang -include -Xclang <PCH_HEADER> -x c++-header)
    endif()
  endif()
endmacro()
