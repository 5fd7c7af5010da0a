// PlacePatcher.h - changes only places and shapes in a Scene. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/changes/GraphChanges.h"
#include "osgRayTrace/bridge/convert/SceneIndex.h"
#include "osgRayTrace/bridge/geometry/GeometryCache.h"
#include "osgRayTrace/scene/Scene.h"

namespace osgRayTrace::engine
{

/// Redoes the instances that moved and the meshes that deformed, and nothing else. A geometry that
/// moves or deforms for the first time gets a mesh in its own coordinates, and so leaves the static
/// BVH.
class PlacePatcher
{
public:
    /// The scene must be in units of 1 and have ordinary lengths (see SceneExtent).
    PlacePatcher(Scene& scene, const SceneIndex& index, GeometryCache& geometries, Stamp now)
        : _scene(scene), _index(index), _geometries(geometries), _now(now)
    {
    }

    /// Returns false if the graph must be converted again for cause(): more than the place and the
    /// shape of something looks different.
    bool move(const MovedUse& use);
    bool deform(const osg::Geometry& geometry);

    ConversionCause cause() const { return _cause; }

    /// Returns whether something has changed.
    bool changed() const { return _changed; }

    /// Returns whether some mesh left the static BVH.
    bool leftStatic() const { return _leftStatic; }

private:
    bool place(const osg::Geometry& geometry, uint32_t index, const osg::Matrixd& engineFromLocal);
    bool raise(const osg::Geometry& geometry, uint32_t index, const osg::Matrixd& engineFromLocal,
               bool copies);
    bool makeMesh(const osg::Geometry& geometry, const MeshRequest& request, uint32_t meshIndex);
    void touch(uint32_t index);
    /// Records the cause and returns false.
    bool refuse(ConversionCause cause)
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
