// WhittedTile.h - the data that the parts of Whitted's integrator share. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/FogLanes.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/LightGrid.h"
#include "osgRayTrace/integrators/shared/RayCones.h"
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
    RayCone cone;
    float fogDepth = 0.0f;   ///< see fogOf; in scenes with SceneTraits::fog
    bool fromCamera = false; ///< true: a camera ray that goes on behind blended surfaces
    int layers = 0;          ///< number of blended surfaces passed one after the other
};

/// The number of blocks of camera rays that go through the stages together. The CPU overlaps the
/// independent work of the blocks, and the blocks fit into the first-level cache.
constexpr int kGroup = 4;

/// The materials of the lanes of a block.
struct LaneMaterials
{
    LaneMask diffuse = 0;       ///< physical, constant lanes of Lambert surfaces alone
    LaneMask fixedFunction = 0; ///< lanes that OpenGL's equations light
    LaneMask physical = 0;      ///< other lanes that scatter
    LaneMask transmissive = 0;  ///< lanes lit from behind as well
    LaneMask emissive = 0;      ///< lanes of a colour of their own: emission, fixed-function lanes
    LaneMask partial = 0;       ///< lanes of materials that not every ray meets
    Vec3Lanes normal;           ///< shading normals, towards the ray
    Vec3Lanes albedo;           ///< albedos of diffuse lanes
    Bsdf* bsdfs = nullptr; ///< Bsdfs of physical lanes; also of fixed-function lanes if area lights
                           ///< or an environment shine
    FixedFunctionPoint* points = nullptr; ///< points of fixed-function lanes
};

/// Sixteen rays to be shaded, with their pixels and their weights there.
struct ShadingBlock
{
    RayHitBlock rays;
    SurfaceLanes surface;
    UintLanes seed;
    UintLanes pixel;
    Vec3Lanes weight;
    FloatLanes etaScale; ///< ratio of the weight outside of all glass to weight
    FloatLanes firstU,
        firstV;           ///< first sample on the first area light, see drawFirstPoints
    ConeLanes cones;      ///< set in scenes with SceneTraits::mipmaps
    FloatLanes fogDepths; ///< see fogOf; in scenes with SceneTraits::fog
    FogLanes fog;         ///< fog of the hits; of no lane in scenes without it
    int depth[kLanes];
    int layers[kLanes];      ///< number of blended surfaces, see SecondaryRay
    LaneMask fromCamera = 0; ///< lanes of camera rays, and of those that go on
    LaneMask passed = 0;     ///< lanes whose weight has in part passed a blended surface

    LaneMask dimmed = 0; ///< lanes whose weight media have reduced; see addAir
    Vec3Lanes air;       ///< light that media send along the rays, times their weight

    LaneMaterials materials;
    LightLanes light;   ///< light sample at work
    Vec3Lanes radiance; ///< radiance so far
};

struct WhittedTile
{
    WhittedTile(const PassContext& c, TileResult& r)
        : context(c),
          result(r),
          areaLights(sampledAreaLights(c)),
          deltaLights(sampledDeltaLights(c)),
          samplesTree(engine::samplesTree(c)),
          areaGrid(c, lightSampleCount(c.options)),
          treeGrid(c, kTreePicks * lightSampleCount(c.options)),
          softGrid(c, samplesOfEach(c.options, softLights()))
    {
    }

    /// Returns the number of delta lights with a size.
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

    /// Reduces the coverage of a pixel by the share with which the background shows through.
    void uncover(uint32_t pixel, float share)
    {
        float& alpha = result.rgba[pixel / kLanes].a[pixel % kLanes];
        alpha = std::max(0.0f, alpha - share);
    }

    const PassContext& context;
    TileResult& result;
    SampledLights areaLights, deltaLights; ///< lights that the pass samples
    bool samplesTree;                      ///< the other lights are sampled by the LightTree
    LightGrid areaGrid;                    ///< points on an area light or in the environment
    LightGrid treeGrid, softGrid;          ///< points on lights of the tree, and on suns
    std::vector<SecondaryRay> stack;
    ShadingBlock group[kGroup];
    LastTriangle lastTriangle; ///< last triangle that a block of camera rays met
    std::vector<Bsdf> bsdfs;   ///< kLanes for each block of the group; empty until needed
    std::vector<FixedFunctionPoint> points; ///< kLanes for each block; empty until needed
};

/// Returns the cone with which rays of lane i go on from their hit.
inline RayCone coneOf(const WhittedTile& tile, const ShadingBlock& block, int i)
{
    if (!tile.context.traced->traits().mipmaps) return {};
    return {block.cones.width[i], block.cones.spread[i]};
}

/// Sets the footprints of a block and moves its cones to the hits.
inline void followCones(ShadingBlock& block)
{
    setFootprints(block.rays.ray, block.cones, block.surface);
    moveCones(block.rays.ray, block.surface.hits, block.cones);
}

/// Pushes the mirrored and refracted rays of physical lanes.
void spawn(WhittedTile& tile, const ShadingBlock& block);

/// Multiplies the weights of active lanes by what media leave of light on their rays, and sets air
/// and dimmed. Scenes without SceneTraits::media need no call.
void addAir(WhittedTile& tile, ShadingBlock& block, LaneMask active);

/// Multiplies the weights of active lanes, which are of rays from the eye or by mirrors and glass,
/// by what shadows on the ground leave of what is behind it, and adds these lanes to dimmed. Scenes
/// without SceneTraits::ground need no call.
void passGround(WhittedTile& tile, ShadingBlock& block, LaneMask active);

/// Multiplies visible samples by what media leave of them, in scenes with SceneTraits::media.
void dimSamples(const WhittedTile& tile, LaneMask visible, LightLanes& samples);

/// Pushes rays that go on behind blended lanes, with the weight that the surfaces let through, and
/// leaves the lanes the rest. Returns the lanes whose weight has become less.
LaneMask passThrough(WhittedTile& tile, ShadingBlock& block);

/// Adds a ray to the count of each lane's pixel, if the counts are wanted.
void countRays(WhittedTile& tile, const ShadingBlock& block, LaneMask lanes);

/// Draws the first points of a block on area lights ahead of use. The points take a long chain of
/// operations, which overlaps here with the chains of other blocks, but would overlap with nothing
/// where the points are used.
void drawFirstPoints(const WhittedTile& tile, ShadingBlock& block);

/// Adds the terms that a fixed-function lane gets from a delta light in block.light. light: the
/// lane's; share: factor of the sample; weight: weight of a visible sample's direction.
void addFixedFunctionLight(ShadingBlock& block, const LightLanes& samples, const Light& light,
                           int i, float share, float weight);

/// Adds f cos L V / pdfW of the visible lanes with Bsdfs of any kind, times scale.
void addSampledLight(ShadingBlock& block, const LightLanes& samples, LaneMask visible, float scale);

/// Adds samples of the lights that the LightTree chooses. kTreePicks times as many as a light gets
/// without a tree.
void addTreeLights(WhittedTile& tile, ShadingBlock& block);

/// Adds the light of all lights to some blocks of the group. Fixed-function lanes keep this light
/// in their points.
void addDirectLight(WhittedTile& tile, ShadingBlock* blocks, int count);

inline void addLane(Vec3Lanes& sum, int i, Vec3 value)
{
    sum.x[i] += value.x;
    sum.y[i] += value.y;
    sum.z[i] += value.z;
}

} // namespace osgRayTrace::engine
