// DenoiseSurfaces.cpp - surfaces made from samples, and cells of 2 x 2 pixels made from surfaces.
// Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseSurfaces.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Below this albedo, light over albedo would be more noise than light.
constexpr float kLeastAlbedo = 0.02f;

} // namespace

OSGRAYTRACE_KERNEL
void findScattering(const SurfaceSample* samples, int count, uint8_t* __restrict scatters)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const SurfaceSample& s = samples[i];
        const float length =
            s.normal.x * s.normal.x + s.normal.y * s.normal.y + s.normal.z * s.normal.z;
        const uint32_t known = maskOf(s.kind == SurfaceKind::Scattering) &
                               maskOf(s.distance < kNoSurface) & maskOf(length > 0.5f) &
                               maskOf(length < 2.0f) &
                               maskOf(s.albedo.x + s.albedo.y + s.albedo.z < kNoSurface);
        scatters[i] = static_cast<uint8_t>(known & 1u);
    }
}

OSGRAYTRACE_KERNEL
void unpack(const SurfaceSample* samples, ScatterRows scatters, int count, SurfaceRow row)
{
    const uint8_t *below = scatters.below, *here = scatters.here, *above = scatters.above;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const SurfaceSample& s = samples[i];
        const int scattering = below[i - 1] & below[i] & below[i + 1] & here[i - 1] & here[i] &
                               here[i + 1] & above[i - 1] & above[i] & above[i + 1];
        const uint32_t known = maskOf(scattering != 0);
        row.normalX[i] = select(known, s.normal.x, 0.0f);
        row.normalY[i] = select(known, s.normal.y, 0.0f);
        row.normalZ[i] = select(known, s.normal.z, 0.0f);
        row.distance[i] = select(known, s.distance, kNoSurface);
    }
    for (int i = count; i < kSurfaceSegment; ++i)
    {
        row.normalX[i] = row.normalY[i] = row.normalZ[i] = 0.0f;
        row.distance[i] = kNoSurface;
    }
}

OSGRAYTRACE_KERNEL
void unpackAlbedo(const SurfaceSample* samples, const float* distance, int count,
                  float* __restrict r, float* __restrict g, float* __restrict b)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const SurfaceSample& s = samples[i];
        const uint32_t known = maskOf(distance[i] < kNoSurface);
        r[i] = select(known, s.albedo.x > kLeastAlbedo ? s.albedo.x : kLeastAlbedo, 0.0f);
        g[i] = select(known, s.albedo.y > kLeastAlbedo ? s.albedo.y : kLeastAlbedo, 0.0f);
        b[i] = select(known, s.albedo.z > kLeastAlbedo ? s.albedo.z : kLeastAlbedo, 0.0f);
    }
}

OSGRAYTRACE_KERNEL
void makeCells(const Surfaces& s, int count, SurfaceRow cells, uint8_t* __restrict inCell0,
               uint8_t* __restrict inCell1)
{
    constexpr float kAlike = 2.0f; // fallOff's argument for normals within 10 degrees
    OSGRAYTRACE_SIMD
    for (int c = 0; c < count; ++c)
    {
        const float nx[4] = {s.normalX[0][2 * c], s.normalX[0][2 * c + 1], s.normalX[1][2 * c],
                             s.normalX[1][2 * c + 1]};
        const float ny[4] = {s.normalY[0][2 * c], s.normalY[0][2 * c + 1], s.normalY[1][2 * c],
                             s.normalY[1][2 * c + 1]};
        const float nz[4] = {s.normalZ[0][2 * c], s.normalZ[0][2 * c + 1], s.normalZ[1][2 * c],
                             s.normalZ[1][2 * c + 1]};
        const float d[4] = {s.distance[0][2 * c], s.distance[0][2 * c + 1], s.distance[1][2 * c],
                            s.distance[1][2 * c + 1]};
        float fx = nx[3], fy = ny[3], fz = nz[3], fd = d[3];
        for (int i = 2; i >= 0; --i)
        {
            const uint32_t known = maskOf(d[i] < kNoSurface);
            fx = select(known, nx[i], fx);
            fy = select(known, ny[i], fy);
            fz = select(known, nz[i], fz);
            fd = select(known, d[i], fd);
        }
        float sumX = 0.0f, sumY = 0.0f, sumZ = 0.0f, sumD = 0.0f, sum = 0.0f;
        float share[4];
        for (int i = 0; i < 4; ++i)
        {
            const uint32_t same = maskOf(d[i] < kNoSurface) &
                                  maskOf(normalDistance(fx, fy, fz, nx[i], ny[i], nz[i]) < kAlike) &
                                  maskOf(std::fabs(d[i] - fd) < 5.0f * kDistanceTolerance * fd);
            share[i] = select(same, 1.0f, 0.0f);
            sumX += share[i] * nx[i];
            sumY += share[i] * ny[i];
            sumZ += share[i] * nz[i];
            sumD += select(same, d[i], 0.0f);
            sum += share[i];
        }
        const float length = std::sqrt(sumX * sumX + sumY * sumY + sumZ * sumZ);
        const float scale = length > 0.0f ? 1.0f / length : 0.0f;
        cells.normalX[c] = sumX * scale;
        cells.normalY[c] = sumY * scale;
        cells.normalZ[c] = sumZ * scale;
        cells.distance[c] = sum > 0.0f ? sumD / sum : kNoSurface;
        inCell0[2 * c] = static_cast<uint8_t>(share[0]);
        inCell0[2 * c + 1] = static_cast<uint8_t>(share[1]);
        inCell1[2 * c] = static_cast<uint8_t>(share[2]);
        inCell1[2 * c + 1] = static_cast<uint8_t>(share[3]);
    }
}

} // namespace osgRayTrace::engine
