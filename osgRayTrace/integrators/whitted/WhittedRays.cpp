// WhittedRays.cpp - rays that go on from a surface: mirrored, refracted, behind blended layers.
// Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/whitted/WhittedTile.h"

namespace osgRayTrace::engine
{

namespace
{

/// Mirror and refracted rays of a smaller weight than this cannot be seen in 8 bits. The weight
/// outside of all glass counts, because weights inside glass are 1/eta^2 of the weights after the
/// ray has left the glass.
constexpr float kSmallestWeight = 1.0f / 1024.0f;

/// The number of blended surfaces behind which the next one is taken as opaque. Without this limit,
/// a ray would meet the same surface without end if coordinates are so large that no offset clears
/// the surface.
constexpr int kMostLayers = 256;

void push(WhittedTile& tile, const ShadingBlock& block, int i, Vec3 direction, Vec3 weight,
          float etaScale)
{
    const float largest = std::max(weight.x, std::max(weight.y, weight.z));
    if (!(largest * etaScale >= kSmallestWeight)) return;
    tile.stack.push_back({leaveFacet(block.surface, i, direction), direction, weight, etaScale,
                          block.pixel[i], hash(block.seed[i] + 0x9e3779b9u), block.depth[i] + 1,
                          coneOf(tile, block, i), block.fogDepths[i]});
}

} // namespace

void spawn(WhittedTile& tile, const ShadingBlock& block)
{
    const LaneMaterials& m = block.materials;
    for (const int i : lanesIn(m.physical))
    {
        if (block.depth[i] >= tile.context.options.maxBounces) continue;
        const ShadingFrame frame(laneOf(m.normal, i));
        const Vec3 wo = frame.toLocal(-directionOf(block.rays.ray, i));
        const SpecularLobes lobes = specularLobes(m.bsdfs[i], wo);
        const bool fogged = (block.fog.lanes >> i) & 1u;
        const Vec3 weight = laneOf(block.weight, i) * (fogged ? block.fog.share[i] : 1.0f);
        const float etaScale = block.etaScale[i];
        const Vec3 geometric = laneOf(block.surface.geometricNormal, i);
        const Vec3 mirrored = frame.toWorld(Vec3(-wo.x, -wo.y, wo.z));
        if (lobes.reflection != Vec3(0.0f) && isAboveFacet(block.surface, i, mirrored))
            push(tile, block, i, mirrored, weight * lobes.reflection, etaScale);
        const Vec3 fromCoat = frame.toWorld(lobes.coatMirrored);
        if (lobes.coat != Vec3(0.0f) && isAboveFacet(block.surface, i, fromCoat))
            push(tile, block, i, fromCoat, weight * lobes.coat, etaScale);
        if (lobes.refraction == Vec3(0.0f)) continue;
        const Vec3 refracted = frame.toWorld(lobes.refracted);
        const float eta = m.bsdfs[i].transmittedEta();
        if (glm::dot(refracted, geometric) < 0.0f)
            push(tile, block, i, refracted, weight * lobes.refraction, etaScale * eta * eta);
    }
}

LaneMask passThrough(WhittedTile& tile, ShadingBlock& block)
{
    const MaterialTable& materials = tile.context.traced->materials();
    LaneMask passed = 0;
    for (const int i : lanesIn(block.materials.partial))
    {
        const uint32_t material = block.surface.material[i];
        if (!materials[material].material->blended) continue;
        if (block.layers[i] >= kMostLayers) continue;
        const float opacity =
            materials.opacity(material, materialPoint(tile.context, block.rays, block.surface, i));
        const Vec3 weight = laneOf(block.weight, i);
        setLane(block.weight, i, weight * opacity);
        if (opacity >= 1.0f) continue;
        passed |= 1u << i;
        const Vec3 direction = directionOf(block.rays.ray, i);
        const Vec3 normal = laneOf(block.surface.geometricNormal, i);
        const Vec3 origin =
            laneOf(trianglePoints(block.surface), i) - normal * block.surface.offset[i];
        const Vec3 behind = weight * (1.0f - opacity);
        const float largest = std::max(behind.x, std::max(behind.y, behind.z));
        const bool fromCamera = (block.fromCamera >> i) & 1u;
        // A camera ray is never left out, because its share would be missing in the coverage.
        if (!fromCamera && !(largest * block.etaScale[i] >= kSmallestWeight)) continue;
        tile.stack.push_back({{origin, 0.0f},
                              direction,
                              behind,
                              block.etaScale[i],
                              block.pixel[i],
                              hash(block.seed[i] + 0x85ebca6bu),
                              block.depth[i],
                              coneOf(tile, block, i),
                              block.fogDepths[i],
                              fromCamera,
                              block.layers[i] + 1});
    }
    return passed;
}

} // namespace osgRayTrace::engine
