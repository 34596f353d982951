# `cmake --install`: the program, models, examples and documents, and a package that finds them.
#
#   find_package(rondo REQUIRED)     # rondo::rondo is the program; rondo::adapter has the header of adapters of one's own;
#                                    # rondo::program those of programs that `rondo build` makes; rondo_MODELS and rondo_EXAMPLES are folders
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # whoever installs has built what is wanted
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(data ${CMAKE_INSTALL_DATADIR}/rondo)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/rondo)
# Three components, each a package of its own (cmake/Package.cmake): the program, what is compiled against, documents.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME rondo)
install(TARGETS rondo EXPORT rondo-targets RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS rondo_adapter_header rondo_program_headers EXPORT rondo-targets)
install(FILES src/adapter/adapter.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rondo COMPONENT dev)
install(DIRECTORY src/program DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rondo COMPONENT dev FILES_MATCHING PATTERN "*.h")
install(DIRECTORY models examples DESTINATION ${data})
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc
  FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN "*.png" PATTERN "schema/*.json")
install(EXPORT rondo-targets NAMESPACE rondo:: DESTINATION ${package} COMPONENT dev)
configure_package_config_file(cmake/rondoConfig.cmake.in ${CMAKE_BINARY_DIR}/rondoConfig.cmake INSTALL_DESTINATION ${package}
  PATH_VARS data)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/rondoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/rondoConfig.cmake ${CMAKE_BINARY_DIR}/rondoConfigVersion.cmake DESTINATION ${package} COMPONENT dev)

# What the program says of itself: manual pages, and completion for three shells.
install(CODE "
  set(speaker $<TARGET_FILE:rondo>)  # not `rondo`: that is a component
  set(share \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR})
  execute_process(COMMAND \${speaker} help --pages \${share}/man/man1 COMMAND_ERROR_IS_FATAL ANY)
  foreach(file bash:bash-completion/completions/rondo zsh:zsh/site-functions/_rondo fish:fish/vendor_completions.d/rondo.fish)
    string(REGEX MATCH \"^[a-z]+\" shell \${file})
    string(REGEX REPLACE \"^[a-z]+:\" \"\" path \${file})
    execute_process(COMMAND \${speaker} completion \${shell} OUTPUT_VARIABLE script COMMAND_ERROR_IS_FATAL ANY)
    file(WRITE \${share}/\${path} \"\${script}\")
  endforeach()" COMPONENT rondo)
include(cmake/Package.cmake)
