// ScenePicker.cpp - traces one ray, and translates its hits to the graph. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/pick/ScenePicker.h"

#include "osgRayTrace/bridge/geometry/BoundArrays.h"

#include <osg/Geode>
#include <osg/Transform>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgRayTrace::engine
{

namespace
{

/// Relative rounding of a coordinate or a distance in floats after a few operations.
constexpr double kRounding = 8.0 * 0x1p-24;

/// Weights of corners that are so far outside of the triangle mean that the graph has changed since
/// it was traced.
constexpr double kBeside = 1e-3;

/// Returns a row of an array, by number, if the array has a type that osg::Geometry may have for
/// vertices.
std::optional<osg::Vec3d> vertex(const osg::Array& array, uint32_t row)
{
    if (row >= array.getNumElements()) return std::nullopt;
    switch (array.getType())
    {
    case osg::Array::Vec3ArrayType:
        return osg::Vec3d(static_cast<const osg::Vec3Array&>(array)[row]);
    case osg::Array::Vec3dArrayType:
        return static_cast<const osg::Vec3dArray&>(array)[row];
    default:
        return std::nullopt;
    }
}

bool isFinite(const osg::Vec3d& v)
{
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

} // namespace

std::vector<ScenePicker::Hit> ScenePicker::pick(const osg::Vec3d& start, const osg::Vec3d& end,
                                                const osg::BoundingSphere& bound,
                                                osgUtil::Intersector::IntersectionLimit limit)
{
    _start = start;
    _end = end;
    std::vector<Hit> hits;
    const std::optional<EngineRay> ray = engineRay(bound);
    if (!ray) return hits;
    const bool one =
        limit == osgUtil::Intersector::LIMIT_ONE || limit == osgUtil::Intersector::LIMIT_NEAREST;
    const bool onePerDrawable = limit == osgUtil::Intersector::LIMIT_ONE_PER_DRAWABLE;
    float tNear = ray->tNear;
    while (const std::optional<engine::Hit> found = _scene.intersector().closestHit(
               ray->origin, ray->direction, tNear, ray->tFar, _rule))
    {
        std::optional<Hit> hit = hitOf(*found, ray->first + double(found->t) * ray->perLength);
        const bool again = hit && onePerDrawable &&
                           std::any_of(hits.begin(), hits.end(),
                                       [&hit](const Hit& other) {
                                           return other.nodePath == hit->nodePath &&
                                                  other.drawable == hit->drawable;
                                       });
        if (hit && !again) hits.push_back(std::move(*hit));
        if (one && !hits.empty()) break;
        // The same ray finds the same distances: the next float is past the hits so far. The
        // application's thread may take denormals for 0.
        tNear = std::max(std::nextafter(found->t, std::numeric_limits<float>::infinity()),
                         std::numeric_limits<float>::min());
    }
    return hits;
}

/// Returns the segment's ray, cut to the bound of the scene: a segment may begin at a near plane
/// far outside, at which floats are coarse. The ray is a little longer than the segment at both
/// ends; hits beyond the segment are refused in double.
std::optional<ScenePicker::EngineRay> ScenePicker::engineRay(const osg::BoundingSphere& bound) const
{
    if (!isFinite(_start) || !isFinite(_end)) return std::nullopt;
    const osg::Vec3d along = _end - _start;
    const double length = along.length();
    if (!(length > 0.0)) return std::nullopt;
    double first = 0.0, last = 1.0;
    if (bound.valid())
    {
        const osg::Vec3d centre(bound.center());
        const double radius = 1.01 * double(bound.radius()) + kRounding * centre.length();
        const double middle = ((centre - _start) * along) / (length * length);
        const double half = radius / length;
        first = std::max(first, middle - half);
        last = std::min(last, middle + half);
        if (first > last) return std::nullopt;
    }
    const Scene& scene = _scene.scene();
    const osg::Vec3d origin(scene.origin.x, scene.origin.y, scene.origin.z);
    const osg::Vec3d begin = (_start + along * first - origin) / scene.unit;
    const double engineLength = (last - first) * length / scene.unit;
    const double margin = kRounding * (begin.length() + engineLength);
    const osg::Vec3d direction = along / length;
    const osg::Vec3d from = begin - direction * margin;

    EngineRay ray;
    ray.origin = Vec3(Vec3d(from.x(), from.y(), from.z()));
    ray.direction = Vec3(Vec3d(direction.x(), direction.y(), direction.z()));
    ray.tFar = static_cast<float>(engineLength + 2.0 * margin);
    ray.perLength = scene.unit / length;
    ray.first = first - margin * ray.perLength;
    return ray;
}

/// Returns nothing if the ray has to go on, because it met no drawable, or a masked one, or one
/// beyond the segment's ends.
std::optional<ScenePicker::Hit> ScenePicker::hitOf(const engine::Hit& found, double ratio)
{
    const PickIndex::Use use = _index.use(found.instance);
    Hit hit;
    if (use.path == NodeTree::kNone || !leadTo(use.path, hit)) return std::nullopt;
    const Scene& scene = _scene.scene();
    const Mesh& mesh = *scene.meshes[scene.instances[found.instance].mesh];
    GeometryTriangle triangle = _index.triangle(use, mesh, found.primitive);
    // Mirrored triangles were turned: see GeometryConverter.
    const osg::Matrixd& m = _sceneFromLocal;
    const bool mirrored =
        osg::Vec3d(m(0, 0), m(0, 1), m(0, 2)) *
            (osg::Vec3d(m(1, 0), m(1, 1), m(1, 2)) ^ osg::Vec3d(m(2, 0), m(2, 1), m(2, 2))) <
        0.0;
    if (mirrored && !scene.instances[found.instance].placed)
        std::swap(triangle.rows.y, triangle.rows.z);
    if (!placeOnTriangle(_index.geometry(use), triangle.rows, ratio, hit))
        placeOnSurface(found, ratio, hit);
    if (!(hit.ratio >= 0.0 && hit.ratio <= 1.0)) return std::nullopt;
    hit.primitiveIndex =
        triangle.primitive != kInvalid ? triangle.primitive : primitiveByOsg(*hit.drawable, hit);
    return hit;
}

/// Sets the values that follow from the path alone, and the drawable's present coordinates. Returns
/// false if the visitor's mask hides it.
bool ScenePicker::leadTo(uint32_t path, Hit& hit)
{
    const NodeTree& paths = _index.paths();
    paths.way(path, _way);
    hit.nodePath = _visitor.getNodePath();
    _sceneFromLocal.makeIdentity();
    bool moved = false;
    for (const uint32_t entry : _way)
    {
        osg::Node& node = paths.node(entry);
        // osgUtil does not visit the drawables of geodes: such drawables are on no path, and their
        // masks do not count.
        const bool inGeode = entry == _way.back() && !hit.nodePath.empty() && _way.size() > 1 &&
                             hit.nodePath.back()->asGeode();
        if (inGeode) break;
        if (!_visitor.validNodeMask(node)) return false;
        hit.nodePath.push_back(&node);
        const osg::Transform* transform = node.asTransform();
        if (!transform) continue;
        transform->computeLocalToWorldMatrix(_sceneFromLocal, &_visitor);
        moved = true;
    }
    hit.drawable = paths.node(path).asDrawable();
    if (!_localFromScene.invert(_sceneFromLocal)) return false;
    hit.matrix = _visitor.getModelMatrix();
    if (moved)
        hit.matrix =
            new osg::RefMatrix(hit.matrix ? _sceneFromLocal * *hit.matrix : _sceneFromLocal);
    _localStart = _start * _localFromScene;
    _localEnd = _end * _localFromScene;
    return hit.drawable.valid();
}

/// Places the hit on the triangle in double [MollerTrumbore97, eq. 6]. ratio is that which the ray
/// found. Returns false if the triangle is not there now, or was elsewhere in the traced scene.
bool ScenePicker::placeOnTriangle(const osg::Geometry& geometry, const UVec3& rows, double ratio,
                                  Hit& hit) const
{
    const osg::Array* vertices = positionArray(geometry);
    if (!vertices || rows.x == kInvalid) return false;
    const auto a = vertex(*vertices, rows.x), b = vertex(*vertices, rows.y),
               c = vertex(*vertices, rows.z);
    if (!a || !b || !c) return false;
    const osg::Vec3d d = _localEnd - _localStart;
    const osg::Vec3d ab = *b - *a, ac = *c - *a, toStart = _localStart - *a;
    const osg::Vec3d p = d ^ ac, q = toStart ^ ab;
    const double determinant = p * ab;
    if (determinant == 0.0) return false;
    const double u = (p * toStart) / determinant, v = (q * d) / determinant;
    const double exact = (q * ac) / determinant;
    const bool inside = u > -kBeside && v > -kBeside && u + v < 1.0 + kBeside;
    // A surface that was raised, or has moved since, is at another place.
    const double size = (ab.length() + ac.length()) / d.length();
    if (!inside || !(std::fabs(exact - ratio) <= 1e-4 * (std::fabs(ratio) + size))) return false;
    hit.ratio = exact;
    hit.localIntersectionPoint = _localStart + d * exact;
    hit.localIntersectionNormal = ab ^ ac;
    hit.localIntersectionNormal.normalize();
    hit.indexList = {rows.x, rows.y, rows.z};
    hit.ratioList = {1.0 - u - v, u, v};
    return true;
}

/// Places the hit on the surface as it was traced: parts cut by clip planes have no triangle in the
/// graph, nor have parts that changed since.
void ScenePicker::placeOnSurface(const engine::Hit& found, double ratio, Hit& hit) const
{
    const Scene& scene = _scene.scene();
    const Instance& instance = scene.instances[found.instance];
    const Mesh& mesh = *scene.meshes[instance.mesh];
    const UVec3& t = mesh.triangles[found.primitive];
    Vec3d normal = glm::cross(Vec3d(mesh.positions[t.y]) - Vec3d(mesh.positions[t.x]),
                              Vec3d(mesh.positions[t.z]) - Vec3d(mesh.positions[t.x]));
    if (instance.placed)
        normal = glm::dmat3(normalMatrix(instance.engineFromLocal.linear)) * normal;
    hit.ratio = ratio;
    hit.localIntersectionPoint = _localStart + (_localEnd - _localStart) * ratio;
    hit.localIntersectionNormal =
        osg::Matrixd::transform3x3(_sceneFromLocal, osg::Vec3d(normal.x, normal.y, normal.z));
    hit.localIntersectionNormal.normalize();
}

/// Returns the primitive of the drawable that osgUtil meets nearest to the hit; 0 if osgUtil meets
/// none.
uint32_t ScenePicker::primitiveByOsg(osg::Drawable& drawable, const Hit& hit) const
{
    const osg::Geometry* geometry = drawable.asGeometry();
    const osg::Array* vertices = geometry ? geometry->getVertexArray() : nullptr;
    if (!vertices || vertices->getType() != osg::Array::Vec3ArrayType)
        return 0; // osgUtil would read nothing, at a null pointer
    osg::ref_ptr<osgUtil::LineSegmentIntersector> segment =
        new osgUtil::LineSegmentIntersector(_localStart, _localEnd);
    osgUtil::IntersectionVisitor visitor(segment.get());
    segment->intersect(visitor, &drawable);
    uint32_t primitive = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Hit& other : segment->getIntersections())
    {
        const double distance = std::fabs(other.ratio - hit.ratio);
        if (distance >= nearest) continue;
        nearest = distance;
        primitive = other.primitiveIndex;
    }
    return primitive;
}

} // namespace osgRayTrace::engine
