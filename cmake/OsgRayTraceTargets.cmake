# Defines helpers for this project's targets: warnings, sanitizers, OSG plugins.
# SPDX-License-Identifier: MIT

add_library(osgRayTraceWarnings INTERFACE)
target_compile_options(osgRayTraceWarnings INTERFACE
    $<$<CXX_COMPILER_ID:GNU,Clang>:-Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wno-psabi>
    # "&" between comparisons is intended: it keeps loops over lanes free of branches. Clang 14
    # leaves a few of these loops scalar, which is slower, but not wrong.
    $<$<CXX_COMPILER_ID:Clang>:-Wno-bitwise-instead-of-logical -Wno-pass-failed>)

# Each target of the project gets C++17, hidden symbols, warnings and sanitizers by this one. It is
# never installed.
add_library(osgRayTraceBuild INTERFACE)
target_compile_features(osgRayTraceBuild INTERFACE cxx_std_17)
target_link_libraries(osgRayTraceBuild INTERFACE osgRayTraceWarnings)
if(OSGRAYTRACE_SANITIZE STREQUAL "address")
    target_compile_options(osgRayTraceBuild INTERFACE
        -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(osgRayTraceBuild INTERFACE -fsanitize=address,undefined)
elseif(OSGRAYTRACE_SANITIZE STREQUAL "thread")
    target_compile_options(osgRayTraceBuild INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
    target_link_options(osgRayTraceBuild INTERFACE -fsanitize=thread)
elseif(NOT OSGRAYTRACE_SANITIZE STREQUAL "")
    message(FATAL_ERROR "OSGRAYTRACE_SANITIZE is 'address', 'thread' or empty, not '${OSGRAYTRACE_SANITIZE}'")
endif()
if(OSGRAYTRACE_SANITIZE)
    # Sanitized code cannot run in the resolvers of function clones, which the loader calls first.
    target_compile_definitions(osgRayTraceBuild INTERFACE OSGRAYTRACE_NO_CLONES)
    # Sanitized programs are built far more often than they run: what is not optimized compiles in half of the time.
    # The engine and its tests, which take most of the time of the tests, ask for -O1: -O3 compiles for twice as long, and
    # the tests are no faster. A sanitizer names functions and lines, for which -g1 is enough.
    set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O0 -g1 -DNDEBUG")
endif()
# Debug and sanitized builds check assertions; others only if they are asked to.
target_compile_definitions(osgRayTraceBuild INTERFACE
    $<$<OR:$<CONFIG:Debug>,$<BOOL:${OSGRAYTRACE_SANITIZE}>,$<BOOL:${OSGRAYTRACE_ASSERTS}>>:OSGRAYTRACE_ASSERTS>)

set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/lib")
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/bin")

# Versions 0.x with another x are other libraries to the loader, as they are to find_package.
set(OSGRAYTRACE_SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

# What is installed belongs to the package of the programs and plugins, unless an install says otherwise.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME tools)

# OSG looks for plugins in <library path>/osgPlugins-<version>.
set(OSGRAYTRACE_PLUGIN_DIR "osgPlugins-${OPENSCENEGRAPH_VERSION}")

# These headers cost a compiler more than the files that include them. Each is read once for all targets that share
# it. Each file still includes what it uses: CMAKE_DISABLE_PRECOMPILE_HEADERS=ON compiles without these.
set(OSGRAYTRACE_PRECOMPILED_ENGINE
    <algorithm> <cmath> <functional> <map> <memory> <optional> <random> <string> <unordered_map> <vector>
    <glm/gtc/matrix_transform.hpp>)
set(OSGRAYTRACE_PRECOMPILED_OSG
    <osg/Billboard> <osg/CullStack> <osg/Geometry> <osg/LightSource> <osg/Material> <osg/MatrixTransform>
    <osg/Texture2D>)
set(OSGRAYTRACE_PRECOMPILED_VIEWER <osg/ShapeDrawable> <osgUtil/CullVisitor> <osgViewer/Viewer>)

# osgraytrace_precompile(<target> [AS <owner>] [HEADERS ...]) gives a target precompiled headers: its own, or
# those of an owner whose compile flags are the same.
function(osgraytrace_precompile target)
    cmake_parse_arguments(PRECOMPILED "" "AS" "HEADERS" ${ARGN})
    if(PRECOMPILED_AS)
        target_precompile_headers(${target} REUSE_FROM ${PRECOMPILED_AS})
    else()
        target_precompile_headers(${target} PRIVATE ${PRECOMPILED_HEADERS})
    endif()
    # The flag lets ccache know the headers of a preprocessed file.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endfunction()

# If the libraries are installed into the folder of OSG's own, as by a distribution's package, plugins that OSG has, too,
# must not replace them: these are in the folder osgRayTrace there (osgPlugins/OwnFolder.h prefers it).
set(OSGRAYTRACE_APART_DIR "")
if(OSGRAYTRACE_OSG)
    cmake_path(GET OSG_LIBRARY PARENT_PATH folderOfOsg)
endif()
if(OSGRAYTRACE_OSG AND folderOfOsg STREQUAL CMAKE_INSTALL_FULL_LIBDIR)
    set(OSGRAYTRACE_APART_DIR "osgRayTrace/")
endif()

# osgraytrace_add_plugin(<target> [ALSO_IN_OSG] SOURCES ... LIBRARIES ...) adds a module that OSG finds by its
# name. ALSO_IN_OSG: OSG may have a plugin of the same name.
function(osgraytrace_add_plugin target)
    cmake_parse_arguments(PLUGIN "ALSO_IN_OSG" "" "SOURCES;LIBRARIES" ${ARGN})
    set(apart "")
    set(up "")
    if(PLUGIN_ALSO_IN_OSG AND OSGRAYTRACE_APART_DIR)
        set(apart "${OSGRAYTRACE_APART_DIR}")
        set(up "/..")
    endif()
    add_library(${target} MODULE ${PLUGIN_SOURCES})
    target_link_libraries(${target} PRIVATE ${PLUGIN_LIBRARIES} osgRayTraceBuild)
    set_target_properties(${target} PROPERTIES
        PREFIX ""
        LIBRARY_OUTPUT_DIRECTORY "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/${OSGRAYTRACE_PLUGIN_DIR}"
        INSTALL_RPATH "\$ORIGIN/..${up}"
        BUILD_RPATH_USE_ORIGIN ON)
    install(TARGETS ${target} LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/${apart}${OSGRAYTRACE_PLUGIN_DIR}")
endfunction()
