# Packages for Debian: `./dev package`. `rondo` is the program with models, examples, manual pages and completion; `librondo-dev` what
# adapters and programs as C++ are compiled against; `rondo-doc` the documents.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "Rondo")
set(CPACK_PACKAGE_CONTACT "Rondo developers <rondo@users.noreply.github.com>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "program, prove, simulate and run teams of robots")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL rondo dev doc)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RONDO_PACKAGE_NAME rondo)
set(CPACK_DEBIAN_RONDO_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RONDO_PACKAGE_SUGGESTS "rondo-doc, librondo-dev, xdg-utils")
set(CPACK_COMPONENT_RONDO_DESCRIPTION "Rondo checks, proves, explores, simulates and runs coordination programs for
teams of robots (Koord), and choreographies of messages and motions.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME librondo-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "rondo (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_DEV_DESCRIPTION "What sensors and actuators of one's own, and C++ that rondo build makes, are
compiled against, with a package for CMake.")
set(CPACK_DEBIAN_DOC_PACKAGE_NAME rondo-doc)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_COMPONENT_DOC_DESCRIPTION "Languages, tutorials, theory, decisions, and the schema of JSON.")

# What Debian wants of each package: who may do what with it, and what changed.
string(CONCAT copyright
  "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: Rondo\n\nFiles: *\n"
  "Copyright: 2026 Rondo developers\nLicense: Apache-2.0\n\nLicense: Apache-2.0\n On Debian systems, the full text of the Apache License 2.0 is in\n"
  " /usr/share/common-licenses/Apache-2.0.\n")
file(WRITE ${CMAKE_BINARY_DIR}/package/copyright "${copyright}")
foreach(one IN ITEMS rondo:rondo dev:librondo-dev doc:rondo-doc)
  string(REPLACE ":" ";" one ${one})
  list(GET one 0 component)
  list(GET one 1 name)
  install(FILES ${CMAKE_BINARY_DIR}/package/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
  install(CODE "
    if(DEFINED ENV{DESTDIR})
      file(COPY_FILE ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${CMAKE_BINARY_DIR}/package/changelog)
      set(folder \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/doc/${name})
      file(MAKE_DIRECTORY \${folder})
      execute_process(COMMAND gzip -9nc ${CMAKE_BINARY_DIR}/package/changelog OUTPUT_FILE \${folder}/changelog.gz COMMAND_ERROR_IS_FATAL ANY)
    endif()" COMPONENT ${component})
endforeach()
install(CODE "
  if(DEFINED ENV{DESTDIR})
    file(GLOB pages \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/man/man1/*.1)
    execute_process(COMMAND gzip -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)
  endif()" COMPONENT rondo)
include(CPack)
