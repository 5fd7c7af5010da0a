// Surface.cpp - rebuilds the surface points that a block of rays hit. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/Surface.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kOffsetScale = 32.0f * 0x1p-24f;
constexpr float kEdgeScale = 8.0f * 0x1p-24f;

/// Rays whose cosine is above kMinCosine begin on their very point if the offset is no more than
/// this share of the triangle's edges: the way that they skip, four offsets at most, then hides
/// nothing.
constexpr float kFineOffset = 1e-4f;
constexpr float kMinCosine = 0.25f;
constexpr float kNever = 2.0f;

constexpr float kSmallestTerminatorOffset = 4.0f; ///< [error bounds]
constexpr float kShortestNormal2 = 1e-12f;        ///< squared length below which a normal is none
/// Squared cosine of 40 degrees. A facet that a vertex normal leaves by more is no piece of a
/// smooth surface, but a side of a body whose edges were averaged: two sides of a box make 45
/// degrees.
constexpr float kLargestTurn2 = 0.5868f;

void store(Vec3Lanes& lanes, int i, Vec3 value)
{
    lanes.x[i] = value.x;
    lanes.y[i] = value.y;
    lanes.z[i] = value.z;
}

float largestOf(Vec3 v)
{
    return std::max(std::fabs(v.x), std::max(std::fabs(v.y), std::fabs(v.z)));
}

float transformMagnitude(const Affine& m, Vec3 a, Vec3 b, Vec3 c)
{
    const float vertex = std::max(largestOf(a), std::max(largestOf(b), largestOf(c)));
    const float row = largestOf(m.linear[0]) + largestOf(m.linear[1]) + largestOf(m.linear[2]);
    return vertex * row + largestOf(m.translation);
}

OSGRAYTRACE_INLINE bool loadTriangle(const SurfaceRecord& record, uint32_t primitive, int i,
                                     TriangleLanes& lanes)
{
    const UVec3 t = record.triangles[primitive];
    Vec3 a = record.positions[t.x];
    Vec3 b = record.positions[t.y];
    Vec3 c = record.positions[t.z];
    lanes.transformBound[i] = 0.0f;
    if (record.placed)
    {
        const Affine& m = record.placed->engineFromLocal;
        lanes.transformBound[i] = transformMagnitude(m, a, b, c);
        a = transformPoint(m, a);
        b = transformPoint(m, b);
        c = transformPoint(m, c);
    }
    store(lanes.a, i, a);
    store(lanes.b, i, b);
    store(lanes.c, i, c);
    if (!record.normals) return false;

    Vec3 na = record.normals[t.x];
    Vec3 nb = record.normals[t.y];
    Vec3 nc = record.normals[t.z];
    if (record.placed)
    {
        const Mat3 normalFromLocal = normalMatrix(record.placed->engineFromLocal.linear);
        // Interpolation comes after normalisation in OpenGL, so vertex normals keep equal weights
        // here.
        na = glm::normalize(normalFromLocal * na);
        nb = glm::normalize(normalFromLocal * nb);
        nc = glm::normalize(normalFromLocal * nc);
    }
    store(lanes.na, i, na);
    store(lanes.nb, i, nb);
    store(lanes.nc, i, nc);
    return true;
}

OSGRAYTRACE_INLINE float largestOf(float a, float b, float c)
{
    const float ab = std::fabs(a) > std::fabs(b) ? std::fabs(a) : std::fabs(b);
    return ab > std::fabs(c) ? ab : std::fabs(c);
}

/// 2^-n for x in [2^n, 2^(n+1)), 2^127 for 0.
OSGRAYTRACE_INLINE float inversePowerOfTwo(float x)
{
    uint32_t bits;
    std::memcpy(&bits, &x, sizeof(bits));
    bits = (254u << 23) - (bits & 0x7f800000u);
    float result;
    std::memcpy(&result, &bits, sizeof(result));
    return result;
}

/// The plane of a triangle: its unit normal on the counter-clockwise side, 0 for a triangle without
/// area; and the error bound of points on it. Numbers and no struct: one that is made in a loop
/// over lanes and passed on is kept in memory, lane after lane, and the loop then becomes no vector
/// code.
OSGRAYTRACE_INLINE void planeOf(float ax, float ay, float az, float bx, float by, float bz,
                                float cx, float cy, float cz, float transformBound, float& normalX,
                                float& normalY, float& normalZ, float& offset, float& minCosine)
{
    const float e1x = bx - ax, e1y = by - ay, e1z = bz - az;
    const float e2x = cx - ax, e2y = cy - ay, e2z = cz - az;
    // Edges are scaled to about 1 first, by a power of two: the product of micrometre edges would
    // be denormal.
    const float edge1 = largestOf(e1x, e1y, e1z), edge2 = largestOf(e2x, e2y, e2z);
    const float edge = edge1 > edge2 ? edge1 : edge2;
    const float scale = inversePowerOfTwo(edge);
    const float ux = e1x * scale, uy = e1y * scale, uz = e1z * scale;
    const float vx = e2x * scale, vy = e2y * scale, vz = e2z * scale;
    const float nx = uy * vz - uz * vy;
    const float ny = uz * vx - ux * vz;
    const float nz = ux * vy - uy * vx;
    const float length2 = nx * nx + ny * ny + nz * nz;
    const float inverse = select(length2 > 0.0f, 1.0f / std::sqrt(length2), 0.0f);
    normalX = nx * inverse;
    normalY = ny * inverse;
    normalZ = nz * inverse;
    const float bound = largestOf(ax, bx, cx) * std::fabs(normalX) +
                        largestOf(ay, by, cy) * std::fabs(normalY) +
                        largestOf(az, bz, cz) * std::fabs(normalZ);
    offset = kOffsetScale * (bound + 2.0f * transformBound) + kEdgeScale * edge;
    minCosine = select(offset <= kFineOffset * edge, kMinCosine, kNever);
}

/// Everything about lane i of a surface but its interpolated normal. Returns all bits if the ray
/// comes from the front.
OSGRAYTRACE_INLINE uint32_t setSurface(const RayHitBlock& block, int i, float nx, float ny,
                                       float nz, float offset, float minCosine, float ax, float ay,
                                       float az, float bx, float by, float bz, float cx, float cy,
                                       float cz, SurfaceLanes& s)
{
    const float u = block.u[i], v = block.v[i], w = 1.0f - u - v;
    s.position.x[i] = w * ax + u * bx + v * cx;
    s.position.y[i] = w * ay + u * by + v * cy;
    s.position.z[i] = w * az + u * bz + v * cz;
    const float cosine =
        nx * block.ray.directionX[i] + ny * block.ray.directionY[i] + nz * block.ray.directionZ[i];
    const float side = select(cosine > 0.0f, -1.0f, 1.0f);
    s.geometricNormal.x[i] = nx * side;
    s.geometricNormal.y[i] = ny * side;
    s.geometricNormal.z[i] = nz * side;
    s.shadingNormal.x[i] = nx;
    s.shadingNormal.y[i] = ny;
    s.shadingNormal.z[i] = nz;
    s.offset[i] = offset;
    s.minCosine[i] = minCosine;
    return maskOf(cosine <= 0.0f);
}

OSGRAYTRACE_KERNEL
void geometry(const RayHitBlock& block, const TriangleLanes& t, SurfaceLanes& s)
{
    LaneMask front = 0;
    OSGRAYTRACE_SIMD_OR(front)
    for (int i = 0; i < kLanes; ++i)
    {
        const float ax = t.a.x[i], ay = t.a.y[i], az = t.a.z[i];
        const float bx = t.b.x[i], by = t.b.y[i], bz = t.b.z[i];
        const float cx = t.c.x[i], cy = t.c.y[i], cz = t.c.z[i];
        float nx, ny, nz, offset, minCosine;
        planeOf(ax, ay, az, bx, by, bz, cx, cy, cz, t.transformBound[i], nx, ny, nz, offset,
                minCosine);
        front |= bitOfLane(setSurface(block, i, nx, ny, nz, offset, minCosine, ax, ay, az, bx, by,
                                      bz, cx, cy, cz, s),
                           i);
    }
    s.front = front;
}

/// The same where all hits are on one triangle: one plane for all.
OSGRAYTRACE_KERNEL
void geometryOfOne(const RayHitBlock& block, const LastTriangle& last, SurfaceLanes& s)
{
    const TriangleLanes& t = last.lanes;
    const float ax = t.a.x[0], ay = t.a.y[0], az = t.a.z[0];
    const float bx = t.b.x[0], by = t.b.y[0], bz = t.b.z[0];
    const float cx = t.c.x[0], cy = t.c.y[0], cz = t.c.z[0];
    const float nx = last.normal.x, ny = last.normal.y, nz = last.normal.z;
    const float offset = last.offset, minCosine = last.minCosine;
    LaneMask front = 0;
    OSGRAYTRACE_SIMD_OR(front)
    for (int i = 0; i < kLanes; ++i)
        front |= bitOfLane(setSurface(block, i, nx, ny, nz, offset, minCosine, ax, ay, az, bx, by,
                                      bz, cx, cy, cz, s),
                           i);
    s.front = front;
}

OSGRAYTRACE_KERNEL
void interpolateNormals(const RayHitBlock& block, const TriangleLanes& t, LaneMask smooth,
                        SurfaceLanes& s)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float u = block.u[i], v = block.v[i], w = 1.0f - u - v;
        const float nx = w * t.na.x[i] + u * t.nb.x[i] + v * t.nc.x[i];
        const float ny = w * t.na.y[i] + u * t.nb.y[i] + v * t.nc.y[i];
        const float nz = w * t.na.z[i] + u * t.nb.z[i] + v * t.nc.z[i];
        const float length2 = nx * nx + ny * ny + nz * nz;
        const float inverse = 1.0f / std::sqrt(length2);
        // Opposite normals can cancel: then, and without normals, the geometric one stays.
        const uint32_t use = maskOf(length2 > 1e-12f) & laneBit(smooth, i);
        s.shadingNormal.x[i] = select(use, nx * inverse, s.shadingNormal.x[i]);
        s.shadingNormal.y[i] = select(use, ny * inverse, s.shadingNormal.y[i]);
        s.shadingNormal.z[i] = select(use, nz * inverse, s.shadingNormal.z[i]);
    }
}

/// The terms of the terminator offset that one vertex adds to: how far the point is below the
/// vertex's tangent plane, along its normal n of any length, on the side of the sign.
struct TerminatorOffset
{
    float scale;     ///< times n is the way to the tangent plane; 0 if the point is above it
    uint32_t usable; ///< n is about that of the facet
};

OSGRAYTRACE_INLINE TerminatorOffset terminatorOffset(float px, float py, float pz, float vx,
                                                     float vy, float vz, float nx, float ny,
                                                     float nz, float gx, float gy, float gz)
{
    const float length2 = nx * nx + ny * ny + nz * nz;
    const float cosine = nx * gx + ny * gy + nz * gz;
    const float height = (px - vx) * nx + (py - vy) * ny + (pz - vz) * nz;
    TerminatorOffset result;
    // Both signs change with n: the terminator offset is to the ray's side, where g is, whichever
    // way n looks.
    const float below = select(height * cosine < 0.0f, -height, 0.0f);
    result.usable =
        maskOf(length2 > kShortestNormal2) & maskOf(cosine * cosine > kLargestTurn2 * length2);
    result.scale = below / select(length2 > kShortestNormal2, length2, 1.0f);
    return result;
}

/// Moves points, from where rays start, onto the tangent planes of the vertices, weighted as the
/// vertices are [Hanika21]. On a sphere this is as far above the sphere as the facet is below it,
/// enough for every ray above the plane of the shading normal to clear the facets around. On hollow
/// sides nothing moves.
OSGRAYTRACE_KERNEL
void offsetTerminator(const RayHitBlock& block, const TriangleLanes& t, LaneMask smooth,
                      SurfaceLanes& s)
{
    LaneMask terminatorLanes = 0;
    OSGRAYTRACE_SIMD_OR(terminatorLanes)
    for (int i = 0; i < kLanes; ++i)
    {
        const float u = block.u[i], v = block.v[i], w = 1.0f - u - v;
        const float px = s.position.x[i], py = s.position.y[i], pz = s.position.z[i];
        const float gx = s.geometricNormal.x[i], gy = s.geometricNormal.y[i],
                    gz = s.geometricNormal.z[i];
        const TerminatorOffset a = terminatorOffset(px, py, pz, t.a.x[i], t.a.y[i], t.a.z[i],
                                                    t.na.x[i], t.na.y[i], t.na.z[i], gx, gy, gz);
        const TerminatorOffset b = terminatorOffset(px, py, pz, t.b.x[i], t.b.y[i], t.b.z[i],
                                                    t.nb.x[i], t.nb.y[i], t.nb.z[i], gx, gy, gz);
        const TerminatorOffset c = terminatorOffset(px, py, pz, t.c.x[i], t.c.y[i], t.c.z[i],
                                                    t.nc.x[i], t.nc.y[i], t.nc.z[i], gx, gy, gz);
        const float wa = w * a.scale, wb = u * b.scale, wc = v * c.scale;
        const float x = wa * t.na.x[i] + wb * t.nb.x[i] + wc * t.nc.x[i];
        const float y = wa * t.na.y[i] + wb * t.nb.y[i] + wc * t.nc.y[i];
        const float z = wa * t.na.z[i] + wb * t.nb.z[i] + wc * t.nc.z[i];
        // Less than a few error bounds is rounding, as on flat facets.
        const uint32_t clear =
            maskOf(x * gx + y * gy + z * gz > kSmallestTerminatorOffset * s.offset[i]);
        const uint32_t use = clear & a.usable & b.usable & c.usable & laneBit(smooth, i);
        s.onTriangle.x[i] = px;
        s.onTriangle.y[i] = py;
        s.onTriangle.z[i] = pz;
        s.position.x[i] = px + select(use, x, 0.0f);
        s.position.y[i] = py + select(use, y, 0.0f);
        s.position.z[i] = pz + select(use, z, 0.0f);
        terminatorLanes |= bitOfLane(use, i);
    }
    s.terminatorLanes = terminatorLanes & s.hits;
}

/// True if all hits are on one triangle: the rule where triangles are larger than pixels.
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

OSGRAYTRACE_KERNEL
LaneMask hitLanes(const RayHitBlock& block, LaneMask active)
{
    LaneMask hits = 0;
    OSGRAYTRACE_SIMD_OR(hits)
    for (int i = 0; i < kLanes; ++i)
        hits |= bitOfLane(maskOf(block.geometry[i] != kInvalid), i);
    return hits & active;
}

/// Vertices or their normals of the first lane in all lanes, stored as wide as they will be loaded.
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

void clearLane(TriangleLanes& lanes, int i)
{
    store(lanes.a, i, Vec3(0.0f));
    store(lanes.b, i, Vec3(0.0f));
    store(lanes.c, i, Vec3(0.0f));
    lanes.transformBound[i] = 0.0f;
}

bool isMirrored(const SurfaceRecord& record)
{
    return record.placed && record.placed->mirrored;
}

/// The outside of a body stays its outside under a transform that reverses the winding.
void turnMirrored(LaneMask lanes, SurfaceLanes& s)
{
    s.front ^= lanes;
    for (const int i : lanesIn(lanes))
    {
        s.shadingNormal.x[i] = -s.shadingNormal.x[i];
        s.shadingNormal.y[i] = -s.shadingNormal.y[i];
        s.shadingNormal.z[i] = -s.shadingNormal.z[i];
    }
}

/// Sets last to the triangle that a lane of a block is on.
void setLast(const SurfaceTable& table, const RayHitBlock& block, int lane, LastTriangle& last)
{
    last.geometry = kInvalid; // until it is whole
    last.instance = block.instance[lane];
    last.primitive = block.primitive[lane];
    last.sceneInstance = hitInstance(block.geometry[lane], block.instance[lane]);
    const SurfaceRecord& record = table[last.sceneInstance];
    TriangleLanes& t = last.lanes;
    last.smooth = loadTriangle(record, last.primitive, 0, t);
    last.mirrored = isMirrored(record);
    last.material = record.material;
    planeOf(t.a.x[0], t.a.y[0], t.a.z[0], t.b.x[0], t.b.y[0], t.b.z[0], t.c.x[0], t.c.y[0],
            t.c.z[0], t.transformBound[0], last.normal.x, last.normal.y, last.normal.z, last.offset,
            last.minCosine);
    if (last.smooth)
    {
        broadcast(t.a, t.b, t.c);
        broadcast(t.na, t.nb, t.nc);
    }
    last.geometry = block.geometry[lane];
}

bool isOn(const LastTriangle& last, const RayHitBlock& block, int lane)
{
    return block.geometry[lane] == last.geometry && block.primitive[lane] == last.primitive &&
           block.instance[lane] == last.instance;
}

/// Adds the interpolated normals, on the outside of the body.
void finishNormals(const RayHitBlock& block, const TriangleLanes& triangles, LaneMask smooth,
                   LaneMask mirrored, RayStart start, SurfaceLanes& surface)
{
    if (mirrored) turnMirrored(mirrored, surface);
    if (!smooth) return;
    interpolateNormals(block, triangles, smooth, surface);
    if (start == RayStart::Smooth) offsetTerminator(block, triangles, smooth, surface);
}

/// surfacesOf where all hits are on one triangle.
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
    for (int i = 0; i < kLanes; ++i)
    {
        if (!((hits >> i) & 1u))
        {
            clearLane(triangles, i);
            surface.material[i] = 0;
            continue;
        }
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

OSGRAYTRACE_KERNEL
void facingNormalLanes(const RayBlock& ray, const SurfaceLanes& surface, Vec3Lanes& normal)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float gx = surface.geometricNormal.x[i], gy = surface.geometricNormal.y[i],
                    gz = surface.geometricNormal.z[i];
        const float sx = surface.shadingNormal.x[i], sy = surface.shadingNormal.y[i],
                    sz = surface.shadingNormal.z[i];
        const float sign = sx * gx + sy * gy + sz * gz < 0.0f ? -1.0f : 1.0f;
        const float towards =
            sign * (sx * ray.directionX[i] + sy * ray.directionY[i] + sz * ray.directionZ[i]);
        const bool use = towards < -1e-4f;
        normal.x[i] = select(use, sx * sign, gx);
        normal.y[i] = select(use, sy * sign, gy);
        normal.z[i] = select(use, sz * sign, gz);
    }
}

} // namespace osgRayTrace::engine
