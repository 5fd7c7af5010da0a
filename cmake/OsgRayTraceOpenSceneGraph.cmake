# Defines the imported target osgRayTrace::OSG: OpenSceneGraph 3.6's libraries as SYSTEM includes.
# This project uses the file, and its consumers use it as installed beside the package file.
# SPDX-License-Identifier: MIT
if(NOT TARGET osgRayTrace::OSG)
    find_package(OpenSceneGraph 3.6 REQUIRED QUIET
                 COMPONENTS osgViewer osgGA osgText osgAnimation osgVolume osgDB osgUtil)
    find_package(OpenGL REQUIRED QUIET)
    add_library(osgRayTrace::OSG INTERFACE IMPORTED)
    set_target_properties(osgRayTrace::OSG PROPERTIES
        INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${OPENSCENEGRAPH_INCLUDE_DIRS}"
        INTERFACE_INCLUDE_DIRECTORIES "${OPENSCENEGRAPH_INCLUDE_DIRS}")
    target_link_libraries(osgRayTrace::OSG INTERFACE ${OPENSCENEGRAPH_LIBRARIES} OpenGL::GL)
endif()
