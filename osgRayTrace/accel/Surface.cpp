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

/// What is read from the meshes, lane by lane; everything after it is arithmetic on lanes.
struct TriangleLanes
{
    Vec3Lanes a, b, c;         ///< vertices, engine space
    Vec3Lanes na, nb, nc;      ///< vertex normals, engine space, any length; zero: geometric normal
    FloatLanes transformBound; ///< magnitude of what was added up to place the vertices; 0 if not placed
};

void store(Vec3Lanes& lanes, int i, Vec3 value)
{
    lanes.x[i] = value.x;
    lanes.y[i] = value.y;
    lanes.z[i] = value.z;
}

float largestOf(Vec3 v) { return std::max(std::fabs(v.x), std::max(std::fabs(v.y), std::fabs(v.z))); }

float transformMagnitude(const Affine& m, Vec3 a, Vec3 b, Vec3 c)
{
    const float vertex = std::max(largestOf(a), std::max(largestOf(b), largestOf(c)));
    const float row = largestOf(m.linear[0]) + largestOf(m.linear[1]) + largestOf(m.linear[2]);
    return vertex * row + largestOf(m.translation);
}

bool loadTriangle(const SurfaceRecord& record, uint32_t primitive, int i, TriangleLanes& lanes)
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
        const Mat3& normalFromLocal = record.placed->normalFromLocal;
        // Interpolation comes after normalisation in OpenGL, so vertex normals keep equal weights here.
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

OSGRAYTRACE_KERNEL
void geometry(const RayHitBlock& block, const TriangleLanes& t, SurfaceLanes& s)
{
    LaneMask front = 0;
    OSGRAYTRACE_SIMD_OR(front)
    for (int i = 0; i < kLanes; ++i)
    {
        const float u = block.u[i], v = block.v[i], w = 1.0f - u - v;
        s.position.x[i] = w * t.a.x[i] + u * t.b.x[i] + v * t.c.x[i];
        s.position.y[i] = w * t.a.y[i] + u * t.b.y[i] + v * t.c.y[i];
        s.position.z[i] = w * t.a.z[i] + u * t.b.z[i] + v * t.c.z[i];

        const float e1x = t.b.x[i] - t.a.x[i], e1y = t.b.y[i] - t.a.y[i], e1z = t.b.z[i] - t.a.z[i];
        const float e2x = t.c.x[i] - t.a.x[i], e2y = t.c.y[i] - t.a.y[i], e2z = t.c.z[i] - t.a.z[i];
        // Edges are scaled to about 1 first, by a power of two: the product of micrometre edges would be
        // denormal.
        const float edge1 = largestOf(e1x, e1y, e1z), edge2 = largestOf(e2x, e2y, e2z);
        const float edge = edge1 > edge2 ? edge1 : edge2;
        const float scale = inversePowerOfTwo(edge);
        const float ax = e1x * scale, ay = e1y * scale, az = e1z * scale;
        const float bx = e2x * scale, by = e2y * scale, bz = e2z * scale;
        const float nx = ay * bz - az * by;
        const float ny = az * bx - ax * bz;
        const float nz = ax * by - ay * bx;
        const float length2 = nx * nx + ny * ny + nz * nz;
        const float inverse = select(length2 > 0.0f, 1.0f / std::sqrt(length2), 0.0f);
        const float cosine = nx * block.ray.directionX[i] + ny * block.ray.directionY[i] +
                             nz * block.ray.directionZ[i];
        const float side = select(cosine > 0.0f, -inverse, inverse);
        s.geometricNormal.x[i] = nx * side;
        s.geometricNormal.y[i] = ny * side;
        s.geometricNormal.z[i] = nz * side;
        s.shadingNormal.x[i] = nx * inverse;
        s.shadingNormal.y[i] = ny * inverse;
        s.shadingNormal.z[i] = nz * inverse;
        front |= bitOfLane(maskOf(cosine <= 0.0f), i);

        const float bound = largestOf(t.a.x[i], t.b.x[i], t.c.x[i]) * std::fabs(nx * inverse) +
                            largestOf(t.a.y[i], t.b.y[i], t.c.y[i]) * std::fabs(ny * inverse) +
                            largestOf(t.a.z[i], t.b.z[i], t.c.z[i]) * std::fabs(nz * inverse);
        s.offset[i] = kOffsetScale * (bound + 2.0f * t.transformBound[i]) + kEdgeScale * edge;
    }
    s.front = front;
}

OSGRAYTRACE_KERNEL
void interpolateNormals(const RayHitBlock& block, const TriangleLanes& t, LaneMask smooth, SurfaceLanes& s)
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

/// One triangle in all lanes, stored as wide as it will be loaded.
OSGRAYTRACE_KERNEL
void broadcast(int from, bool smooth, TriangleLanes& t)
{
    Vec3Lanes* lists[] = {&t.a, &t.b, &t.c, &t.na, &t.nb, &t.nc};
    for (int k = 0; k < (smooth ? 6 : 3); ++k)
    {
        Vec3Lanes& list = *lists[k];
        const float x = list.x[from], y = list.y[from], z = list.z[from];
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
        {
            list.x[i] = x;
            list.y[i] = y;
            list.z[i] = z;
        }
    }
    const float bound = t.transformBound[from];
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        t.transformBound[i] = bound;
}

void clearLane(TriangleLanes& lanes, int i)
{
    store(lanes.a, i, Vec3(0.0f));
    store(lanes.b, i, Vec3(0.0f));
    store(lanes.c, i, Vec3(0.0f));
    lanes.transformBound[i] = 0.0f;
}

bool isMirrored(const SurfaceRecord& record) { return record.placed && record.placed->mirrored; }

/// The outside of a body stays its outside under a transform that reverses the winding.
void turnMirrored(LaneMask lanes, SurfaceLanes& s)
{
    s.front ^= lanes;
    for (; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        s.shadingNormal.x[i] = -s.shadingNormal.x[i];
        s.shadingNormal.y[i] = -s.shadingNormal.y[i];
        s.shadingNormal.z[i] = -s.shadingNormal.z[i];
    }
}

} // namespace

void surfacesOf(const SurfaceTable& table, const RayHitBlock& block, LaneMask active,
                SurfaceLanes& surface)
{
    TriangleLanes triangles;
    const LaneMask hits = hitLanes(block, active);
    LaneMask smooth = 0, mirrored = 0;
    const int first = hits ? __builtin_ctz(hits) : 0;
    if (hits && isOneTriangle(block, hits, first))
    {
        const uint32_t instance = hitInstance(block.geometry[first], block.instance[first]);
        const SurfaceRecord& record = table[instance];
        if (loadTriangle(record, block.primitive[first], first, triangles)) smooth = kAllLanes;
        if (isMirrored(record)) mirrored = kAllLanes;
        broadcast(first, smooth != 0, triangles);
        std::fill_n(surface.instance.v, kLanes, instance);
        std::fill_n(surface.material.v, kLanes, record.material);
    }
    else
    {
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
            smooth |= static_cast<LaneMask>(loadTriangle(record, block.primitive[i], i, triangles)) << i;
            mirrored |= static_cast<LaneMask>(isMirrored(record)) << i;
            surface.instance[i] = instance;
            surface.material[i] = record.material;
        }
    }
    surface.hits = hits;
    geometry(block, triangles, surface);
    if (mirrored) turnMirrored(mirrored, surface);
    if (smooth) interpolateNormals(block, triangles, smooth, surface);
}

Vec2 interpolateUv(const SurfaceRecord& record, uint32_t primitive, float u, float v)
{
    if (!record.uvs) return Vec2(0.0f);
    const UVec3 t = record.triangles[primitive];
    return record.uvs[t.x] * (1.0f - u - v) + record.uvs[t.y] * u + record.uvs[t.z] * v;
}

Vec4 interpolateColor(const SurfaceRecord& record, uint32_t primitive, float u, float v)
{
    if (!record.colors) return Vec4(1.0f);
    const UVec3 t = record.triangles[primitive];
    return record.colors[t.x] * (1.0f - u - v) + record.colors[t.y] * u + record.colors[t.z] * v;
}

} // namespace osgRayTrace::engine
