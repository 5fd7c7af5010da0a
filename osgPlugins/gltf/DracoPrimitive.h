// DracoPrimitive.h - gives the accessors of compressed primitives their values. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/DracoMesh.h"

namespace osgRayTrace::gltf
{

class DracoPrimitive
{
public:
    explicit DracoPrimitive(AccessorReader& accessors) : _accessors(&accessors) {}

    /// Decodes a primitive of KHR_draco_mesh_compression if draco is built in: until the next call
    /// its accessors have the decoded bytes. Primitives without the extension are left alone.
    /// Throws GltfError.
    void open(const JsonPlace& primitive);

private:
    /// Where the values of an accessor come from.
    struct Origin
    {
        std::size_t view;
        std::uint64_t attribute;
    };

    void checkOrigin(const JsonPlace& index, const Origin& origin);

    AccessorReader* _accessors;
    std::map<std::size_t, Origin> _origins; ///< by accessor
};

} // namespace osgRayTrace::gltf
