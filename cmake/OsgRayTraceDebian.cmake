# The packages for Debian, by CPack, in the folder packages: cmake/packaging/debian.sh makes them. The dependencies
# of binaries are those that dpkg-shlibdeps finds.
# SPDX-License-Identifier: MIT

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME osgraytrace)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGING_INSTALL_PREFIX "${CMAKE_INSTALL_PREFIX}")
set(CPACK_OUTPUT_FILE_PREFIX packages)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(OSGRAYTRACE_MAINTAINER "The osgRayTrace developers <nobody@osgraytrace.invalid>" CACHE STRING
    "Name and address in the packages for Debian, of whoever makes them")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${OSGRAYTRACE_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS # for the libraries of one package that another needs
    "${PROJECT_BINARY_DIR}/lib")
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

# Names a package of a component: osgraytrace_package(<component> <name> <section> <depends> <summary> <text>).
set(CPACK_COMPONENTS_ALL "")
function(osgraytrace_package component name section depends summary text)
    string(TOUPPER "${component}" upper)
    set(CPACK_DEBIAN_${upper}_PACKAGE_NAME "${name}" PARENT_SCOPE)
    set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION "${section}" PARENT_SCOPE)
    set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
    set(CPACK_COMPONENT_${upper}_DEPENDS ${depends} PARENT_SCOPE)
    set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} "${component}" PARENT_SCOPE)

    # Each package says its licence and its changes; nobody but CPack installs these files.
    set(folder "${CMAKE_INSTALL_DATADIR}/doc/${name}")
    install(FILES "${PROJECT_SOURCE_DIR}/cmake/packaging/copyright" DESTINATION "${folder}"
        COMPONENT "${component}" EXCLUDE_FROM_ALL)
    install(FILES "${PROJECT_BINARY_DIR}/changelog.Debian.gz" DESTINATION "${folder}"
        COMPONENT "${component}" EXCLUDE_FROM_ALL)
endfunction()

string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE "${PROJECT_BINARY_DIR}/changelog.Debian" "osgraytrace (${PROJECT_VERSION}-1) unstable; urgency=medium

  * Version ${PROJECT_VERSION}; CHANGELOG.md in osgraytrace-doc says what is new.

 -- ${OSGRAYTRACE_MAINTAINER}  ${date}
")
execute_process(COMMAND gzip -9nf "${PROJECT_BINARY_DIR}/changelog.Debian" ERROR_QUIET)

set(libraryText "osgRayTrace puts an OpenSceneGraph scene below one node and ray traces it on
the CPU: soft shadows, reflections, glass, global illumination and caustics.")
osgraytrace_package(osgRayTrace libosgraytrace${OSGRAYTRACE_SOVERSION} libs ""
    "Ray tracing node kit for OpenSceneGraph (library)" "${libraryText}")
osgraytrace_package(osgRayTraceOffscreen libosgraytraceoffscreen${OSGRAYTRACE_SOVERSION} libs ""
    "OpenGL contexts for OpenSceneGraph without a window" "${libraryText}
This library has OpenGL contexts of OSMesa and EGL for OpenSceneGraph.")
osgraytrace_package(dev libosgraytrace-dev libdevel "osgRayTrace;osgRayTraceOffscreen"
    "Ray tracing node kit for OpenSceneGraph (development)" "${libraryText}
This package has the headers, and files for CMake and pkg-config.")
osgraytrace_package(tools osgraytrace graphics "osgRayTrace;osgRayTraceOffscreen"
    "Ray tracer for OpenSceneGraph models" "${libraryText}
This package has the programs, and plugins by which any OpenSceneGraph
program ray traces (osgviewer cow.osgt.raytrace) and reads glTF, OpenVDB, EXR
and HDR.")
osgraytrace_package(docs osgraytrace-doc doc ""
    "Ray tracing node kit for OpenSceneGraph (documents)" "${libraryText}
This package has the documents, examples and scenes.")
if(OSGRAYTRACE_HAS_ZMQ)
    osgraytrace_package(servers osgraytrace-servers graphics "osgRayTrace"
        "Ray tracer for OpenSceneGraph models (render servers)" "${libraryText}
This package has osgraytrace-server, which traces tiles of viewers' images on
other machines, and the module by which viewers reach such servers.")
endif()
if(OSGRAYTRACE_HAS_PYTHON)
    osgraytrace_package(python python3-osgraytrace python "osgRayTrace"
        "Ray tracer for OpenSceneGraph models (Python 3)" "${libraryText}
This package has a module of Python that renders to numpy arrays.")
endif()

foreach(library OSGRAYTRACE OSGRAYTRACEOFFSCREEN)
    set(CPACK_DEBIAN_${library}_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/packaging/triggers")
endforeach()
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libopenscenegraph-dev, libgl-dev, libosmesa6-dev")
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "openscenegraph, libgl1-mesa-dri")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "osgraytrace-doc, gnuplot-nox, ffmpeg")
set(CPACK_DEBIAN_DOCS_PACKAGE_ARCHITECTURE all)
if(OSGRAYTRACE_HAS_PYTHON) # a module is of one version of Python
    math(EXPR nextMinor "${Python_VERSION_MINOR} + 1")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
        "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${nextMinor}), python3-numpy")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS osgraytrace) # its plugins read glTF, EXR and HDR, and physical materials
endif()
set(OSGRAYTRACE_COMPONENTS ${CPACK_COMPONENTS_ALL}) # for the test
include(CPack)
