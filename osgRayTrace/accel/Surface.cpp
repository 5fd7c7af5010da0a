// Surface.cpp - rebuilds the surface points that a block of rays hit. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/Surface.h"

#include "osgRayTrace/accel/SmoothSurface.h"
#include "osgRayTrace/accel/TrianglePlane.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the largest magnitude of the coordinates.
float largestOf(Vec3 v)
{
    return std::max(std::fabs(v.x), std::max(std::fabs(v.y), std::fabs(v.z)));
}

/// Returns the magnitude of the terms that are added up when a transform places the vertices.
float transformMagnitude(const Affine& m, Vec3 a, Vec3 b, Vec3 c)
{
    const float vertex = std::max(largestOf(a), std::max(largestOf(b), largestOf(c)));
    const float row = largestOf(m.linear[0]) + largestOf(m.linear[1]) + largestOf(m.linear[2]);
    return vertex * row + largestOf(m.translation);
}

/// Sets the vertices of lane i to those of a triangle of an instance that a transform places.
void placeTriangle(const SurfaceRecord& record, UVec3 t, int i, TriangleLanes& lanes)
{
    const Vec3 a = record.positions[t.x], b = record.positions[t.y], c = record.positions[t.z];
    const Affine& m = record.placed->engineFromLocal;
    lanes.transformBound[i] = transformMagnitude(m, a, b, c);
    setLane(lanes.a, i, transformPoint(m, a));
    setLane(lanes.b, i, transformPoint(m, b));
    setLane(lanes.c, i, transformPoint(m, c));
}

/// Sets the vertex normals of lane i to those of a triangle.
void loadNormals(const SurfaceRecord& record, UVec3 t, int i, TriangleLanes& lanes)
{
    Vec3 na = record.normals[t.x];
    Vec3 nb = record.normals[t.y];
    Vec3 nc = record.normals[t.z];
    if (record.placed)
    {
        const Mat3 normalFromLocal = normalMatrix(record.placed->engineFromLocal.linear);
        // OpenGL normalises before it interpolates, so the vertex normals get equal weights here.
        na = glm::normalize(normalFromLocal * na);
        nb = glm::normalize(normalFromLocal * nb);
        nc = glm::normalize(normalFromLocal * nc);
    }
    setLane(lanes.na, i, na);
    setLane(lanes.nb, i, nb);
    setLane(lanes.nc, i, nc);
}

/// Reads a triangle into lane i. Returns true if the triangle has vertex normals.
OSGRAYTRACE_INLINE bool loadTriangle(const SurfaceRecord& record, uint32_t primitive, int i,
                                     TriangleLanes& lanes)
{
    const UVec3 t = record.triangles[primitive];
    if (record.placed)
        placeTriangle(record, t, i, lanes);
    else
    {
        setLane(lanes.a, i, plainOf(record.positions[t.x]));
        setLane(lanes.b, i, plainOf(record.positions[t.y]));
        setLane(lanes.c, i, plainOf(record.positions[t.z]));
        lanes.transformBound[i] = 0.0f;
    }
    if (record.normals) loadNormals(record, t, i, lanes);
    return record.normals != nullptr;
}

/// Sets the vertices and materials of all lanes to zero.
OSGRAYTRACE_KERNEL
void clearLanes(TriangleLanes& lanes, UintLanes& material)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        setLane(lanes.a, i, PlainVec3{0.0f, 0.0f, 0.0f});
        setLane(lanes.b, i, PlainVec3{0.0f, 0.0f, 0.0f});
        setLane(lanes.c, i, PlainVec3{0.0f, 0.0f, 0.0f});
        lanes.transformBound[i] = 0.0f;
        material[i] = 0;
    }
}

/// Sets position, normals, offset and minCosine of lane i; the shading normal becomes the plane's.
/// Returns all bits if the ray comes from the front.
OSGRAYTRACE_INLINE uint32_t setSurface(const RayHitBlock& block, int i, const PlainTriangle& t,
                                       const TrianglePlane& plane, SurfaceLanes& s)
{
    const float u = block.u[i], v = block.v[i], w = 1.0f - u - v;
    setLane(s.position, i, interpolated(t, w, u, v));
    const float cosine = dot(plane.normal, plainDirection(block.ray, i));
    const float side = select(cosine > 0.0f, -1.0f, 1.0f);
    setLane(s.geometricNormal, i, plane.normal * side);
    setLane(s.shadingNormal, i, plane.normal);
    s.offset[i] = plane.offset;
    s.minCosine[i] = plane.minCosine;
    return maskOf(cosine <= 0.0f);
}

/// Sets lane i of a surface from the triangle of that lane. Returns all bits if the ray comes from
/// the front.
OSGRAYTRACE_INLINE uint32_t setSurface(const RayHitBlock& block, int i,
                                       const TriangleLanes& triangles, SurfaceLanes& s)
{
    const PlainTriangle t = triangleOf(triangles, i);
    return setSurface(block, i, t, planeOf(t, triangles.transformBound[i]), s);
}

/// Sets the geometry of all lanes, with one triangle a lane.
OSGRAYTRACE_KERNEL
void geometry(const RayHitBlock& block, const TriangleLanes& triangles, SurfaceLanes& s)
{
    LaneMask front = 0;
    OSGRAYTRACE_SIMD_OR(front)
    for (int i = 0; i < kLanes; ++i)
        front |= bitOfLane(setSurface(block, i, triangles, s), i);
    s.front = front;
}

/// Sets the geometry of all lanes if all hits are on one triangle, whose plane all lanes share.
OSGRAYTRACE_KERNEL
void geometryOfOne(const RayHitBlock& block, const LastTriangle& last, SurfaceLanes& s)
{
    const PlainTriangle t = triangleOf(last.lanes, 0);
    const TrianglePlane plane = last.plane;
    LaneMask front = 0;
    OSGRAYTRACE_SIMD_OR(front)
    for (int i = 0; i < kLanes; ++i)
        front |= bitOfLane(setSurface(block, i, t, plane, s), i);
    s.front = front;
}

/// Returns true if all hits are on one triangle, as they mostly are if triangles are larger than
/// pixels.
OSGRAYTRACE_KERNEL
bool isOneTriangle(const RayHitBlock& block, LaneMask hits, int first)
{
    const uint32_t primitive = block.primitive[first], geometry = block.geometry[first],
                   instance = block.instance[first];
    uint32_t differs = 0;
    OSGRAYTRACE_SIMD_OR(differs)
    for (int i = 0; i < kLanes; ++i)
        differs |= ((block.primitive[i] ^ primitive) | (block.geometry[i] ^ geometry) |
                    (block.instance[i] ^ instance)) &
                   laneBit(hits, i);
    return differs == 0;
}

/// Returns the active lanes that have a hit.
OSGRAYTRACE_KERNEL
LaneMask hitLanes(const RayHitBlock& block, LaneMask active)
{
    LaneMask hits = 0;
    OSGRAYTRACE_SIMD_OR(hits)
    for (int i = 0; i < kLanes; ++i)
        hits |= bitOfLane(maskOf(block.geometry[i] != kInvalid), i);
    return hits & active;
}

/// Copies the vertices, or the vertex normals, of the first lane to all lanes. The stores are as
/// wide as the later loads.
OSGRAYTRACE_KERNEL
void broadcast(Vec3Lanes& a, Vec3Lanes& b, Vec3Lanes& c)
{
    for (Vec3Lanes* list : {&a, &b, &c})
    {
        const float x = list->x[0], y = list->y[0], z = list->z[0];
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
        {
            list->x[i] = x;
            list->y[i] = y;
            list->z[i] = z;
        }
    }
}

bool isMirrored(const SurfaceRecord& record)
{
    return record.placed && record.placed->mirrored;
}

/// Turns the shading normals and the fronts of lanes whose transform reverses the winding, so that
/// the outside of a body stays its outside.
void turnMirrored(LaneMask lanes, SurfaceLanes& s)
{
    s.front ^= lanes;
    for (const int i : lanesIn(lanes))
        setLane(s.shadingNormal, i, -plainOf(s.shadingNormal, i));
}

/// Sets last to the triangle that the hit of a lane is on.
void setLast(const SurfaceTable& table, const RayHitBlock& block, int lane, LastTriangle& last)
{
    last.geometry = kInvalid; // valid only once all fields are set
    last.instance = block.instance[lane];
    last.primitive = block.primitive[lane];
    last.sceneInstance = hitInstance(block.geometry[lane], block.instance[lane]);
    const SurfaceRecord& record = table[last.sceneInstance];
    TriangleLanes& t = last.lanes;
    last.smooth = loadTriangle(record, last.primitive, 0, t);
    last.mirrored = isMirrored(record);
    last.material = record.material;
    last.plane = planeOf(triangleOf(t, 0), t.transformBound[0]);
    if (last.smooth)
    {
        broadcast(t.a, t.b, t.c);
        broadcast(t.na, t.nb, t.nc);
    }
    last.geometry = block.geometry[lane];
}

/// Returns true if the hit of a lane is on the last triangle.
bool isOn(const LastTriangle& last, const RayHitBlock& block, int lane)
{
    return block.geometry[lane] == last.geometry && block.primitive[lane] == last.primitive &&
           block.instance[lane] == last.instance;
}

/// Turns the normals of mirrored lanes to the outside of the body and interpolates those of smooth
/// lanes. Adds the terminator offsets if start is RayStart::Smooth.
void finishNormals(const RayHitBlock& block, const TriangleLanes& triangles, LaneMask smooth,
                   LaneMask mirrored, RayStart start, SurfaceLanes& surface)
{
    if (mirrored) turnMirrored(mirrored, surface);
    if (!smooth) return;
    interpolateNormals(block, triangles, smooth, surface);
    if (start == RayStart::Smooth) offsetTerminator(block, triangles, smooth, surface);
}

/// Sets the surfaces of a block whose hits are all on one triangle.
void surfacesOfOne(const RayHitBlock& block, const LastTriangle& triangle, RayStart start,
                   SurfaceLanes& surface)
{
    geometryOfOne(block, triangle, surface);
    std::fill_n(surface.instance.v, kLanes, triangle.sceneInstance);
    std::fill_n(surface.material.v, kLanes, triangle.material);
    finishNormals(block, triangle.lanes, triangle.smooth ? kAllLanes : 0,
                  triangle.mirrored ? kAllLanes : 0, start, surface);
}

} // namespace

void surfacesOf(const SurfaceTable& table, const RayHitBlock& block, LaneMask active,
                SurfaceLanes& surface, RayStart start, LastTriangle* last)
{
    OSGRAYTRACE_ASSERT(active <= kAllLanes);
    const LaneMask hits = hitLanes(block, active);
    surface.hits = hits;
    surface.terminatorLanes = 0;
    const int first = hits ? firstLane(hits) : 0;
    if (hits && isOneTriangle(block, hits, first))
    {
        if (last && isOn(*last, block, first)) return surfacesOfOne(block, *last, start, surface);
        LastTriangle local;
        LastTriangle& triangle = last ? *last : local;
        setLast(table, block, first, triangle);
        return surfacesOfOne(block, triangle, start, surface);
    }
    TriangleLanes triangles;
    LaneMask smooth = 0, mirrored = 0;
    if (hits != kAllLanes) clearLanes(triangles, surface.material);
    for (const int i : lanesIn(hits))
    {
        const uint32_t instance = hitInstance(block.geometry[i], block.instance[i]);
        const SurfaceRecord& record = table[instance];
        smooth |= static_cast<LaneMask>(loadTriangle(record, block.primitive[i], i, triangles))
                  << i;
        mirrored |= static_cast<LaneMask>(isMirrored(record)) << i;
        surface.instance[i] = instance;
        surface.material[i] = record.material;
    }
    geometry(block, triangles, surface);
    finishNormals(block, triangles, smooth, mirrored, start, surface);
}

PlainTriangle triangleAt(const SurfaceTable& table, const RayHitBlock& block, int lane)
{
    TriangleLanes triangles;
    const uint32_t instance = hitInstance(block.geometry[lane], block.instance[lane]);
    loadTriangle(table[instance], block.primitive[lane], 0, triangles);
    return triangleOf(triangles, 0);
}

/// Returns the normal that facingNormalLanes sets in lane i.
static OSGRAYTRACE_INLINE PlainVec3 facingNormal(const RayBlock& ray, const SurfaceLanes& surface,
                                                 int i)
{
    const PlainVec3 facet = plainOf(surface.geometricNormal, i);
    const PlainVec3 shading = plainOf(surface.shadingNormal, i);
    const float sign = dot(shading, facet) < 0.0f ? -1.0f : 1.0f;
    const float towards = sign * dot(shading, plainDirection(ray, i));
    return select(maskOf(towards < -1e-4f), shading * sign, facet);
}

OSGRAYTRACE_KERNEL
void facingNormalLanes(const RayBlock& ray, const SurfaceLanes& surface, Vec3Lanes& normal)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        setLane(normal, i, facingNormal(ray, surface, i));
}

} // namespace osgRayTrace::engine
