# Writes version.cc with the version and the commit, at each build, if they have changed.
#
#   cmake -DRONDO_VERSION=... -DSOURCE=... -DOUTPUT=... -P Version.cmake
set(RONDO_COMMIT "")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} describe --always --abbrev=10 --exclude=* --dirty=+ WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE RONDO_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
configure_file(${SOURCE}/cmake/version.cc.in ${OUTPUT} @ONLY)
