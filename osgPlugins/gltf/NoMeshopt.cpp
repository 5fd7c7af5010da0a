// NoMeshopt.cpp - stands for MeshoptView.cpp if meshoptimizer was not found. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/MeshoptView.h"

namespace osgRayTrace::gltf
{

bool readsMeshopt()
{
    return false;
}

std::string decodeMeshopt(const std::string&, const MeshoptLayout&, const JsonPlace& place)
{
    place.refuse("is compressed by meshoptimizer, which is not built in");
}

} // namespace osgRayTrace::gltf
