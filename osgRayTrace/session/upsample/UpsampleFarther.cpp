// UpsampleFarther.cpp - lanes at edges whose neighbours are unlike take radiance from farther
// pixels. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/upsample/UpsampleLanes.h"

#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the background as the image has it: linear.
Vec3 behind(const PassContext& context, const RayBlock& ray, int i)
{
    const Vec3 radiance = radianceBehind(context, ray, i);
    if (!context.traced->scene().displayReferred) return radiance;
    return Vec3(linearFromSrgb(radiance.x), linearFromSrgb(radiance.y), linearFromSrgb(radiance.z));
}

/// Returns how much the surface that a pixel of the image sees is like that of lane i; never 0, so
/// that no lane is black.
float likeness(const UpsampleSource& source, const LaneSurfaces& at, int i,
               const SurfaceSample& sample, int column, int row)
{
    if (at.object[i] == 0 && sample.object == 0) return 1.0f;
    if (at.object[i] == 0 || sample.object == 0) return 1e-12f;
    const CameraRays& c = source.full.camera;
    const auto unit = static_cast<float>(source.full.traced->scene().unit);
    const float x = (static_cast<float>(column) + 0.5f) * source.x.scale;
    const float y = (static_cast<float>(row) + 0.5f) * source.y.scale;
    const Vec3 direction = c.direction + x * c.directionDx + y * c.directionDy;
    const Vec3 start = c.origin + x * c.originDx + y * c.originDy;
    const Vec3 hit = start + sample.distance / unit * glm::normalize(direction);
    const float offset =
        glm::dot(hit - laneOf(at.position, i), laneOf(at.geometric, i)) * at.inverseWidth[i];
    const float own = sample.object == at.object[i] ? 1.0f : kOtherObject;
    const float cosine = glm::dot(sample.normal, laneOf(at.normal, i));
    const float alike = 1e-9f + own * (1e-6f + planeWeight(offset) * normalWeight(cosine));
    // White parts tell more about the light than black parts.
    return alike * (kLeastAlbedo + std::max({sample.albedo.x, sample.albedo.y, sample.albedo.z}));
}

} // namespace

void lookFarther(const UpsampleSource& source, const LanePlaces& place, const LaneSurfaces& at,
                 const RayBlock& ray, int i, RgbaLanes& rgba)
{
    constexpr int kReach = 2;
    const ResolvedImage& image = source.image;
    const Vec3 albedo = laneOf(at.albedo, i);
    Vec4 mean(0.0f);
    Vec3 meanAlbedo(0.0f);
    float sum = 1e-30f;
    for (int row = std::max(0, place.row[i] - kReach);
         row <= std::min(image.height - 1, place.row[i] + 1 + kReach); ++row)
    {
        for (int column = std::max(0, place.column[i] - kReach);
             column <= std::min(image.width - 1, place.column[i] + 1 + kReach); ++column)
        {
            const auto pixel =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                static_cast<std::size_t>(column);
            const SurfaceSample& sample = source.samples[pixel];
            const float dx = static_cast<float>(column - place.column[i]) - place.shareX[i];
            const float dy = static_cast<float>(row - place.row[i]) - place.shareY[i];
            const float alike = likeness(source, at, i, sample, column, row);
            const float d2 = dx * dx + dy * dy;
            const float weight = alike / ((1.0f + d2) * (1.0f + d2));
            sum += weight;
            const float f = weight / sum;
            const float* in = &image.radiance[4 * pixel];
            mean += f * (Vec4(in[0], in[1], in[2], in[3]) - mean);
            meanAlbedo += f * (sample.albedo - meanAlbedo);
        }
    }
    if (at.object[i] == 0 && sum < 1e-6f) // this is a gap that no pixel of the image looks through
    {
        const bool seen = visibleEnvironment(source.full) != nullptr;
        mean = seen ? Vec4(behind(source.full, ray, i), 1.0f) : Vec4(0.0f);
    }
    Vec3 ratio(1.0f);
    if (at.object[i] != 0)
        ratio = glm::min((albedo + kLeastAlbedo) / (meanAlbedo + kLeastAlbedo),
                         Vec3(8.0f * kLargestRatio));
    rgba.r[i] = mean.x * ratio.x;
    rgba.g[i] = mean.y * ratio.y;
    rgba.b[i] = mean.z * ratio.z;
    rgba.a[i] = mean.w;
}

} // namespace osgRayTrace::engine
