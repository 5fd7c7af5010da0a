# Finds the libraries that the project builds on. OpenSceneGraph gets imported targets here
# (osgRayTrace::OSG), once, because CMake's own FindOpenSceneGraph defines none; the wrapper is
# installed for consumers as well.
# SPDX-License-Identifier: MIT
if(OSGRAYTRACE_OSG)
    include(OsgRayTraceOpenSceneGraph)
    find_package(nlohmann_json REQUIRED CONFIG)
endif()

# Embree 4 is taken before Embree 3; embree_ROOT names the folder of one that the system does not have. Both may be
# installed, so the headers to include are told.
find_package(embree 4 QUIET CONFIG)
if(NOT embree_FOUND)
    find_package(embree 3.12 REQUIRED CONFIG)
endif()
message(STATUS "Embree: version ${embree_VERSION}")
add_library(osgRayTraceEmbree INTERFACE)
target_link_libraries(osgRayTraceEmbree INTERFACE embree)
target_compile_definitions(osgRayTraceEmbree INTERFACE OSGRAYTRACE_EMBREE=${embree_VERSION_MAJOR})
find_package(TBB REQUIRED CONFIG)
find_package(glm REQUIRED CONFIG)
find_package(Threads REQUIRED)

# Open Image Denoise is optional (OSGRAYTRACE_HAS_OIDN). Its package accepts only a version of the
# same major number.
set(OSGRAYTRACE_HAS_OIDN FALSE)
if(NOT OSGRAYTRACE_OIDN)
    message(STATUS "Open Image Denoise: left out, OSGRAYTRACE_OIDN is off")
else()
    find_package(OpenImageDenoise QUIET CONFIG)
    if(NOT OpenImageDenoise_FOUND)
        message(STATUS "Open Image Denoise: left out, it is not found (OpenImageDenoise_DIR)")
    elseif(OpenImageDenoise_VERSION VERSION_LESS 1.4 OR OpenImageDenoise_VERSION VERSION_GREATER_EQUAL 3)
        message(STATUS "Open Image Denoise: left out, version ${OpenImageDenoise_VERSION} is not 1.4 to 2")
    else()
        message(STATUS "Open Image Denoise: built in, version ${OpenImageDenoise_VERSION}")
        set(OSGRAYTRACE_HAS_OIDN TRUE)
    endif()
endif()

if(NOT OSGRAYTRACE_OSG)
    return()
endif()

# MPI is optional (OSGRAYTRACE_HAS_MPI), and osgraytrace alone links it. Its interface for C is enough.
set(OSGRAYTRACE_HAS_MPI FALSE)
if(OSGRAYTRACE_MPI)
    set(MPI_CXX_SKIP_MPICXX TRUE)
    find_package(MPI 3.0 QUIET COMPONENTS CXX)
    set(OSGRAYTRACE_HAS_MPI ${MPI_CXX_FOUND})
endif()
if(OSGRAYTRACE_HAS_MPI)
    message(STATUS "MPI: built in, version ${MPI_CXX_VERSION}")
else()
    message(STATUS "MPI: left out, off or not found (OSGRAYTRACE_MPI)")
endif()

# ZeroMQ is optional (OSGRAYTRACE_HAS_ZMQ): a module that the library loads for the setting servers, and
# osgraytrace-server, are linked to it.
set(OSGRAYTRACE_HAS_ZMQ FALSE)
if(OSGRAYTRACE_ZMQ)
    find_path(OSGRAYTRACE_ZMQ_INCLUDE zmq.h)
    find_library(OSGRAYTRACE_ZMQ_LIBRARY zmq)
    mark_as_advanced(OSGRAYTRACE_ZMQ_INCLUDE OSGRAYTRACE_ZMQ_LIBRARY)
    if(OSGRAYTRACE_ZMQ_INCLUDE AND OSGRAYTRACE_ZMQ_LIBRARY)
        set(OSGRAYTRACE_HAS_ZMQ TRUE)
        add_library(osgRayTrace::Zmq UNKNOWN IMPORTED GLOBAL)
        set_target_properties(osgRayTrace::Zmq PROPERTIES IMPORTED_LOCATION "${OSGRAYTRACE_ZMQ_LIBRARY}"
            INTERFACE_INCLUDE_DIRECTORIES "${OSGRAYTRACE_ZMQ_INCLUDE}")
    endif()
endif()
if(OSGRAYTRACE_HAS_ZMQ)
    message(STATUS "ZeroMQ: render servers are built")
else()
    message(STATUS "ZeroMQ: render servers are left out, off or not found (OSGRAYTRACE_ZMQ)")
endif()

include(OsgRayTraceGltfLibraries)
include(OsgRayTraceVdbLibraries)
