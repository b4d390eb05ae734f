# Installing: the libraries and headers, a CMake package config, pkg-config files, and the driver with its manifest.
include(CMakePackageConfigHelpers)

install(TARGETS vernier vernier_glsl EXPORT VernierTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/api/include/vernier DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Vernier)
install(EXPORT VernierTargets NAMESPACE Vernier:: DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/VernierConfig.cmake.in
    ${PROJECT_BINARY_DIR}/VernierConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/VernierConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/VernierConfig.cmake ${PROJECT_BINARY_DIR}/VernierConfigVersion.cmake
    DESTINATION ${package_dir})

# Relative, so that the prefix may be given at installation and the installed tree can be moved.
file(RELATIVE_PATH VERNIER_PREFIX_FROM_PC ${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
foreach(library vernier vernier_glsl)
    configure_file(${PROJECT_SOURCE_DIR}/cmake/${library}.pc.in ${PROJECT_BINARY_DIR}/${library}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/${library}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
