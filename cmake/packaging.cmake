# What `cmake --install` and CPack put where. Two components: tools (programs, manual pages,
# completion, schemas, samples) and development (headers, static libraries, pkg-config and CMake
# files).
include(CMakePackageConfigHelpers)

set(modules base geometry io collision body pattern cloth garment render)
set(targets sloper_options)
foreach(module ${modules})
  list(APPEND targets sloper_${module})
endforeach()
install(TARGETS ${targets} EXPORT sloper ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/sloper COMPONENT development)
foreach(module ${modules})
  install(DIRECTORY include/sloper/${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sloper COMPONENT development FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(EXPORT sloper NAMESPACE sloper:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sloper COMPONENT development)
configure_package_config_file(cmake/sloperConfig.cmake.in ${PROJECT_BINARY_DIR}/sloperConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sloper)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sloperConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sloperConfig.cmake ${PROJECT_BINARY_DIR}/sloperConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sloper COMPONENT development)
if(TARGET PkgConfig::OSMESA)
  string(APPEND SLOPER_PC_CONTEXTS " osmesa")
endif()
if(TARGET PkgConfig::EGL)
  string(APPEND SLOPER_PC_CONTEXTS " egl")
endif()
file(RELATIVE_PATH SLOPER_PC_UP /p/${CMAKE_INSTALL_LIBDIR}/pkgconfig /p) # the prefix as seen from there: what is installed can be moved
configure_file(cmake/sloper.pc.in ${PROJECT_BINARY_DIR}/sloper.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/sloper.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

file(GLOB_RECURSE schemas CONFIGURE_DEPENDS lib/*.schema.json)
install(FILES ${schemas} DESTINATION ${CMAKE_INSTALL_DATADIR}/sloper/schemas)
install(FILES README.md CHANGELOG.md CITATION.cff CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN "*.png")
# Pages that these link to (tests/packaging/try-library follows the links).
install(FILES lib/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/lib)
install(FILES tests/validation/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/tests/validation)
install(DIRECTORY samples DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "README.md" PATTERN "Snakefile")
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(DIRECTORY samples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/sloper/samples USE_SOURCE_PERMISSIONS
  PATTERN generator EXCLUDE PATTERN library EXCLUDE PATTERN "*.cpp" EXCLUDE PATTERN CMakeLists.txt EXCLUDE)
install(DIRECTORY samples/library DESTINATION ${CMAKE_INSTALL_DATADIR}/sloper/samples)
install(DIRECTORY scripts/batch DESTINATION ${CMAKE_INSTALL_LIBDIR}/sloper FILES_MATCHING PATTERN "*.py") # of retarget-batch
# Scripts stand beside what they import, and have a link in bin/.
file(RELATIVE_PATH SLOPER_SCRIPTS /p/${CMAKE_INSTALL_BINDIR} /p/${CMAKE_INSTALL_LIBDIR}/sloper)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/links)
foreach(script compare-drape retarget-batch)
  install(PROGRAMS scripts/${script} DESTINATION ${CMAKE_INSTALL_LIBDIR}/sloper)
  file(CREATE_LINK ${SLOPER_SCRIPTS}/${script} ${PROJECT_BINARY_DIR}/links/${script} SYMBOLIC)
  install(FILES ${PROJECT_BINARY_DIR}/links/${script} DESTINATION ${CMAKE_INSTALL_BINDIR})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sloper)
set(CPACK_PACKAGE_CONTACT "The Sloper developers <sloper@localhost>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL tools development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME sloper)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS "fonts-dejavu-core") # the rest is found by dpkg-shlibdeps
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "python3, make")
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "Dresses scanned people\n From a raw body scan and a sewing pattern to a draped garment, on other people too, and to pictures,\n without a display.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsloper-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libeigen3-dev, nlohmann-json3-dev, libassimp-dev, libmeshoptimizer-dev, libpng-dev, zlib1g-dev, libssl-dev, libgeos-dev, libosmesa6-dev, libegl-dev, libfreetype-dev, libtbb-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers and static libraries of Sloper\n One library for each module, with pkg-config and CMake files.")
include(CPack)
