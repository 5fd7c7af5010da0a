// ScenePicker.h - what of a scene graph a segment hits, by the traced scene. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/bridge/pick/PickIndex.h"

#include <osgUtil/LineSegmentIntersector>

#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// Looks for hits with the surfaces of one traced scene. Rays find the triangles in float; where on
/// them, and how far, is then computed in double from the geometry's own vertices and the
/// transforms as they are now, as osgUtil does. Used by one thread; throws std::bad_alloc.
class ScenePicker
{
public:
    using Hit = osgUtil::LineSegmentIntersector::Intersection;

    /// visitor: at the decorator. All are kept. The index is of the scene.
    ScenePicker(const TracedScene& scene, const PickIndex& index,
                osgUtil::IntersectionVisitor& visitor, HitRule rule)
        : _scene(scene), _index(index), _visitor(visitor), _rule(rule)
    {
    }

    /// From start to end, in the scene's coordinates: the first, or all of them, of a drawable the
    /// first or all. bound: of the scene; what is outside of it is not looked at, which keeps
    /// floats exact.
    std::vector<Hit> pick(const osg::Vec3d& start, const osg::Vec3d& end,
                          const osg::BoundingSphere& bound,
                          osgUtil::Intersector::IntersectionLimit limit);

private:
    /// The segment in engine coordinates; ratio = first + t * perLength.
    struct EngineRay
    {
        Vec3 origin{0.0f}, direction{0.0f};
        float tNear = 0.0f, tFar = 0.0f;
        double first = 0.0, perLength = 0.0;
    };

    std::optional<EngineRay> engineRay(const osg::BoundingSphere& bound) const;
    std::optional<Hit> hitOf(const engine::Hit& found, double ratio);
    bool leadTo(uint32_t path, Hit& hit);
    bool placeOnTriangle(const osg::Geometry& geometry, const UVec3& rows, double ratio,
                         Hit& hit) const;
    void placeOnSurface(const engine::Hit& found, double ratio, Hit& hit) const;
    uint32_t primitiveByOsg(osg::Drawable& drawable, const Hit& hit) const;

    const TracedScene& _scene;
    const PickIndex& _index;
    osgUtil::IntersectionVisitor& _visitor;
    HitRule _rule;
    osg::Vec3d _start, _end;                       ///< in the scene
    osg::Matrixd _sceneFromLocal, _localFromScene; ///< of the drawable last led to
    osg::Vec3d _localStart, _localEnd;
    std::vector<uint32_t> _way;
};

} // namespace osgRayTrace::engine
