# Checks that each include points to its own layer or to one left of it, and these rules:
#   base < sampling < film < scene < shading < media < accel < photons < integrators < session < servers
#        < bridge < API < offscreen < osgPlugins < apps
#   - inside three layers, folders have an order, too; "" stands for files of the layer itself:
#       bridge: common < geometry < appearance/textures < appearance/lights < appearance/materials
#               < graph < changes < pick < convert < update < view
#       session: image < denoise < upsample < "" < history < view
#       integrators: shared < whitted, path, debug (which do not include each other) < ""
#   - the bridge converts the classes of the API: of the API it includes the public headers alone
#   - accel alone includes Embree (and apps/osgraytracebench, which measures against Embree)
#   - base/Parallel.cpp alone includes TBB, session/denoise/DenoiseOidn.cpp alone includes Open Image
#     Denoise
#   - apps/group/MpiGroup.cpp alone includes MPI
#   - osgRayTrace/servers/zmq and apps/osgraytrace-server/ZmqPort.cpp alone include ZeroMQ
#   - base to servers include neither OpenSceneGraph nor OpenGL
#   - DisplayTexture and offscreen alone call OpenGL
#   - a public header includes only public headers, OpenSceneGraph and the C++ library
# Usage: cmake -D ROOT=<source folder> -P CheckLayering.cmake. The script fails with one line for each offence.
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.24)

set(LAYERS base sampling film scene shading media accel photons integrators session servers bridge API offscreen osgPlugins
    apps)
set(ENGINE base sampling film scene shading media accel photons integrators session servers)
# The folders of a layer, each of which includes those left of it. "root" is the layer's own folder.
set(FOLDERS_bridge common geometry appearance/textures appearance/lights appearance/materials
    graph changes pick convert update)
set(FOLDERS_session image denoise upsample root history view)
set(FOLDERS_integrators shared whitted path debug root)
set(PEERS_integrators whitted path debug)
set(PUBLIC_HEADER "^osgRayTrace/(offscreen/)?[A-Za-z]+$")
set(offences 0)

macro(report file reason)
    math(EXPR offences "${offences} + 1")
    message(NOTICE "${file}: ${reason}")
endmacro()

# Returns the layer of a path below ROOT, or an empty string if the path is not in a layer.
function(layer_of path result)
    set(layer "")
    if(path MATCHES "^osgRayTrace/([A-Za-z]+)/")
        set(layer "${CMAKE_MATCH_1}")
    elseif(path MATCHES "^osgRayTrace/")
        set(layer API)
    elseif(path MATCHES "^(osgPlugins|apps)/")
        set(layer "${CMAKE_MATCH_1}")
    endif()
    set(${result} "${layer}" PARENT_SCOPE)
endfunction()

# Returns the folder of a path inside its layer: "root" for the layer's own.
function(room_of path layer result)
    get_filename_component(room "${path}" DIRECTORY)
    string(REGEX REPLACE "^osgRayTrace/${layer}/?" "" room "${room}")
    if(room STREQUAL "")
        set(room root)
    endif()
    set(${result} "${room}" PARENT_SCOPE)
endfunction()

macro(check_room file layer target)
    room_of("${file}" "${layer}" room)
    room_of("${target}" "${layer}" targetRoom)
    list(FIND FOLDERS_${layer} "${room}" roomRank)
    list(FIND FOLDERS_${layer} "${targetRoom}" targetRoomRank)
    if(roomRank LESS 0 OR targetRoomRank LESS 0)
        report("${file}" "includes ${target}: one of them lies in no known folder of ${layer}")
    elseif(targetRoomRank GREATER roomRank)
        report("${file}" "folder ${room} of ${layer} includes ${target} of ${targetRoom}, right of it")
    elseif(room IN_LIST PEERS_${layer} AND targetRoom IN_LIST PEERS_${layer} AND NOT room STREQUAL targetRoom)
        report("${file}" "folder ${room} of ${layer} includes ${target} of its peer ${targetRoom}")
    endif()
endmacro()

macro(check_include file layer include)
    # A path without a folder names a file in the folder of this one.
    set(target "${include}")
    if(NOT target MATCHES "/" AND EXISTS "${ROOT}/${folder}/${target}")
        set(target "${folder}/${target}")
    endif()
    layer_of("${target}" targetLayer)
    if(layer STREQUAL "bridge" AND target MATCHES "${PUBLIC_HEADER}")
        set(targetLayer bridge)
    endif()
    if(targetLayer)
        list(FIND LAYERS "${targetLayer}" targetRank)
        list(FIND LAYERS "${layer}" rank)
        if(targetRank LESS 0)
            report("${file}" "includes ${include}, of no known layer")
        elseif(targetRank GREATER rank)
            report("${file}" "layer ${layer} includes ${include} of ${targetLayer}, right of it")
        endif()
    endif()

    if(DEFINED FOLDERS_${layer} AND target MATCHES "^osgRayTrace/${layer}/")
        check_room("${file}" "${layer}" "${target}")
    endif()

    if(include MATCHES "^embree[34]?/" AND NOT layer STREQUAL "accel"
       AND NOT file MATCHES "^apps/osgraytracebench/")
        report("${file}" "includes Embree (${include}); accel alone may")
    endif()
    if(include MATCHES "^(oneapi/)?tbb[/.]" AND NOT file STREQUAL "osgRayTrace/base/Parallel.cpp")
        report("${file}" "includes TBB (${include}); base/Parallel.cpp alone may")
    endif()
    if(include MATCHES "^OpenImageDenoise/" AND NOT file STREQUAL "osgRayTrace/session/denoise/DenoiseOidn.cpp")
        report("${file}" "includes Open Image Denoise (${include}); session/denoise/DenoiseOidn.cpp alone may")
    endif()
    if(include MATCHES "^mpi\\.h$" AND NOT file STREQUAL "apps/group/MpiGroup.cpp")
        report("${file}" "includes MPI (${include}); apps/group/MpiGroup.cpp alone may")
    endif()
    if(include MATCHES "^zmq\\.h" AND NOT file MATCHES "^(osgRayTrace/servers/zmq/|apps/osgraytrace-server/ZmqPort\\.cpp$)")
        report("${file}" "includes ZeroMQ (${include}); servers/zmq and ZmqPort.cpp alone may")
    endif()
    if((include MATCHES "^draco/" AND NOT file MATCHES "^osgPlugins/gltf/Draco(Mesh|Bounds)\\.(h|cpp)$")
       OR (include MATCHES "^meshoptimizer" AND NOT file STREQUAL "osgPlugins/gltf/MeshoptView.cpp")
       OR (include MATCHES "^blosc\\.h" AND NOT file STREQUAL "osgPlugins/vdb/Blosc.cpp")
       OR (include MATCHES "^webp/" AND NOT file STREQUAL "osgPlugins/gltf/WebpImage.cpp"))
        report("${file}" "includes ${include}, an optional library; its own files of osgPlugins alone may")
    endif()
    if(include MATCHES "^(osg[A-Z]?[A-Za-z]*|OpenThreads|GL|GLES.*|EGL)/" AND NOT include MATCHES "^osgRayTrace/"
       AND layer IN_LIST ENGINE)
        report("${file}" "the engine includes ${include}")
    endif()
    if(public AND include MATCHES "\\.(h|hpp)$")
        report("${file}" "public header includes ${include}")
    elseif(public AND include MATCHES "/" AND NOT include MATCHES "^(osg[A-Z]?[A-Za-z]*|OpenThreads)/")
        report("${file}" "public header includes ${include}")
    endif()
endmacro()

file(GLOB_RECURSE files RELATIVE "${ROOT}" LIST_DIRECTORIES false
     "${ROOT}/osgRayTrace/*" "${ROOT}/osgPlugins/*" "${ROOT}/apps/*")
list(FILTER files EXCLUDE REGEX "\\.(txt|md|in)$")
list(LENGTH files fileCount)
if(fileCount EQUAL 0)
    message(FATAL_ERROR "No sources below ROOT='${ROOT}'")
endif()

foreach(file IN LISTS files)
    get_filename_component(folder "${file}" DIRECTORY)
    layer_of("${file}" layer)
    if(NOT layer IN_LIST LAYERS)
        report("${file}" "lies in no known layer")
        continue()
    endif()
    set(public FALSE)
    if(file MATCHES "${PUBLIC_HEADER}")
        set(public TRUE)
    endif()

    file(STRINGS "${ROOT}/${file}" includes REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]")
    foreach(line IN LISTS includes)
        string(REGEX REPLACE "^[^<\"]*[<\"]([^>\"]+)[>\"].*$" "\\1" include "${line}")
        check_include("${file}" "${layer}" "${include}")
    endforeach()

    if(NOT file MATCHES "^osgRayTrace/(DisplayTexture\\.|offscreen/)")
        file(STRINGS "${ROOT}/${file}" calls REGEX "(^|[^A-Za-z0-9_])gl[A-Z][A-Za-z0-9]*[ \t]*\\(")
        foreach(line IN LISTS calls)
            string(REGEX REPLACE "//.*$" "" line "${line}")
            if(line MATCHES "(^|[^A-Za-z0-9_])(gl[A-Z][A-Za-z0-9]*)[ \t]*\\(")
                report("${file}" "calls OpenGL (${CMAKE_MATCH_2})")
            endif()
        endforeach()
    endif()
endforeach()

if(offences GREATER 0)
    message(FATAL_ERROR "${offences} offences against the layers in ${fileCount} files")
endif()
message(NOTICE "${fileCount} files keep to the layers")
