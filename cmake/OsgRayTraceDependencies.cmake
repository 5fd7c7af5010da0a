# Finds what the project builds on. OpenSceneGraph gets imported targets here (osgRayTrace::OSG), once,
# because CMake's own FindOpenSceneGraph defines none; the wrapper is installed for consumers as well.
include(OsgRayTraceOpenSceneGraph)

find_package(embree 4 QUIET CONFIG)
if(NOT embree_FOUND)
    find_package(embree 3.12 REQUIRED CONFIG)
endif()
find_package(TBB REQUIRED CONFIG)
find_package(glm REQUIRED CONFIG)
find_package(nlohmann_json REQUIRED CONFIG)
find_package(Threads REQUIRED)
