# SPDX-License-Identifier: LGPL-2.1-or-later
# Run at every build: writes the git revision to the header FILE if it is
# another one. Needs SOURCE_DIR and, optionally, GIT.
set(REVISION "unknown")
# A tree inside another repository must not take over that one's revision.
if(GIT AND EXISTS ${SOURCE_DIR}/.git)
  execute_process(COMMAND ${GIT} describe --always --dirty
    WORKING_DIRECTORY ${SOURCE_DIR}
    OUTPUT_VARIABLE FOUND OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(FOUND)
    set(REVISION ${FOUND})
  endif()
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT "#define DEBOND_REVISION \"${REVISION}\"\n")
