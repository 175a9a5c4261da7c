# One library per stage, linked in the order of the road: a stage sees only stages to its left. Static; shared ones
# with -DBUILD_SHARED_LIBS=ON, as the packages have them.
# base -> notation -> machine -> topology -> geometry -> loop_scale -> mechanics -> dynamics -> experiments -> outputs -> apps
set(LOOPWRIGHT_STAGES base notation machine topology geometry loop_scale mechanics dynamics experiments outputs)
set(stage_to_the_left loopwright_options)
# for_shared_objects(LIBRARY): made so that it can be one, or be linked into the Python module. That functions of ours are
# never replaced at load time lets the compiler go on inlining them (measured: docs/python.md).
function(for_shared_objects library)
  set_target_properties(${library} PROPERTIES POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL "")
  target_compile_options(${library} PRIVATE -fno-semantic-interposition)
endfunction()
foreach(stage IN LISTS LOOPWRIGHT_STAGES)
  file(GLOB_RECURSE stage_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${stage}/*.cpp)
  if(stage_sources)
    add_library(loopwright_${stage} ${stage_sources})
    target_link_libraries(loopwright_${stage} PUBLIC ${stage_to_the_left})
    for_shared_objects(loopwright_${stage})
  else()
    add_library(loopwright_${stage} INTERFACE)
    target_link_libraries(loopwright_${stage} INTERFACE ${stage_to_the_left})
  endif()
  if(EXISTS ${CMAKE_SOURCE_DIR}/src/${stage}/stage.cmake)
    include(${CMAKE_SOURCE_DIR}/src/${stage}/stage.cmake)   # third-party libraries of this stage
  endif()
  set(stage_to_the_left loopwright_${stage})
endforeach()
# the whole road: what lies in src itself
file(GLOB pipeline_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/*.cpp)
add_library(loopwright_pipeline ${pipeline_sources})
target_link_libraries(loopwright_pipeline PUBLIC loopwright_outputs)
for_shared_objects(loopwright_pipeline)
