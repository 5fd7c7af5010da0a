// UpsampleEdges.cpp - blocks of pixels at edges: traces first hits, takes radiance from pixels
// alike. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/upsample/UpsampleEdges.h"

#include "osgRayTrace/integrators/shared/CameraLanes.h"
#include "osgRayTrace/integrators/shared/FirstHit.h"
#include "osgRayTrace/session/upsample/UpsampleLanes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace osgRayTrace::engine
{

namespace
{

/// Least sum of the four weights, which is 1 on a smooth surface: pixels below it are not alike.
constexpr float kLeastWeight = 0.05f;
/// Added to each bilinear weight, so that one alike pixel of the four is enough wherever the lane
/// is.
constexpr float kLeastShare = 0.05f;

constexpr int kSampleFloats = sizeof(SurfaceSample) / sizeof(float);
static_assert(sizeof(SurfaceSample) % sizeof(float) == 0 && offsetof(SurfaceSample, albedo) == 16,
              "samples are read as arrays of floats");

/// Sums means whose weights come one after the other, which are exact if all values are the same.
struct LaneMeans
{
    RgbaLanes rgba;
    Vec3Lanes albedo;
    FloatLanes weight;
};

void clear(LaneMeans& means)
{
    means = {};
    std::fill_n(means.weight.v, kLanes, 1e-30f);
}

OSGRAYTRACE_KERNEL
void inverseWidths(const CameraRays& camera, const RayBlock& ray, const FloatLanes& distance,
                   float scale, FloatLanes& inverseWidth)
{
    const CameraRays c = camera;
    const float across = scale * glm::length(c.directionDx);
    const float orthographic = scale * glm::length(c.originDx);
    const uint32_t isOrthographic = maskOf(c.orthographic);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        // s = distance / |direction|, and the rays start at s = nearS.
        const float inverseLength = c.nearS / ray.tNear[i];
        const float width =
            select(isOrthographic, orthographic, distance[i] * inverseLength * across);
        inverseWidth[i] = 1.0f / width;
    }
}

/// Returns how far the point that the ray of pixel (x, y) met is from the plane of lane i, in
/// widths of a pixel.
OSGRAYTRACE_INLINE float planeOffset(const CameraRays& c, float x, float y, float distance,
                                     const LaneSurfaces& at, int i)
{
    const float rx = c.direction.x + x * c.directionDx.x + y * c.directionDy.x;
    const float ry = c.direction.y + x * c.directionDx.y + y * c.directionDy.y;
    const float rz = c.direction.z + x * c.directionDx.z + y * c.directionDy.z;
    const float s = distance / std::sqrt(rx * rx + ry * ry + rz * rz);
    const float px = c.origin.x + x * c.originDx.x + y * c.originDy.x + s * rx - at.position.x[i];
    const float py = c.origin.y + x * c.originDx.y + y * c.originDy.y + s * ry - at.position.y[i];
    const float pz = c.origin.z + x * c.originDx.z + y * c.originDy.z + s * rz - at.position.z[i];
    return (px * at.geometric.x[i] + py * at.geometric.y[i] + pz * at.geometric.z[i]) *
           at.inverseWidth[i];
}

/// Adds the pixels (dx, dy) away from each lane's first one.
OSGRAYTRACE_KERNEL
void addNeighbours(const UpsampleSource& source, const LanePlaces& place, const LaneSurfaces& at,
                   int dx, int dy, float inverseUnit, LaneMeans& means)
{
    const CameraRays c = source.full.camera;
    const float* samples = &source.samples->normal.x;
    const uint32_t* objects = &source.samples->object;
    const float* radiance = source.image.radiance.data();
    const int width = source.image.width, lastColumn = width - 1, lastRow = source.image.height - 1;
    const float scaleX = source.x.scale, scaleY = source.y.scale;
    const uint32_t right = maskOf(dx != 0), above = maskOf(dy != 0);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        int column = place.column[i] + dx, row = place.row[i] + dy;
        column = column < lastColumn ? column : lastColumn;
        row = row < lastRow ? row : lastRow;
        const int pixel = row * width + column, k = kSampleFloats * pixel, rgba = 4 * pixel;

        const float hitDistance = samples[k + 3] * inverseUnit;
        const float offset = planeOffset(c, (static_cast<float>(column) + 0.5f) * scaleX,
                                         (static_cast<float>(row) + 0.5f) * scaleY,
                                         select(hitDistance < kInfinity, hitDistance, 0.0f), at, i);
        const float cosine = samples[k] * at.normal.x[i] + samples[k + 1] * at.normal.y[i] +
                             samples[k + 2] * at.normal.z[i];

        const uint32_t object = objects[k], own = at.object[i];
        const uint32_t same = maskOf(object == own), neither = maskOf(own == 0u);
        const uint32_t both = maskOf(object != 0u) & ~neither;
        const float alike =
            planeWeight(offset) * normalWeight(cosine) * select(same, 1.0f, kOtherObject);
        const float shareX = select(right, place.shareX[i], 1.0f - place.shareX[i]);
        const float shareY = select(above, place.shareY[i], 1.0f - place.shareY[i]);
        const float share = shareX * shareY + kLeastShare;
        const float weight = share * select(both, alike, select(neither & same, 1.0f, 0.0f));

        const float sum = means.weight[i] + weight, f = weight / sum;
        means.weight[i] = sum;
        means.rgba.r[i] += f * (radiance[rgba] - means.rgba.r[i]);
        means.rgba.g[i] += f * (radiance[rgba + 1] - means.rgba.g[i]);
        means.rgba.b[i] += f * (radiance[rgba + 2] - means.rgba.b[i]);
        means.rgba.a[i] += f * (radiance[rgba + 3] - means.rgba.a[i]);
        means.albedo.x[i] += f * (samples[k + 4] - means.albedo.x[i]);
        means.albedo.y[i] += f * (samples[k + 5] - means.albedo.y[i]);
        means.albedo.z[i] += f * (samples[k + 6] - means.albedo.z[i]);
    }
}

/// Sets rgba to the neighbours' light on the lanes' own surface. Returns the lanes for which that
/// light is not known.
OSGRAYTRACE_KERNEL
LaneMask modulate(const LaneMeans& means, const Vec3Lanes& albedo, RgbaLanes& rgba,
                  LaneMask& unlike)
{
    LaneMask poor = 0, alone = 0;
    OSGRAYTRACE_SIMD_OR(poor)
    for (int i = 0; i < kLanes; ++i)
    {
        const float r = (albedo.x[i] + kLeastAlbedo) / (means.albedo.x[i] + kLeastAlbedo);
        const float g = (albedo.y[i] + kLeastAlbedo) / (means.albedo.y[i] + kLeastAlbedo);
        const float b = (albedo.z[i] + kLeastAlbedo) / (means.albedo.z[i] + kLeastAlbedo);
        const uint32_t known =
            maskOf(means.weight[i] >= kLeastWeight) &
            (maskOf(r < kLargestRatio) | maskOf(means.albedo.x[i] >= kFaintAlbedo)) &
            (maskOf(g < kLargestRatio) | maskOf(means.albedo.y[i] >= kFaintAlbedo)) &
            (maskOf(b < kLargestRatio) | maskOf(means.albedo.z[i] >= kFaintAlbedo));
        rgba.r[i] = means.rgba.r[i] * r;
        rgba.g[i] = means.rgba.g[i] * g;
        rgba.b[i] = means.rgba.b[i] * b;
        rgba.a[i] = means.rgba.a[i];
        poor |= bitOfLane(~known, i);
    }
    OSGRAYTRACE_SIMD_OR(alone)
    for (int i = 0; i < kLanes; ++i)
        alone |= bitOfLane(maskOf(means.weight[i] < kLeastWeight), i);
    unlike = alone;
    return poor;
}

LanePlaces placesOf(const UpsampleSource& source, int left, int bottom)
{
    LanePlaces place;
    for (int i = 0; i < kLanes; ++i)
    {
        const auto x =
            static_cast<std::size_t>(std::min(left + laneX(0, i), source.full.width - 1));
        const auto y =
            static_cast<std::size_t>(std::min(bottom + laneY(0, i), source.full.height - 1));
        place.column[i] = source.x.first[x];
        place.shareX[i] = source.x.share[x];
        place.row[i] = source.y.first[y];
        place.shareY[i] = source.y.share[y];
    }
    return place;
}

} // namespace

void traceUpsampled(const UpsampleSource& source, int left, int bottom, LastTriangle& last,
                    UpsampledBlock& block)
{
    const PassContext& full = source.full;
    FirstHitLanes hits;
    firstHitLanes(full, left, bottom, 0, hits, &last);
    FloatLanes along;
    depthLanes(full.camera, left, bottom, 0, hits.surface, along, block.depth);

    const LanePlaces place = placesOf(source, left, bottom);
    LaneSurfaces at{hits.surface.geometricNormal, hits.normal, hits.albedo,
                    hits.surface.position,        {},          {}};
    for (int i = 0; i < kLanes; ++i)
        at.object[i] = (hits.surface.hits >> i) & 1u ? hits.surface.instance[i] + 1u : 0u;
    inverseWidths(full.camera, hits.rays.ray, hits.rays.ray.tFar, source.x.scale, at.inverseWidth);

    LaneMeans means;
    clear(means);
    const auto inverseUnit = static_cast<float>(1.0 / full.traced->scene().unit);
    for (int k = 0; k < 4; ++k)
        addNeighbours(source, place, at, k & 1, k >> 1, inverseUnit, means);
    const LaneMask poor = modulate(means, hits.albedo, block.rgba, block.unlike);
    for (const int i : lanesIn(poor))
        lookFarther(source, place, at, hits.rays.ray, i, block.rgba);
}

} // namespace osgRayTrace::engine
