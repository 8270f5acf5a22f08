# Writes OUTPUT, a header that holds the git commit of SOURCE; leaves it alone when the commit is the one it holds, so
# that nothing is rebuilt. Run at every build: cmake -D SOURCE=... -D OUTPUT=... -P write_commit.cmake
set(commit unknown)
if(EXISTS "${SOURCE}/.git") # else sources unpacked inside someone's repository would name that repository's commit
  execute_process(COMMAND git --no-optional-locks describe --always --dirty --abbrev=40 "--exclude=*" WORKING_DIRECTORY "${SOURCE}"
    OUTPUT_VARIABLE described RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed AND described)
    set(commit "${described}")
  endif()
else() # the archive of a release: git archive has put its commit here
  file(STRINGS "${SOURCE}/cmake/commit.txt" archived LIMIT_COUNT 1)
  if(archived MATCHES "^[0-9a-f]+$")
    set(commit "${archived}")
  endif()
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT [[
#pragma once

namespace keeler::build_info {

inline constexpr char commit[] = "@commit@";

} // namespace keeler::build_info
]])
