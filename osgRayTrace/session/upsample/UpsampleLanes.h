// UpsampleLanes.h - a block of pixels at edges, and how much surfaces are alike. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/session/upsample/UpsampleSource.h"

namespace osgRayTrace::engine
{

/// Albedos are increased by this before they are divided: see Upsample.h.
constexpr float kLeastAlbedo = 1e-4f;
/// Light on a surface that reflects this many times more than its neighbours is not known from
/// them if they reflect less than kFaintAlbedo: what they send may be no reflection of that light.
constexpr float kLargestRatio = 4.0f;
constexpr float kFaintAlbedo = 0.02f;
/// Weight of a neighbour of another object in the same plane.
constexpr float kOtherObject = 0.02f;
/// Distance from the plane, in widths of a pixel of the image, from which a neighbour belongs to
/// another surface.
constexpr float kPlane = 1.0f;

/// Tells which pixels of the image the lanes are between.
struct LanePlaces
{
    Lanes<int> column, row;    ///< pixel below on the left
    FloatLanes shareX, shareY; ///< shares of the other pixels
};

/// Holds the surfaces that the lanes themselves see.
struct LaneSurfaces
{
    const Vec3Lanes& geometric;
    const Vec3Lanes& normal;
    const Vec3Lanes& albedo;
    Vec3Lanes position;      ///< place in engine space
    FloatLanes inverseWidth; ///< inverse width of a pixel of the image at the hit [1/length]
    UintLanes object;        ///< object, as in SurfaceSample
};

OSGRAYTRACE_INLINE float planeWeight(float offsetInPixels)
{
    const float x = offsetInPixels * (1.0f / kPlane);
    const float f = 1.0f - x * x;
    const float inside = select(f > 0.0f, f, 0.0f);
    return inside * inside * inside;
}

OSGRAYTRACE_INLINE float normalWeight(float cosine)
{
    const float c = select(cosine > 0.0f, cosine, 0.0f);
    const float c2 = c * c, c4 = c2 * c2;
    return c4 * c4;
}

/// Computes one lane from pixels farther away, however unlike: the most alike pixels count most,
/// then the nearest.
void lookFarther(const UpsampleSource& source, const LanePlaces& place, const LaneSurfaces& at,
                 const RayBlock& ray, int i, RgbaLanes& rgba);

} // namespace osgRayTrace::engine
