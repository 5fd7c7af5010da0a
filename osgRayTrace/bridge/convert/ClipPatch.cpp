// ClipPatch.cpp - patches a scene for clip planes that moved. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ClipPlanes.h"
#include "osgRayTrace/bridge/convert/ScenePatcher.h"
#include "osgRayTrace/bridge/geometry/MeshPlacement.h"

namespace osgRayTrace::engine
{

/// Cuts what the changed planes cut, and nothing else. Returns false if the graph must be
/// converted: something comes or goes as a whole, or planes are set where nobody has looked.
bool ScenePatcher::recut(const std::vector<PlacedClip>& clips)
{
    if (clips.empty()) return true;
    const Vec3d& origin = _scene->origin;
    const osg::Matrixd engineFromScene = osg::Matrixd::translate(-origin.x, -origin.y, -origin.z);
    ClipPlanes planes;
    uint64_t numbers = 0;
    for (const PlacedClip& clip : clips)
    {
        numbers |= planeNumbers(*clip.node);
        for (const osg::ref_ptr<osg::ClipPlane>& plane : clip.node->getClipPlaneList())
            if (plane && !planes.set(*plane, clip.sceneFromPlanes * engineFromScene))
                return refuse(ConversionCause::ClipPlanes, {});
    }
    const uint64_t unwatched = _convertedGraph.unwatchedPlanes;
    if (numbers & unwatched & _convertedGraph.cuttingPlanes) // which one is the last is unknown
        return refuse(ConversionCause::ClipPlanes, {});
    planes.take(_convertedGraph.clipPlanes, unwatched);
    const uint64_t changed = planes.differences(_convertedGraph.clipPlanes);
    _convertedGraph.clipPlanes = planes;
    _caches.movedPlanes |= changed;
    for (ClippedUse& use : _convertedGraph.clipped)
        if ((use.numbers & changed) && !recut(use)) return false;
    return true;
}

/// Makes the mesh of a use anew. Returns false if the use comes or goes as a whole, or leaves the
/// mesh that it shares.
bool ScenePatcher::recut(ClippedUse& use)
{
    const auto refuseUse = [&] { return refuse(ConversionCause::ClipPlanes, *use.geometry, 0); };
    std::vector<Vec4d> planes = _convertedGraph.clipPlanes.planesOf(use.numbers);
    const Clipping clipping = clippingOf(*use.geometry, _caches.geometries.bounds(*use.geometry),
                                         use.engineFromLocal, planes);
    const Clipping before = use.clipping;
    use.clipping = clipping;
    if (clipping == before && clipping != Clipping::Partly) return true;
    if (clipping == Clipping::Wholly || before == Clipping::Wholly || !use.own) return refuseUse();
    MeshRequest request = use.request;
    request.clipPlanes.clear();
    if (clipping == Clipping::Partly) request.clipPlanes = std::move(planes);
    const std::string path = use.instance == kInvalid
                                 ? use.geometry->getName()
                                 : _scene->meshes[_scene->instances[use.instance].mesh]->name;
    ConversionReport then, now;
    _caches.geometries.mesh(*use.geometry, use.variant, use.request, path, then);
    const auto mesh = _caches.geometries.mesh(*use.geometry, use.variant, request, path, now);
    use.request = std::move(request);
    if (then.counts() != now.counts()) return refuseUse(); // the report would change
    if (use.instance == kInvalid || !mesh)
        return (use.instance == kInvalid && !mesh) || refuseUse();
    Instance& instance = _scene->instances[use.instance];
    _scene->meshes[instance.mesh] = mesh;
    if (!instance.placed)
    {
        if (!placeInstance(instance, osg::Matrixd())) return refuseUse();
        _leftStatic = true;
    }
    instance.changed = _now;
    _changed = true;
    return true;
}

} // namespace osgRayTrace::engine
