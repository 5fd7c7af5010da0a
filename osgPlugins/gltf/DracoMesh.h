// DracoMesh.h - triangle meshes of KHR_draco_mesh_compression, decoded by Google's library. Layer:
// osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/Accessor.h"

namespace osgRayTrace::gltf
{

/// An attribute of a compressed mesh and the accessor that describes its values.
struct DracoAttribute
{
    std::uint32_t id; ///< the mesh's unique id of the attribute
    Accessor layout;
};

/// The values of a mesh, as its accessors describe them, without gaps.
struct DracoMesh
{
    std::string indices;                 ///< three a triangle
    std::vector<std::string> attributes; ///< in the order in which they were asked for
};

/// Returns whether the library is built in.
bool readsDraco();

/// Returns the values of a compressed mesh. strip: the accessor of the indices counts those of a
/// strip of at least these triangles, and not three for each. mostBytes: what the library may take
/// for its work, which the counts in the compressed bytes are checked against before memory is
/// taken. Throws GltfError with the place if the bytes are damaged, or if their counts and
/// components are not those of the accessors.
DracoMesh decodeDraco(const std::string& compressed, const Accessor& indices, bool strip,
                      const std::vector<DracoAttribute>& attributes, std::uint64_t mostBytes,
                      const JsonPlace& place);

} // namespace osgRayTrace::gltf
