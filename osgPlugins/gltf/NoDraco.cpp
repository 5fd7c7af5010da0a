// NoDraco.cpp - stands for DracoMesh.cpp if the draco library was not found. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/DracoMesh.h"

namespace osgRayTrace::gltf
{

bool readsDraco()
{
    return false;
}

DracoMesh decodeDraco(const std::string&, const Accessor&, bool, const std::vector<DracoAttribute>&,
                      std::uint64_t, const JsonPlace& place)
{
    place.refuse("is compressed by draco, which is not built in");
}

} // namespace osgRayTrace::gltf
