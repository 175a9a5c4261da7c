# Debian packages by CPack, one for each component of cmake/install.cmake that this build has:
#   cmake --preset package && cmake --build --preset package && cpack --config build-package/CPackConfig.cmake
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME loopwright)
set(CPACK_PACKAGE_CONTACT "Loopwright maintainers <loopwright@example.org>")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# what a package needs of the others is of the very same build
set(same_version "(= ${PROJECT_VERSION})")

configure_file(data/debian/changelog.in ${CMAKE_BINARY_DIR}/generated/changelog @ONLY)
set(changelog ${CMAKE_BINARY_DIR}/generated/changelog.gz)
execute_process(COMMAND gzip -9nc ${CMAKE_BINARY_DIR}/generated/changelog OUTPUT_FILE ${changelog}
  COMMAND_ERROR_IS_FATAL ANY)

# loopwright_package(COMPONENT NAME DESCRIPTION [DEPENDS]): the package of a component.
set(CPACK_COMPONENTS_ALL)
macro(loopwright_package component name description)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION
    "${description}
Loopwright takes a knitting programme, in vermiculation letters or
knitout, and gives back the fabric: every yarn in three dimensions, in
mechanical equilibrium, ready to be looked at and measured.")
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS ${ARGN})
  install(FILES data/debian/copyright ${changelog} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name}
    COMPONENT ${component})
endmacro()

set(library_package)
if(BUILD_SHARED_LIBS)
  set(library_package libloopwright${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  loopwright_package(library ${library_package} "knitting notation to relaxed cloth: libraries")
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/data/debian/triggers)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})
  set(depends_on_library "${library_package} ${same_version}")
endif()
set(needed_by_headers "libhdf5-dev, libepoxy-dev, libpng-dev, pkg-config")
if(BUILD_SHARED_LIBS)
  string(PREPEND needed_by_headers "${depends_on_library}, ")
elseif(TARGET CHOLMOD::CHOLMOD)
  string(APPEND needed_by_headers ", libsuitesparse-dev")
endif()
loopwright_package(development libloopwright-dev "knitting notation to relaxed cloth: headers and CMake package"
  "${needed_by_headers}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
loopwright_package(command loopwright "knitting notation to relaxed cloth: the command" "${depends_on_library}")
# pictures: libepoxy opens library and driver when the first one is drawn
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "libopengl0, libegl1, libegl-mesa0, libgl1-mesa-dri")
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "bash-completion, loopwright-doc")
loopwright_package(documentation loopwright-doc "knitting notation to relaxed cloth: the manual")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SHLIBDEPS OFF)
if(TARGET loopwright-view)
  loopwright_package(application loopwright-view "knitting notation to relaxed cloth: the desktop application"
    "loopwright ${same_version}")
endif()
if(TARGET _loopwright)
  # a compiled module is for one minor version of Python
  execute_process(COMMAND ${LOOPWRIGHT_MODULE_PYTHON} -c [[
import sys
print(f"python3 (>= {sys.version_info[0]}.{sys.version_info[1]}), python3 (<< {sys.version_info[0]}.{sys.version_info[1] + 1})")]]
    OUTPUT_VARIABLE this_python OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  loopwright_package(python python3-loopwright "knitting notation to relaxed cloth: the Python module"
    "${this_python}, python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
    ${CMAKE_SOURCE_DIR}/data/debian/python/postinst ${CMAKE_SOURCE_DIR}/data/debian/python/prerm)
endif()
include(CPack)
