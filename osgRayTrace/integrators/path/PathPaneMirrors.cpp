// PathPaneMirrors.cpp - the sky that panes mirror, as a light. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// A pane in a window mirrors the sun onto the sill outside. Rays of the sill find this light by
// chance alone: the sun takes some 1e-5 of their directions, so that a pixel, or sixteen that share
// the path, is a thousand times too bright. But the panes of openings are known (PortalPanes.h) and
// flat. So surfaces z before them take a sample omega of the sky and send a ray towards its image
// omega' = omega - 2 (omega n) n, where n is the normal of the panes. If the ray meets such a pane
// first, light comes from there:
//
//   L_z = f cosTheta R L(omega) V / p_sky(omega)
//
// The image has the density of the sample, as mirrors keep solid angles. Paths that leave z, meet
// the pane in the same way, and then the sky, add nothing where samples do. These take the sun and
// what is about as bright, kLeastPdfW: no other technique weighs L / p_sky, which has no bound
// where the density, that of what exceeds the sky's mean, goes towards 0.
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/Panes.h"
#include "osgRayTrace/integrators/shared/ShadowLanes.h"
#include "osgRayTrace/integrators/shared/SkyPortals.h"
#include "osgRayTrace/shading/LayeredBsdf.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kFlat = 1.0f - 1e-6f; ///< least cosine between normals that differ by rounding only

/// The least density of directions that are sampled [1/sr]. Paths find all others: they are not so
/// much brighter than the mean that chance would be a bad way.
constexpr float kLeastPdfW = 1.0f;

/// The dimensions of a side's samples lie apart from those of bounces and other samples of the sky.
constexpr uint32_t kMirrorDimension = 0x100000u;

Vec3 mirrored(Vec3 direction, Vec3 normal)
{
    return direction - normal * (2.0f * glm::dot(direction, normal));
}

/// Returns the lanes that sample what the panes of a side mirror: not those of narrow lobes, as
/// chance is the better way there.
LaneMask lanesBefore(const Tile& tile, const Bounce& bounce, const PaneSide& side)
{
    if (bounce.number + 2 > tile.context.options.maxBounces) return 0;
    LaneMask lanes = 0;
    const LaneMask narrow = bounce.smooth | glossyLanes(bounce);
    for (const int i : lanesIn(bounce.diffuse | (bounce.general & ~narrow)))
        lanes |= static_cast<LaneMask>(side.has(laneOf(bounce.surface.position, i))) << i;
    return lanes;
}

/// Returns the number of the side whose panes mirror the ray of lane i at its surface, and sets
/// what is left of the BSDF there; -1: none does.
int mirrorOf(const Tile& tile, const RayBlock& ray, const SurfaceLanes& surface, int i, Bsdf& bsdf)
{
    const MaterialRecord& record = tile.context.traced->materials()[surface.material[i]];
    if (!record.pane || !record.constant) return -1;
    const float flat =
        glm::dot(laneOf(surface.shadingNormal, i), laneOf(surface.geometricNormal, i));
    if (!(std::fabs(flat) > kFlat)) return -1;
    bsdf = (surface.front >> i) & 1u ? record.front : record.back;
    dropStraightLobe(bsdf);
    const bool mirrorsAlone = bsdf.isSmooth() && bsdf.diffuse == Vec3(0.0f) &&
                              bsdf.diffuseTransmission == Vec3(0.0f) && bsdf.sheen == Vec3(0.0f) &&
                              !(bsdf.clearcoat > 0.0f) && !bsdf.needsAxes();
    if (!mirrorsAlone) return -1;
    return paneSideOf(tile.context.portals->panes(), laneOf(surface.geometricNormal, i),
                      directionOf(ray, i));
}

/// Sends the rays towards images of the sky, and sets the light that panes mirror to them.
void lookIntoPanes(Tile& tile, int side, RayHitBlock& rays, LaneMask sent, LightLanes& samples)
{
    const PassContext& context = tile.context;
    const TracedScene& traced = *context.traced;
    const PlacedEnvironment& environment = *traced.lights().shiningEnvironment();
    traced.intersector().closestHits(rays, sent, Coherence::Incoherent);
    tile.counts.shadowRays += static_cast<uint64_t>(countLanes(sent));
    SurfaceLanes surface;
    surfacesOf(traced.surfaces(), rays, sent, surface, rayStart(context.options));
    Vec3Lanes normal;
    facingNormalLanes(rays.ray, surface, normal);
    for (const int i : lanesIn(surface.hits & sent))
    {
        Bsdf bsdf;
        if (mirrorOf(tile, rays.ray, surface, i, bsdf) != side) continue;
        const ShadingFrame frame(laneOf(normal, i));
        const auto mirrored =
            sampleBsdf(bsdf, frame.toLocal(-directionOf(rays.ray, i)), 0.0f, 0.5f, 0.5f);
        if (!mirrored || !mirrored->delta || mirrored->transmitted) continue;
        const Vec3 direction = frame.toWorld(mirrored->wi);
        if (!isAboveFacet(surface, i, direction)) continue;
        const Vec3 light = environment.radiance(direction) * mirrored->weight * mirrored->pdfW;
        for (int c = 0; c < 3; ++c)
            samples.radiance[c][i] = light[c];
        setRay(samples.shadow, i, leaveFacet(surface, i, direction), direction, kInfinity);
        samples.lit |= 1u << i;
    }
}

} // namespace

void samplePaneMirrors(Tile& tile, PathBlock& block, const Bounce& bounce, const UintLanes& seeds)
{
    const PassContext& context = tile.context;
    const PlacedEnvironment& environment = *context.traced->lights().shiningEnvironment();
    const std::vector<PaneSide>& sides = context.portals->panes();
    for (std::size_t k = 0; k < sides.size(); ++k)
    {
        const LaneMask lanes = lanesBefore(tile, bounce, sides[k]);
        if (!lanes) continue;
        FloatLanes u, v;
        dimensionPoints(seeds, context.key.index,
                        bounceDimension(bounce.number, DimensionLightPoint) +
                            kMirrorDimension * static_cast<uint32_t>(k + 1),
                        u, v);
        RayHitBlock rays;
        LightLanes samples;
        LaneMask sent = 0;
        for (const int i : lanesIn(lanes))
        {
            const SkySample sky = sampleSky(context, environment, {u[i], v[i]}, false);
            if (!(sky.pdfW > kLeastPdfW) || !(glm::dot(sky.direction, sides[k].normal) > 0.0f))
                continue;
            const Vec3 image = mirrored(sky.direction, sides[k].normal);
            const bool anySide = ((bounce.transmissive | bounce.surface.terminatorLanes) >> i) & 1u;
            if (!anySide && !(glm::dot(laneOf(bounce.surface.geometricNormal, i), image) > 0.0f))
                continue;
            setSample(samples, i, image, Vec3(0.0f), 1.0f / sky.pdfW);
            setRay(rays.ray, i, leave(bounce.surface, i, image), image, kInfinity);
            sent |= 1u << i;
        }
        if (!sent) continue;
        countRays(tile, block, sent);
        lookIntoPanes(tile, static_cast<int>(k), rays, sent, samples);
        const LaneMask visible = visibleLanes(context, samples, tile.counts);
        addLight(tile, block, bounce, samples, visible, kAllLanes);
    }
}

PaneMarks paneMarks(const Tile& tile, const PathBlock& block, const Bounce& bounce)
{
    const PassContext& context = tile.context;
    const std::vector<PaneSide>& sides = context.portals->panes();
    PaneMarks marks;
    for (std::size_t k = 0; k < sides.size(); ++k)
        for (const int i : lanesIn(lanesBefore(tile, bounce, sides[k])))
            marks.sides[i] |= 1u << k;
    for (const int i : lanesIn(bounce.general & ~bounce.behindPanes))
    {
        const uint32_t sampled = block.flagsOf(i).paneSides();
        if (!sampled) continue;
        Bsdf bsdf;
        const int side = mirrorOf(tile, block.rays.ray, bounce.surface, i, bsdf);
        if (side < 0 || !((sampled >> side) & 1u)) continue;
        const Vec3 towards =
            mirrored(directionOf(block.rays.ray, i), sides[static_cast<std::size_t>(side)].normal);
        const float pdfW =
            environmentPdfW(context, *context.traced->lights().shiningEnvironment(), towards);
        marks.mirrored |= static_cast<LaneMask>(pdfW > kLeastPdfW) << i;
    }
    return marks;
}

void markPanes(const PaneMarks& marks, PathBlock& block)
{
    for (const int i : lanesIn(block.active))
        if (block.pdfW[i] < kInfinity)
            block.flags[i] = block.flagsOf(i).withPaneSides(marks.sides[i]).word();
        else if ((marks.mirrored >> i) & 1u)
            block.flags[i] = block.flagsOf(i).mirroredSky().word();
}

} // namespace osgRayTrace::engine
