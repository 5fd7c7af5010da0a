// WhittedTile.h - what the parts of Whitted's integrator share: a tile at work, blocks of rays.
// Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/LightGrid.h"
#include "osgRayTrace/integrators/shared/SampledLights.h"
#include "osgRayTrace/integrators/shared/ShadowLanes.h"
#include "osgRayTrace/integrators/whitted/FixedFunctionLighting.h"

#include <algorithm>
#include <vector>

namespace osgRayTrace::engine
{

struct SecondaryRay
{
    RayBegin begin;
    Vec3 direction, weight;
    float etaScale;
    uint32_t pixel;
    uint32_t seed;
    int depth;
    bool fromCamera = false; ///< a camera ray that goes on behind blended surfaces
    int layers = 0;          ///< blended surfaces that it has passed one after the other
};

/// Blocks of camera rays that are taken through the stages together: independent work for the CPU
/// to overlap, small enough for the first-level cache.
constexpr int kGroup = 4;

/// What the lanes of a block are made of.
struct LaneMaterials
{
    LaneMask diffuse = 0;       ///< physical, constant, Lambert only
    LaneMask fixedFunction = 0; ///< lit by OpenGL's equations
    LaneMask physical = 0;      ///< the other ones that scatter
    LaneMask transmissive = 0;  ///< lit from behind as well
    LaneMask emissive = 0;      ///< with a colour of their own: emission, fixed-function lanes
    Vec3Lanes normal;           ///< shading, towards the ray
    Vec3Lanes albedo;           ///< of diffuse lanes
    Bsdf* bsdfs = nullptr;      ///< of physical lanes, and of fixed-function ones below area lights
    FixedFunctionPoint* points = nullptr; ///< of fixed-function lanes
};

/// Sixteen rays to be shaded, with what they count for in which pixel.
struct ShadingBlock
{
    RayHitBlock rays;
    SurfaceLanes surface;
    UintLanes seed;
    UintLanes pixel;
    Vec3Lanes weight;
    FloatLanes etaScale; ///< weight outside of glass over weight
    FloatLanes firstU,
        firstV; ///< first sample on the first area light: drawn early, see drawFirstPoints
    int depth[kLanes];
    int layers[kLanes];      ///< see SecondaryRay
    LaneMask fromCamera = 0; ///< camera rays, and those that go on
    LaneMask passed = 0;     ///< a part of the weight has gone on through a blended surface

    LaneMaterials materials;
    LightLanes light;   ///< the sample at work
    Vec3Lanes radiance; ///< so far
};

struct WhittedTile
{
    WhittedTile(const PassContext& c, TileResult& r)
        : context(c),
          result(r),
          areaLights(sampledAreaLights(c)),
          deltaLights(sampledDeltaLights(c)),
          areaGrid(c, areaLights.size()),
          environmentGrid(c, 1),
          softGrid(c, softLights())
    {
    }

    /// Of the delta lights, those with a size.
    std::size_t softLights() const
    {
        std::size_t count = 0;
        for (std::size_t k = 0; k < deltaLights.size(); ++k)
            count += isSoft((*context.lights)[deltaLights[k].light]);
        return count;
    }

    void add(uint32_t pixel, Vec3 radiance)
    {
        RgbaLanes& block = result.rgba[pixel / kLanes];
        block.r[pixel % kLanes] += radiance.x;
        block.g[pixel % kLanes] += radiance.y;
        block.b[pixel % kLanes] += radiance.z;
    }

    /// What is behind shows through by so much.
    void uncover(uint32_t pixel, float share)
    {
        float& alpha = result.rgba[pixel / kLanes].a[pixel % kLanes];
        alpha = std::max(0.0f, alpha - share);
    }

    const PassContext& context;
    TileResult& result;
    SampledLights areaLights, deltaLights; ///< of the pass
    LightGrid areaGrid, environmentGrid, softGrid;
    std::vector<SecondaryRay> stack;
    ShadingBlock group[kGroup];
    LastTriangle lastTriangle; ///< that a block of camera rays met
    std::vector<Bsdf> bsdfs;   ///< kLanes for each block of the group; empty until needed
    std::vector<FixedFunctionPoint> points; ///< the same
};

/// Adds to the count of the lanes' pixels, if it is wanted.
void countRays(WhittedTile& tile, const ShadingBlock& block, LaneMask lanes);

/// The first points of a block on area lights, ahead of use: they are a long chain of operations,
/// which overlaps with those of other blocks here and with nothing where it is needed.
void drawFirstPoints(const WhittedTile& tile, ShadingBlock& block);

/// Adds what the lights send to some blocks of the group; fixed-function lanes keep theirs in their
/// points.
void addDirectLight(WhittedTile& tile, ShadingBlock* blocks, int count);

inline void addLane(Vec3Lanes& sum, int i, Vec3 value)
{
    sum.x[i] += value.x;
    sum.y[i] += value.y;
    sum.z[i] += value.z;
}

} // namespace osgRayTrace::engine
