# What `loopwright --version` says of the build, told to src/build_facts.cpp alone.
add_custom_target(loopwright_commit
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${CMAKE_SOURCE_DIR} -DFILE=${CMAKE_BINARY_DIR}/generated/commit.cpp
    -P ${CMAKE_SOURCE_DIR}/cmake/write_commit.cmake
  BYPRODUCTS ${CMAKE_BINARY_DIR}/generated/commit.cpp
  COMMENT "" VERBATIM)
add_dependencies(loopwright_pipeline loopwright_commit)
set(build_type ${CMAKE_BUILD_TYPE})
if(LOOPWRIGHT_SANITIZE)
  string(APPEND build_type ", sanitizers ${LOOPWRIGHT_SANITIZE}")
endif()
set_property(SOURCE ${CMAKE_SOURCE_DIR}/src/build_facts.cpp APPEND PROPERTY COMPILE_DEFINITIONS
  LOOPWRIGHT_VERSION="${PROJECT_VERSION}"
  "LOOPWRIGHT_COMPILER=\"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\""
  "LOOPWRIGHT_BUILD_TYPE=\"${build_type}\""
  LOOPWRIGHT_EIGEN_VERSION="${Eigen3_VERSION}"
  LOOPWRIGHT_JSON_VERSION="${nlohmann_json_VERSION}"
  LOOPWRIGHT_EPOXY_VERSION="${EPOXY_VERSION}")
target_sources(loopwright_pipeline PRIVATE ${CMAKE_BINARY_DIR}/generated/commit.cpp)
if(TARGET CHOLMOD::CHOLMOD)
  target_link_libraries(loopwright_pipeline PRIVATE CHOLMOD::CHOLMOD)
  set_property(SOURCE ${CMAKE_SOURCE_DIR}/src/build_facts.cpp APPEND PROPERTY COMPILE_DEFINITIONS
    LOOPWRIGHT_HAS_CHOLMOD)
endif()
