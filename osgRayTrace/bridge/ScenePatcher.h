// ScenePatcher.h - a new Scene from the last one where only places and shapes have changed. Layer:
// bridge. SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/GeometryCache.h"
#include "osgRayTrace/bridge/GraphChanges.h"
#include "osgRayTrace/scene/Scene.h"

#include <memory>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

/// Which instance each use of a geometry has become.
struct SceneIndex
{
    struct Uses
    {
        uint32_t first = 0; ///< in instances
        uint32_t count = 0;
        bool patchable = true; ///< false: it is made where it is, as raised faces are
    };
    std::unordered_map<const osg::Geometry*, Uses> uses;
    std::vector<uint32_t> instances; ///< by use; kInvalid: nothing of it is traced
};

/// Redoes the instances that moved and the meshes that deformed, and nothing else. What does so for
/// the first time gets a mesh in its own coordinates, and so leaves the flat BVH.
class ScenePatcher
{
public:
    /// last: in units of 1, and of ordinary lengths (see SceneExtent).
    ScenePatcher(const Scene& last, const SceneIndex& index, GeometryCache& geometries, Stamp now);

    /// Null if the graph must be converted again: something looks different from what it did before
    /// in more than its place and its shape.
    std::shared_ptr<Scene> patch(const GraphChanges& changes);

    /// patch() has changed something.
    bool changed() const { return _changed; }

    /// Some mesh left the flat BVH.
    bool leftFlat() const { return _leftFlat; }

private:
    bool move(const MovedUse& use);
    bool deform(const osg::Geometry& geometry);
    bool place(const osg::Geometry& geometry, uint32_t index, const osg::Matrixd& engineFromLocal);
    bool makeMesh(const osg::Geometry& geometry, const MeshRequest& request, uint32_t meshIndex);
    void touch(uint32_t index);

    const SceneIndex& _index;
    GeometryCache& _geometries;
    Stamp _now;
    std::shared_ptr<Scene> _scene;
    bool _changed = false;
    bool _leftFlat = false;
};

} // namespace osgRayTrace::engine
