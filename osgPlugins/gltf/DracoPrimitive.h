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
    /// its accessors have the decoded bytes. Draco knows triangles alone: the indices of a strip
    /// are those of its triangles, too. Primitives without the extension are left alone. Throws
    /// GltfError.
    void open(const JsonPlace& primitive);

    /// Returns whether the last primitive was decoded: its indices are then those of triangles.
    bool isOpen() const { return _open; }

private:
    /// Where the values of an accessor come from.
    struct Origin
    {
        std::size_t view;
        std::uint64_t attribute;
    };

    void checkOrigin(const JsonPlace& index, const Origin& origin);

    AccessorReader* _accessors;
    bool _open = false;
    std::map<std::size_t, Origin> _origins; ///< by accessor
};

} // namespace osgRayTrace::gltf
