# The materials of data/materials become part of the library, so that the command needs no files beside it.
file(GLOB material_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/data/materials/*.yarn)
list(SORT material_files)
set(material_entries "")
foreach(material_file IN LISTS material_files)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${material_file})
  file(READ ${material_file} material_text)
  get_filename_component(material_name ${material_file} NAME)
  string(APPEND material_entries "    EmbeddedFile{\"${material_name}\", R\"yarn(${material_text})yarn\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/embedded_materials.cpp @ONLY CONTENT
"// Written by CMake from data/materials.
#include \"notation/embedded_materials.hpp\"

#include <array>

namespace loopwright {
std::span<const EmbeddedFile> embedded_materials() {
  static constexpr std::array files{
@material_entries@  };
  return files;
}
}  // namespace loopwright
")
target_sources(loopwright_notation PRIVATE ${CMAKE_BINARY_DIR}/generated/embedded_materials.cpp)
