// PlacePatcher.h - other places and shapes in a Scene that is as it was else. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/changes/GraphChanges.h"
#include "osgRayTrace/bridge/convert/SceneIndex.h"
#include "osgRayTrace/bridge/geometry/GeometryCache.h"
#include "osgRayTrace/scene/Scene.h"

namespace osgRayTrace::engine
{

/// Redoes the instances that moved and the meshes that deformed, and nothing else. What does so for
/// the first time gets a mesh in its own coordinates, and so leaves the static BVH.
class PlacePatcher
{
public:
    /// scene: in units of 1, and of ordinary lengths (see SceneExtent).
    PlacePatcher(Scene& scene, const SceneIndex& index, GeometryCache& geometries, Stamp now)
        : _scene(scene), _index(index), _geometries(geometries), _now(now)
    {
    }

    /// False if the graph must be converted again, by cause(): something looks different from what
    /// it did before in more than its place and its shape.
    bool move(const MovedUse& use);
    bool deform(const osg::Geometry& geometry);

    ConversionCause cause() const { return _cause; }

    /// Something has changed.
    bool changed() const { return _changed; }

    /// Some mesh left the static BVH.
    bool leftStatic() const { return _leftStatic; }

private:
    bool place(const osg::Geometry& geometry, uint32_t index, const osg::Matrixd& engineFromLocal);
    bool makeMesh(const osg::Geometry& geometry, const MeshRequest& request, uint32_t meshIndex);
    void touch(uint32_t index);
    bool refuse(ConversionCause cause) ///< false
    {
        _cause = cause;
        return false;
    }

    Scene& _scene;
    const SceneIndex& _index;
    GeometryCache& _geometries;
    Stamp _now;
    bool _changed = false;
    bool _leftStatic = false;
    ConversionCause _cause = ConversionCause::None;
};

} // namespace osgRayTrace::engine
