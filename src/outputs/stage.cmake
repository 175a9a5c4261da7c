# OpenGL through libepoxy, EGL for a context without a screen, libpng, HDF5 (serial C library), nlohmann-json.
find_package(PkgConfig REQUIRED)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(EGL REQUIRED IMPORTED_TARGET egl)
find_package(PNG REQUIRED)
find_package(nlohmann_json REQUIRED)
# `hdf5` means the MPI build once one is installed, so the serial one is asked for by name.
pkg_check_modules(HDF5_SERIAL REQUIRED IMPORTED_TARGET hdf5-serial)
# EGL gives headers only: libepoxy opens the library itself, so the program starts where there is none.
target_include_directories(loopwright_outputs PRIVATE ${EGL_INCLUDE_DIRS})
# Public where headers or tests of this stage name the library.
target_link_libraries(loopwright_outputs PUBLIC PkgConfig::EPOXY PkgConfig::HDF5_SERIAL PNG::PNG
  PRIVATE $<BUILD_INTERFACE:nlohmann_json::nlohmann_json> ${CMAKE_DL_LIBS})
