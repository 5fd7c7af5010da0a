// ScenePicker.h - finds the hits of a segment with a scene graph, by the traced scene. Layer:
// bridge.
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

/// Looks for hits with the surfaces of one traced scene. Rays find the triangles in float. The
/// place on the triangle, and its distance, are then computed in double from the geometry's own
/// vertices and the present transforms, as osgUtil does. Only one thread may use a picker,
/// which lives for one intersection; std::bad_alloc may be thrown.
class ScenePicker
{
public:
    using Hit = osgUtil::LineSegmentIntersector::Intersection;

    /// The visitor is at the decorator, and the index belongs to the scene. All references are
    /// kept.
    ScenePicker(const TracedScene& scene, const PickIndex& index,
                osgUtil::IntersectionVisitor& visitor, HitRule rule)
        : _scene(scene), _index(index), _visitor(visitor), _rule(rule)
    {
    }

    /// Returns the hits from start to end, in the scene's coordinates; limit selects the first or
    /// all, overall or by drawable. bound is that of the scene; nothing outside of it is looked at,
    /// which keeps floats exact.
    std::vector<Hit> pick(const osg::Vec3d& start, const osg::Vec3d& end,
                          const osg::BoundingSphere& bound,
                          osgUtil::Intersector::IntersectionLimit limit);

private:
    /// Holds the segment in engine coordinates; ratio = first + t * perLength.
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
    osg::Vec3d _start, _end; ///< ends in the scene's coordinates
    /// Transforms of the drawable that leadTo found last.
    osg::Matrixd _sceneFromLocal, _localFromScene;
    osg::Vec3d _localStart, _localEnd;
    std::vector<uint32_t> _way;
};

} // namespace osgRayTrace::engine
