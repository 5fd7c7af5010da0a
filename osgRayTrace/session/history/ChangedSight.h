// ChangedSight.h - changed boxes and lights as the surfaces of a view see them. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/history/SceneChange.h"
#include "osgRayTrace/session/image/SurfaceMap.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Shadows of more lights than this number are not looked for: nothing is kept.
constexpr std::size_t kMostShadowLights = 32;

/// Each changed box is examined once by itself and once for the shadow that it casts from each
/// light. One such test of a box is called a look. If the changed boxes of a scene take more looks
/// than this number, no pixel of the image keeps samples.
constexpr std::size_t kMostLooks = 1024;

/// If more looks than this number concern a tile, the tile is divided into quarters, and a quarter
/// that more looks concern is divided again, down to single pixels. The division ends earlier when
/// the tile has taken this number of looks for each of its pixels. Pixels of a part that is not
/// divided any more, although more looks concern the part, keep no samples.
constexpr std::size_t kMostTileLooks = 32;

/// A changed box. Places are relative to the pole of a SurfaceMap [world length].
struct SeenBox
{
    Vec3 low, high;
    Vec3 centre;
    float radius = 0.0f;                          ///< of the ball around the box
    float area = 0.0f;                            ///< mean projected area: a quarter of its surface
    int left = 0, bottom = 0, right = 0, top = 0; ///< pixels that its image lies within
};

/// A light that casts shadows: a ball, or a disc infinitely far away.
struct ShadowLight
{
    bool distant = false;
    Vec3 place{0.0f};  ///< centre, relative to the pole; distant: unit direction towards the light
    float size = 0.0f; ///< radius of the ball; distant: sine of the disc's half-angle
};

struct ChangedSight
{
    std::vector<SeenBox> boxes;
    std::vector<ShadowLight> lights;
};

/// Returns the boxes and lights of a change. Environments are not among the lights.
ChangedSight changedSight(const SurfaceMap& map, const Scene& scene,
                          const std::vector<Light>& lights, const SceneChange& change);

/// Returns whether a ray from start crosses the box, grown by so much on all sides, before end
/// lengths of direction.
bool crosses(const SeenBox& box, float grown, Vec3 start, Vec3 direction, float end);

/// Returns false if the box hides no part of the light from any point of the ball.
bool mayShade(const ShadowLight& light, const SeenBox& box, Vec3 centre, float radius);

/// Returns the largest share of the light that the box may hide from the point.
float shadeOf(const ShadowLight& light, const SeenBox& box, Vec3 point);

} // namespace osgRayTrace::engine
