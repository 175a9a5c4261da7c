# What every target of the project is built with, as one interface target.
find_program(LOOPWRIGHT_CCACHE ccache)
if(LOOPWRIGHT_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${LOOPWRIGHT_CCACHE})
endif()
find_package(Threads REQUIRED)
# These are for our own sources only: programs that use the installed libraries choose their own warnings.
add_library(loopwright_flags INTERFACE)
target_compile_options(loopwright_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-align -Wunused
  -Woverloaded-virtual -Wnull-dereference
  # errno and trapping are never looked at; NaN and infinity keep their meaning (no -ffast-math)
  -fno-math-errno -fno-trapping-math
  # one rounding per operation on every compiler: results do not depend on fused multiply-add
  -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ 12 warns wrongly at "text" + std::string (GCC bug 105651)
  target_compile_options(loopwright_flags INTERFACE -Wno-restrict)
endif()
if(LOOPWRIGHT_WERROR)
  target_compile_options(loopwright_flags INTERFACE -Werror)
endif()
if(LOOPWRIGHT_SANITIZE)
  target_compile_options(loopwright_flags INTERFACE
    -fsanitize=${LOOPWRIGHT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(loopwright_flags INTERFACE -fsanitize=${LOOPWRIGHT_SANITIZE})
endif()

# Headers are named from src/ here and from include/loopwright where they are installed: "stage/file.hpp" in both.
add_library(loopwright_options INTERFACE)
target_include_directories(loopwright_options INTERFACE
  $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/loopwright>)
target_compile_features(loopwright_options INTERFACE cxx_std_20)
target_link_libraries(loopwright_options INTERFACE Threads::Threads $<BUILD_INTERFACE:loopwright_flags>)
