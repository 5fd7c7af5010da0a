# Finds the libraries that the reader of glTF can do without: OSGRAYTRACE_HAS_DRACO, OSGRAYTRACE_HAS_MESHOPT
# and OSGRAYTRACE_HAS_WEBP say which are there.
# SPDX-License-Identifier: MIT
set(OSGRAYTRACE_HAS_DRACO FALSE)
if(OSGRAYTRACE_DRACO)
    find_package(draco QUIET CONFIG)
    if(TARGET draco::draco)
        set(OSGRAYTRACE_HAS_DRACO TRUE)
    endif()
endif()

set(OSGRAYTRACE_HAS_MESHOPT FALSE)
if(OSGRAYTRACE_MESHOPT)
    find_package(meshoptimizer QUIET CONFIG)
    if(TARGET meshoptimizer::meshoptimizer)
        set(OSGRAYTRACE_HAS_MESHOPT TRUE)
    endif()
endif()

# Debian's libwebp has no package for CMake.
set(OSGRAYTRACE_HAS_WEBP FALSE)
if(OSGRAYTRACE_WEBP)
    find_path(OSGRAYTRACE_WEBP_INCLUDE_DIR webp/decode.h)
    find_library(OSGRAYTRACE_WEBP_LIBRARY webp)
    mark_as_advanced(OSGRAYTRACE_WEBP_INCLUDE_DIR OSGRAYTRACE_WEBP_LIBRARY)
    if(OSGRAYTRACE_WEBP_INCLUDE_DIR AND OSGRAYTRACE_WEBP_LIBRARY)
        set(OSGRAYTRACE_HAS_WEBP TRUE)
        add_library(osgRayTrace::WebP UNKNOWN IMPORTED)
        set_target_properties(osgRayTrace::WebP PROPERTIES
            IMPORTED_LOCATION "${OSGRAYTRACE_WEBP_LIBRARY}"
            INTERFACE_INCLUDE_DIRECTORIES "${OSGRAYTRACE_WEBP_INCLUDE_DIR}")
    endif()
endif()

foreach(library DRACO MESHOPT WEBP)
    if(OSGRAYTRACE_HAS_${library})
        message(STATUS "glTF: ${library} is built in")
    else()
        message(STATUS "glTF: ${library} is left out, off or not found (OSGRAYTRACE_${library})")
    endif()
endforeach()
