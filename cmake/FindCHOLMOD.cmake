# SuiteSparse's CHOLMOD, which has no CMake package on Debian 12, and the LAPACK that its supernodal module needs:
# CHOLMOD_FOUND and the target CHOLMOD::CHOLMOD, with both.
# Used by the build and, installed beside LoopwrightConfig.cmake, by programs that link the static libraries.
find_path(CHOLMOD_INCLUDE cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY cholmod)
find_library(CHOLMOD_LAPACK lapack)
mark_as_advanced(CHOLMOD_INCLUDE CHOLMOD_LIBRARY CHOLMOD_LAPACK)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(CHOLMOD REQUIRED_VARS CHOLMOD_LIBRARY CHOLMOD_LAPACK CHOLMOD_INCLUDE)
if(CHOLMOD_FOUND AND NOT TARGET CHOLMOD::CHOLMOD)
  add_library(CHOLMOD::CHOLMOD UNKNOWN IMPORTED)
  set_target_properties(CHOLMOD::CHOLMOD PROPERTIES
    IMPORTED_LOCATION ${CHOLMOD_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${CHOLMOD_INCLUDE}
    INTERFACE_LINK_LIBRARIES ${CHOLMOD_LAPACK})
endif()
