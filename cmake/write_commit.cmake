# Run at every build: writes the commit that is built into a source file, and only if it has changed.
#   cmake -DSOURCE=<source folder> -DFILE=<file> -P write_commit.cmake
# "unknown" where there is neither a repository nor an archive made by `git archive`.
set(commit unknown)
# a folder inside a repository of others has no .git of its own
set(failed TRUE)
if(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
    OUTPUT_VARIABLE found RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
if(NOT failed)
  set(commit ${found})
  execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no
    OUTPUT_VARIABLE changed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(changed)
    string(APPEND commit " with changes")
  endif()
else()
  # git fills this file in when it makes an archive (.gitattributes)
  file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/archived_commit.txt archived LIMIT_COUNT 1)
  if(archived MATCHES "^[0-9a-f]+$")
    set(commit ${archived})
  endif()
endif()
set(text "// Written by cmake/write_commit.cmake.
namespace loopwright {
const char* built_commit() { return \"${commit}\"; }
}  // namespace loopwright
")
set(old "")
if(EXISTS ${FILE})
  file(READ ${FILE} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${FILE} "${text}")
endif()
