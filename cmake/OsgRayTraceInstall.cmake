# The installed, exported package: find_package(osgRayTrace) gives osgRayTrace::osgRayTrace and
# osgRayTrace::offscreen. The package names no library by its path on the machine that built it:
# OpenSceneGraph is found again on the machine that uses the package.
# SPDX-License-Identifier: MIT
include(CMakePackageConfigHelpers)

set(OSGRAYTRACE_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/osgRayTrace")

foreach(target osgRayTrace osgRayTraceOffscreen)
    install(TARGETS ${target} EXPORT osgRayTraceTargets
        LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT ${target} NAMELINK_COMPONENT dev
        FILE_SET headers DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT dev
        FILE_SET generatedHeaders DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT dev)
endforeach()
install(EXPORT osgRayTraceTargets NAMESPACE osgRayTrace:: DESTINATION "${OSGRAYTRACE_PACKAGE_DIR}" COMPONENT dev)

# The target all_verify_interface_header_sets compiles each public header alone; a test builds it.
set_target_properties(osgRayTrace osgRayTraceOffscreen PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)

configure_package_config_file(
    "${PROJECT_SOURCE_DIR}/cmake/osgRayTraceConfig.cmake.in"
    "${PROJECT_BINARY_DIR}/osgRayTraceConfig.cmake"
    INSTALL_DESTINATION "${OSGRAYTRACE_PACKAGE_DIR}"
    NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/osgRayTraceConfigVersion.cmake"
    COMPATIBILITY SameMinorVersion)
install(FILES
    "${PROJECT_BINARY_DIR}/osgRayTraceConfig.cmake"
    "${PROJECT_BINARY_DIR}/osgRayTraceConfigVersion.cmake"
    "${PROJECT_SOURCE_DIR}/cmake/OsgRayTraceOpenSceneGraph.cmake"
    DESTINATION "${OSGRAYTRACE_PACKAGE_DIR}" COMPONENT dev)

# pkg-config finds the libraries, wherever the folder is moved to.
set(pkgConfigDir "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
file(RELATIVE_PATH prefixFromPkgConfig "/${pkgConfigDir}" "/")
set(osMesaFlags "")
if(OSMesa_LIBRARY)
    set(osMesaFlags "-Wl,--push-state,--no-as-needed -lOSMesa -Wl,--pop-state")
endif()
foreach(name osgRayTrace osgRayTraceOffscreen)
    configure_file("${PROJECT_SOURCE_DIR}/cmake/packaging/${name}.pc.in" "${PROJECT_BINARY_DIR}/${name}.pc" @ONLY)
    install(FILES "${PROJECT_BINARY_DIR}/${name}.pc" DESTINATION "${pkgConfigDir}" COMPONENT dev)
endforeach()

# The commands and links of README.md and of the pages in docs/ work in one folder, OSGRAYTRACE_SHARE_DIR,
# which has pages, pictures, scenes and configurations.
install(FILES LICENSE README.md CHANGELOG.md CONTRIBUTING.md DESTINATION "${OSGRAYTRACE_SHARE_DIR}" COMPONENT docs)
install(FILES osgRayTrace/README.md DESTINATION "${OSGRAYTRACE_SHARE_DIR}/osgRayTrace" COMPONENT docs)
install(DIRECTORY osgRayTrace/docs DESTINATION "${OSGRAYTRACE_SHARE_DIR}/osgRayTrace" COMPONENT docs)
install(FILES tests/README.md DESTINATION "${OSGRAYTRACE_SHARE_DIR}/tests" COMPONENT docs)
install(DIRECTORY apps/examples DESTINATION "${OSGRAYTRACE_SHARE_DIR}/apps" COMPONENT docs
    USE_SOURCE_PERMISSIONS PATTERN build EXCLUDE)
install(DIRECTORY data/ DESTINATION "${OSGRAYTRACE_SHARE_DIR}/data" COMPONENT docs
    PATTERN CMakeLists.txt EXCLUDE PATTERN generator EXCLUDE)
