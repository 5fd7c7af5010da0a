// FirstHit.cpp - geometry and material seen through the pixel centres. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/FirstHit.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/NormalMaps.h"
#include "osgRayTrace/integrators/shared/CameraLanes.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/RayCones.h"
#include "osgRayTrace/integrators/shared/SeenColors.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the width of the narrowest lobe [radians]: GGX of width alpha falls to a quarter at
/// tan(angle) = alpha [Walter07, eq. 33]. What is seen through a surface moves otherwise, also
/// through a rough one.
float lobeWidth(const MaterialRecord& record, const Bsdf& bsdf)
{
    if (record.material->blended || bsdf.transmits()) return 0.0f;
    if (bsdf.isDiffuse()) return kInfinity;
    const bool coated = bsdf.clearcoat > 0.0f && !bsdf.inside;
    const float alpha = coated ? std::min(bsdf.alpha, bsdf.clearcoatAlpha) : bsdf.alpha;
    return alpha < kSmoothAlpha ? 0.0f : alpha;
}

Bsdf seenBsdf(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface,
              int i)
{
    return context.traced->materials().bsdf(surface.material[i],
                                            materialPoint(context, rays, surface, i));
}

/// Returns whether all points of a surface are without highlights, whatever their colours are.
bool isMatt(const MaterialRecord& record)
{
    return record.fixedFunction && !record.material->hasBack &&
           record.material->specular == Vec3(0.0f) &&
           record.material->vertexColorUse != VertexColorUse::Specular;
}

/// Returns a sample with the members that the material of lane i decides on, but for the albedo.
SurfaceSample seenMaterial(const PassContext& context, const RayHitBlock& rays,
                           const SurfaceLanes& surface, int i)
{
    const MaterialRecord& record = context.traced->materials()[surface.material[i]];
    SurfaceSample sample;
    if (isMatt(record))
    {
        sample.lobe = record.material->blended ? 0.0f : kInfinity;
        return sample;
    }
    const Bsdf bsdf = seenBsdf(context, rays, surface, i);
    const bool spreads = bsdf.diffuse + bsdf.diffuseTransmission != Vec3(0.0f);
    const bool smooth = bsdf.isSmooth() && !bsdf.isDiffuse() && !spreads;
    sample.lobe = lobeWidth(record, bsdf);
    sample.kind = smooth ? SurfaceKind::Smooth : SurfaceKind::Scattering;
    return sample;
}

/// Calls take(lane, value) for all lanes that hit something. If isConstant(record), value(lane) is
/// computed once for a material and side: blocks see few materials, and most materials are the same
/// everywhere.
template <class IsConstant, class ValueOf, class Take>
void forEachMaterial(const PassContext& context, const SurfaceLanes& surface,
                     const IsConstant& isConstant, const ValueOf& valueOf, const Take& take)
{
    const MaterialTable& materials = context.traced->materials();
    uint32_t known = kInvalid;
    bool knownFront = false;
    decltype(valueOf(0)) value{};
    for (const int i : lanesIn(surface.hits))
    {
        const uint32_t material = surface.material[i];
        const bool front = (surface.front >> i) & 1u;
        if (material != known || front != knownFront)
        {
            value = valueOf(i);
            known = isConstant(materials[material]) ? material : kInvalid;
            knownFront = front;
        }
        take(i, value);
    }
}

bool isConstant(const MaterialRecord& record)
{
    return record.constant;
}

bool seesAlike(const MaterialRecord& record)
{
    return record.constant || isMatt(record);
}

void setLobes(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface,
              FloatLanes& lobes)
{
    const MaterialTable& materials = context.traced->materials();
    forEachMaterial(
        context, surface, [](const MaterialRecord& record) { return record.sameLobes; },
        [&](int i)
        {
            const MaterialRecord& record = materials[surface.material[i]];
            if (!record.sameLobes) return lobeWidth(record, seenBsdf(context, rays, surface, i));
            return lobeWidth(record, (surface.front >> i) & 1u ? record.front : record.back);
        },
        [&](int i, float lobe) { lobes[i] = lobe; });
}

OSGRAYTRACE_KERNEL
void setObjects(const SurfaceLanes& surface, SurfaceBlock& seen)
{
    const LaneMask hits = surface.hits;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t hit = laneBit(hits, i);
        seen.normal.x[i] = select(hit, seen.normal.x[i], 0.0f);
        seen.normal.y[i] = select(hit, seen.normal.y[i], 0.0f);
        seen.normal.z[i] = select(hit, seen.normal.z[i], 0.0f);
        seen.lobe[i] = kInfinity;
        seen.object[i] = (surface.instance[i] + 1u) & hit;
    }
}

/// Traces the rays through the pixel centres and sets all of hits but the albedo.
void traceCentres(const PassContext& context, int left, int bottom, int block, HitRule rule,
                  FirstHitLanes& hits, LastTriangle* last = nullptr)
{
    centreRayLanes(context.camera, left, bottom, block, hits.rays);
    context.traced->intersector().closestHits(hits.rays, kAllLanes, Coherence::Coherent, rule);
    surfacesOf(context.traced->surfaces(), hits.rays, kAllLanes, hits.surface, RayStart::Triangle,
               last);
    if (context.traced->traits().normalMaps)
        applyNormalMaps(*context.traced, hits.rays, hits.surface);
    if (context.traced->traits().mipmaps)
    {
        ConeLanes cones;
        cameraCones(context, hits.rays.ray, cones);
        setFootprints(hits.rays.ray, cones, hits.surface);
    }
    facingNormalLanes(hits.rays.ray, hits.surface, hits.normal);
}

void setSamples(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface,
                const Vec3Lanes& normal, SurfaceSample* samples)
{
    const Scene& scene = context.traced->scene();
    constexpr SurfaceSample kNothing{Vec3(0.0f), kInfinity, Vec3(0.0f), 0u};
    Vec3Lanes colors;
    seenColors(context, rays, surface, colors);
    for (const int i : lanesIn(kAllLanes & ~surface.hits))
        samples[i] = kNothing;
    forEachMaterial(
        context, surface, seesAlike, [&](int i) { return seenMaterial(context, rays, surface, i); },
        [&](int i, const SurfaceSample& seen)
        {
            SurfaceSample& sample = samples[i];
            sample = seen;
            sample.albedo = laneOf(colors, i);
            sample.normal = laneOf(normal, i);
            sample.distance = static_cast<float>(rays.ray.tFar[i] * scene.unit);
            sample.object = surface.instance[i] + 1u;
            if (emissionTowardsRay(context, rays, surface, i) != Vec3(0.0f))
                sample.kind = SurfaceKind::Emitting;
        });
}

} // namespace

void firstHitLanes(const PassContext& context, int left, int bottom, int block, FirstHitLanes& hits,
                   LastTriangle* last)
{
    const bool keepsBlended = context.options.integrator == IntegratorKind::Whitted;
    traceCentres(context, left, bottom, block, {true, keepsBlended}, hits, last);
    seenColors(context, hits.rays, hits.surface, hits.albedo);
}

void firstHits(const PassContext& context, int left, int bottom, FirstHit (&hits)[kTilePixels])
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        FirstHitLanes block;
        traceCentres(context, left, bottom, b, kCameraRays, block);
        const SurfaceLanes& surface = block.surface;
        std::fill_n(hits + b * kLanes, kLanes, FirstHit());
        forEachMaterial(
            context, surface, isConstant,
            [&](int i) { return bsdfAlbedo(seenBsdf(context, block.rays, surface, i)); },
            [&](int i, const Vec3& albedo)
            {
                FirstHit& hit = hits[b * kLanes + i];
                hit.hit = true;
                hit.distance = block.rays.ray.tFar[i];
                hit.normal = laneOf(block.normal, i);
                hit.albedo = albedo;
                hit.position = laneOf(surface.position, i);
                hit.instance = surface.instance[i];
            });
    }
}

void firstSamples(const PassContext& context, int left, int bottom,
                  SurfaceSample (&samples)[kTilePixels])
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        FirstHitLanes block;
        traceCentres(context, left, bottom, b, kCameraRays, block);
        setSamples(context, block.rays, block.surface, block.normal, samples + b * kLanes);
    }
}

namespace
{

void setSurfaces(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface,
                 const FloatLanes& along, SurfaceBlock& seen)
{
    seen.along = along;
    facingNormalLanes(rays.ray, surface, seen.normal);
    setObjects(surface, seen);
    setLobes(context, rays, surface, seen.lobe);
}

} // namespace

/// Records the samples of a block. The function is not inlined, because most passes want no samples
/// and shall not pay for its stack.
[[gnu::noinline]] static void recordSamples(const PassContext& context, int block,
                                            const RayHitBlock& rays, const SurfaceLanes& surface,
                                            FirstHitOutputs& outputs)
{
    Vec3Lanes normal;
    facingNormalLanes(rays.ray, surface, normal);
    setSamples(context, rays, surface, normal, outputs.samples + block * kLanes);
}

static void recordHits(const PassContext& context, int left, int bottom, int block,
                       const RayHitBlock& rays, const SurfaceLanes& surface,
                       FirstHitOutputs& outputs)
{
    FloatLanes along;
    depthLanes(context.camera, left, bottom, block, surface, along, outputs.depth + block * kLanes);
    if (outputs.surfaces) setSurfaces(context, rays, surface, along, outputs.surfaces[block]);
    if (outputs.samples) recordSamples(context, block, rays, surface, outputs);
}

/// Records what is seen through the middle of the lens: rays through other points of the lens meet
/// what a pinhole does not show in their pixel.
[[gnu::noinline]] static void recordWithoutLens(const PassContext& context, int left, int bottom,
                                                int block, FirstHitOutputs& outputs)
{
    FirstHitLanes hits;
    traceCentres(context, left, bottom, block, kCameraRays, hits);
    recordHits(context, left, bottom, block, hits.rays, hits.surface, outputs);
}

void recordFirstHits(const PassContext& context, int left, int bottom, int block,
                     const RayHitBlock& rays, const SurfaceLanes& surface, FirstHitOutputs& outputs)
{
    if (!context.wantsDepth) return;
    if (context.camera.hasLens())
        recordWithoutLens(context, left, bottom, block, outputs);
    else
        recordHits(context, left, bottom, block, rays, surface, outputs);
}

void firstSurfaces(const PassContext& context, int left, int bottom, int block, SurfaceBlock& seen)
{
    FirstHitLanes hits;
    traceCentres(context, left, bottom, block, kCameraRays, hits);
    FloatLanes along, depth;
    depthLanes(context.camera, left, bottom, block, hits.surface, along, depth.v);
    setSurfaces(context, hits.rays, hits.surface, along, seen);
}

} // namespace osgRayTrace::engine
