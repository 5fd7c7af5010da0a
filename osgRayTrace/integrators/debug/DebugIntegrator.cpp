// DebugIntegrator.cpp - shows what the other integrators work with. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/debug/DebugIntegrator.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/NormalMaps.h"
#include "osgRayTrace/accel/SurfaceAttributes.h"
#include "osgRayTrace/integrators/shared/CameraLanes.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/IntegratorChoice.h"
#include "osgRayTrace/integrators/shared/RayCones.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

Vec3 idColor(uint32_t id)
{
    const uint32_t bits = hash(id + 1u);
    return Vec3(bits & 255u, (bits >> 8) & 255u, (bits >> 16) & 255u) * (1.0f / 255.0f);
}

Vec3 albedo(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface, int i)
{
    const uint32_t material = surface.material[i];
    const MaterialPoint point = materialPoint(context, rays, surface, i);
    return bsdfAlbedo(context.traced->materials().bsdf(material, point)) +
           emissionTowardsRay(context, rays, surface, i);
}

Vec3 uvColor(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface,
             int i)
{
    const SurfaceRecord& record = context.traced->surfaces()[surface.instance[i]];
    const Vec2 uv = interpolateUv(record, rays.primitive[i], rays.u[i], rays.v[i]);
    return Vec3(uv.x - std::floor(uv.x), uv.y - std::floor(uv.y), 0.0f);
}

Vec3 channelColor(const PassContext& context, const RayHitBlock& rays, const SurfaceLanes& surface,
                  int i, float depth)
{
    switch (context.options.debugChannel)
    {
    case DebugChannel::Normal:
        return facingNormal(rays, surface, i) * 0.5f + 0.5f;
    case DebugChannel::Uv:
        return uvColor(context, rays, surface, i);
    case DebugChannel::Id:
        return idColor(surface.instance[i]);
    case DebugChannel::Albedo:
        return albedo(context, rays, surface, i);
    case DebugChannel::Depth:
        return Vec3(depth);
    case DebugChannel::Dropped:
    case DebugChannel::Cost:
        break;
    }
    return Vec3(0.0f);
}

} // namespace

/// Renders with the integrator that AUTOMATIC chooses and shows the rays or dropped samples that it
/// counted.
void DebugIntegrator::showDiagnostics(const PassContext& context, int left, int bottom,
                                      TileResult& result) const
{
    constexpr float kFullCost = 64.0f;
    PassContext inner = context;
    inner.options.integrator =
        chooseIntegrator(IntegratorKind::Automatic, context.traced->traits());
    DebugOutputs debug;
    result.debug = &debug;
    _newIntegrator(inner.options.integrator)->renderTile(inner, left, bottom, result);
    result.debug = nullptr;
    const bool cost = context.options.debugChannel == DebugChannel::Cost;
    for (int pixel = 0; pixel < kTilePixels; ++pixel)
    {
        const float value = cost ? debug.rays[pixel] / kFullCost : debug.dropped[pixel];
        RgbaLanes& block = result.rgba[pixel / kLanes];
        block.r[pixel % kLanes] = block.g[pixel % kLanes] = block.b[pixel % kLanes] = value;
        block.a[pixel % kLanes] = 1.0f;
    }
}

void DebugIntegrator::renderTile(const PassContext& context, int left, int bottom,
                                 TileResult& result) const
{
    const DebugChannel channel = context.options.debugChannel;
    if (channel == DebugChannel::Cost || channel == DebugChannel::Dropped)
    {
        showDiagnostics(context, left, bottom, result);
        return;
    }
    for (int b = 0; b < kTileBlocks; ++b)
    {
        RayHitBlock rays;
        UintLanes seeds;
        SurfaceLanes surface;
        FloatLanes along;
        alignas(64) float depth[kLanes];
        cameraRayLanes(context.camera, context.key, left, bottom, b, false, rays, seeds);
        context.traced->intersector().closestHits(rays, kAllLanes, Coherence::Coherent,
                                                  kCameraRays);
        result.counts.cameraRays += kLanes;
        surfacesOf(context.traced->surfaces(), rays, kAllLanes, surface);
        if (context.traced->traits().normalMaps) applyNormalMaps(*context.traced, rays, surface);
        if (context.traced->traits().mipmaps)
        {
            ConeLanes cones;
            cameraCones(context, rays.ray, cones);
            setFootprints(rays.ray, cones, surface);
        }
        depthLanes(context.camera, left, bottom, b, surface, along, depth);
        for (int i = 0; i < kLanes; ++i)
        {
            const bool hit = (surface.hits >> i) & 1u;
            const Vec3 color = hit ? channelColor(context, rays, surface, i, depth[i]) : Vec3(0.0f);
            result.rgba[b].r[i] = color.x;
            result.rgba[b].g[i] = color.y;
            result.rgba[b].b[i] = color.z;
            result.rgba[b].a[i] = hit ? 1.0f : 0.0f;
            result.firstHits.depth[b * kLanes + i] = depth[i];
        }
    }
}

} // namespace osgRayTrace::engine
