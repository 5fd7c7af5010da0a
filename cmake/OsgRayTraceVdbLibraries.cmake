# Finds what the reader of OpenVDB's files needs: OSGRAYTRACE_HAS_VDB says whether zlib is there, and
# OSGRAYTRACE_HAS_BLOSC whether blosc is. OpenVDB itself is for tests alone, which write files by it:
# OSGRAYTRACE_HAS_OPENVDB.
# SPDX-License-Identifier: MIT
set(OSGRAYTRACE_HAS_VDB FALSE)
set(OSGRAYTRACE_HAS_BLOSC FALSE)
set(OSGRAYTRACE_HAS_OPENVDB FALSE)
if(OSGRAYTRACE_VDB)
    find_package(ZLIB QUIET)
    set(OSGRAYTRACE_HAS_VDB ${ZLIB_FOUND})
endif()
if(NOT OSGRAYTRACE_HAS_VDB)
    message(STATUS "OpenVDB files: left out, off or zlib is not found (OSGRAYTRACE_VDB)")
    return()
endif()

# A blosc that is too old to check lengths is none.
find_path(OSGRAYTRACE_BLOSC_INCLUDE_DIR blosc.h)
find_library(OSGRAYTRACE_BLOSC_LIBRARY blosc)
mark_as_advanced(OSGRAYTRACE_BLOSC_INCLUDE_DIR OSGRAYTRACE_BLOSC_LIBRARY)
if(OSGRAYTRACE_BLOSC AND OSGRAYTRACE_BLOSC_INCLUDE_DIR AND OSGRAYTRACE_BLOSC_LIBRARY)
    file(STRINGS "${OSGRAYTRACE_BLOSC_INCLUDE_DIR}/blosc.h" check REGEX "blosc_cbuffer_validate")
    if(check)
        set(OSGRAYTRACE_HAS_BLOSC TRUE)
        add_library(osgRayTrace::Blosc UNKNOWN IMPORTED)
        set_target_properties(osgRayTrace::Blosc PROPERTIES
            IMPORTED_LOCATION "${OSGRAYTRACE_BLOSC_LIBRARY}"
            INTERFACE_INCLUDE_DIRECTORIES "${OSGRAYTRACE_BLOSC_INCLUDE_DIR}")
    endif()
endif()
if(OSGRAYTRACE_HAS_BLOSC)
    message(STATUS "OpenVDB files: read, with blosc")
else()
    message(STATUS "OpenVDB files: read, but those compressed by blosc, off or not found (OSGRAYTRACE_BLOSC)")
endif()

if(OSGRAYTRACE_BUILD_TESTS)
    find_path(OSGRAYTRACE_OPENVDB_INCLUDE_DIR openvdb/openvdb.h)
    find_path(OSGRAYTRACE_BOOST_INCLUDE_DIR boost/version.hpp) # OpenVDB's headers include it
    find_library(OSGRAYTRACE_OPENVDB_LIBRARY openvdb)
    mark_as_advanced(OSGRAYTRACE_OPENVDB_INCLUDE_DIR OSGRAYTRACE_BOOST_INCLUDE_DIR OSGRAYTRACE_OPENVDB_LIBRARY)
    if(OSGRAYTRACE_OPENVDB_INCLUDE_DIR AND OSGRAYTRACE_BOOST_INCLUDE_DIR AND OSGRAYTRACE_OPENVDB_LIBRARY)
        set(OSGRAYTRACE_HAS_OPENVDB TRUE)
    endif()
endif()
