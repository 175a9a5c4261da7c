# `cmake --install`: libraries, headers, a CMake package, the command with its manual page, and what a desktop wants
# to know. Each file belongs to a component, and cmake/packages.cmake makes a Debian package of each.
#   library       shared libraries of the stages, with -DBUILD_SHARED_LIBS=ON
#   development   headers, static libraries or the links to the shared ones, the CMake package Loopwright
#   command       loopwright, its manual page, shell completions, MIME types, examples
#   documentation the pages of docs
#   application   the desktop application, if it is built (apps/view); menu entry, icon
#   python        the Python module, if it is built (python/CMakeLists.txt)
include(CMakePackageConfigHelpers)

set(installed_targets loopwright_options)
foreach(stage IN LISTS LOOPWRIGHT_STAGES ITEMS pipeline)
  list(APPEND installed_targets loopwright_${stage})
  # libloopwright_machine.so.0.1: until version 1 every minor version may change the interface
  set_target_properties(loopwright_${stage} PROPERTIES
    EXPORT_NAME ${stage} VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  add_library(Loopwright::${stage} ALIAS loopwright_${stage})
endforeach()
set_target_properties(loopwright_options PROPERTIES EXPORT_NAME options)
install(TARGETS ${installed_targets} EXPORT LoopwrightTargets
  LIBRARY COMPONENT library NAMELINK_COMPONENT development
  ARCHIVE COMPONENT development)
install(DIRECTORY src/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/loopwright COMPONENT development
  FILES_MATCHING PATTERN "*.hpp")

# The CMake package: find_package(Loopwright) gives the targets Loopwright::notation ... Loopwright::pipeline.
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Loopwright)
install(EXPORT LoopwrightTargets NAMESPACE Loopwright:: DESTINATION ${package_folder} COMPONENT development)
set(LOOPWRIGHT_LINKS_CHOLMOD OFF)
if(TARGET CHOLMOD::CHOLMOD AND NOT BUILD_SHARED_LIBS)
  set(LOOPWRIGHT_LINKS_CHOLMOD ON)
endif()
configure_package_config_file(cmake/LoopwrightConfig.cmake.in ${CMAKE_BINARY_DIR}/generated/LoopwrightConfig.cmake
  INSTALL_DESTINATION ${package_folder} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/generated/LoopwrightConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/generated/LoopwrightConfig.cmake
  ${CMAKE_BINARY_DIR}/generated/LoopwrightConfigVersion.cmake cmake/FindCHOLMOD.cmake
  DESTINATION ${package_folder} COMPONENT development)

# The command, and what it says of itself: manual page and completions are printed by the command that was built.
set(man_page ${CMAKE_BINARY_DIR}/generated/loopwright.1.gz)
set(completion_folder ${CMAKE_BINARY_DIR}/generated/completion)
add_custom_command(OUTPUT ${man_page} ${completion_folder}/bash ${completion_folder}/zsh ${completion_folder}/fish
  COMMAND ${CMAKE_COMMAND} -E make_directory ${completion_folder}
  COMMAND loopwright manual -o ${CMAKE_BINARY_DIR}/generated/loopwright.1
  COMMAND gzip -9nf ${CMAKE_BINARY_DIR}/generated/loopwright.1
  COMMAND loopwright completion bash -o ${completion_folder}/bash
  COMMAND loopwright completion zsh -o ${completion_folder}/zsh
  COMMAND loopwright completion fish -o ${completion_folder}/fish
  DEPENDS loopwright COMMENT "Manual page and shell completions" VERBATIM)
add_custom_target(loopwright_manual ALL DEPENDS ${man_page})
install(TARGETS loopwright COMPONENT command)
install(FILES ${man_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT command)
install(FILES ${completion_folder}/bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME loopwright COMPONENT command)
install(FILES ${completion_folder}/zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions
  RENAME _loopwright COMPONENT command)
install(FILES ${completion_folder}/fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
  RENAME loopwright.fish COMPONENT command)
install(FILES data/desktop/loopwright-mime.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages
  RENAME loopwright.xml COMPONENT command)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT command)
install(FILES README.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT command)
# pages of the manual link to pages elsewhere in the source: bench, studies, GLOSSARY.md
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/manual COMPONENT documentation)

# What a desktop needs to find the application.
if(TARGET loopwright-view)
  install(FILES data/desktop/loopwright-view.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT application)
  install(FILES data/desktop/loopwright.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps
    COMPONENT application)
endif()
