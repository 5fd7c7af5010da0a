// ChunkSubsurface.cpp - photons that walk below diffuse boundaries: skin, wax. Layer: photons.
// SPDX-License-Identifier: MIT
//
// Photons are stored where they land, and paths from the eye look them up where their walks leave a
// body (PathSubsurface.cpp). So photons walk only to go on elsewhere: with the probability p that a
// sample of the whole surface would have been one of its base, or else by the other lobes, with 1 /
// (1 - p). The adjoint of A(wo) A(wi) / A_avg has A_avg where the path from the eye leaves, which
// is where the photon enters:
//
//   power' = power A(wi) share / (A_avg p) |wi.n| / |wi.g|   where it enters
//   weight = A(wo)                                           where it leaves, by the cosine law
//
// Share and base colour are those of the place where light leaves, for paths from the eye begin
// their walks there. If textures decide on them, that place is not known where the photon enters:
// the walk is that of the largest share s and colour c of the material, and the weight of a walk of
// n collisions then has the factor
//
//   share / s (albedo(base colour) / albedo(c))^n  <= 1
//
// The share is that of MaterialDetail::subsurface. What metal leaves to the base, Bsdf::baseShare,
// counts where the photon enters, and walks go back below metal: SubsurfaceWalk.cpp.
//
// The radius is that of the place where the photon enters. That is another one than for paths if a
// texture of the radius varies, and moves some of the light that leaves such bodies.
//
// leaveSurfaces() corrects for the shading normals of one surface as if the photon had come to it
// along the end of its walk: what it does with that direction is divided out before.
#include "osgRayTrace/photons/ChunkTracer.h"

#include "osgRayTrace/accel/Bodies.h"
#include "osgRayTrace/accel/MergeHits.h"
#include "osgRayTrace/accel/NormalMaps.h"
#include "osgRayTrace/accel/SubsurfaceWalk.h"
#include "osgRayTrace/accel/SurfaceAttributes.h"
#include "osgRayTrace/accel/SurfaceTangents.h"
#include "osgRayTrace/shading/LayeredBsdf.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns |w.n| / |w.g|, 1 where it is not finite.
float shadingFactor(Vec3 w, Vec3 normal, Vec3 geometric)
{
    const float factor = std::fabs(glm::dot(w, normal) / glm::dot(w, geometric));
    return factor < kInfinity && factor > 0.0f ? factor : 1.0f;
}

Vec3 toLocal(Vec3 w, Vec3 normal)
{
    Vec3 tangent, bitangent;
    frameOf(normal.x, normal.y, normal.z, tangent, bitangent);
    return {glm::dot(w, tangent), glm::dot(w, bitangent), glm::dot(w, normal)};
}

float largestOf(Vec3 v)
{
    return std::max(v.x, std::max(v.y, v.z));
}

Vec3 albedoOf(Vec3 color)
{
    Vec3 albedo;
    for (int c = 0; c < 3; ++c)
        albedo[c] = static_cast<float>(albedoOfColor(double(color[c]), 0.0));
    return albedo;
}

/// Returns the parts of a surface of which no point has a larger share or colour. The probability
/// leaves what the surface scatters by itself, local, its chance.
SubsurfaceSplit largestSplit(const MaterialRecord& record, const Bsdf& whole, const Bsdf& local,
                             Vec3 wo, Vec3 walks)
{
    Bsdf largest = whole;
    largest.subsurface = record.largestSubsurface;
    largest.diffuse = record.largestBodyColor * whole.baseShare;
    SubsurfaceSplit split = splitSubsurface(largest, wo, walks);
    const float below = luminance(largest.diffuse * largest.subsurface * walks);
    if (below > 0.0f)
        split.probability *= luminance(largest.diffuse) / (below + luminance(local.diffuse));
    return split;
}

/// Returns the factor of a walk with the largest share and colour of a material, for one that
/// leaves at a surface of that material.
Vec3 factorOfPlace(const MaterialRecord& record, const Bsdf& place, uint32_t collisions)
{
    if (!(luminance(place.diffuse) > 0.0f)) return Vec3(0.0f); // paths do not walk there
    const Vec3 ratio = albedoOf(glm::clamp(place.diffuse / place.baseShare, 0.0f, 1.0f)) /
                       glm::max(albedoOf(record.largestBodyColor), 1e-30f);
    const float share = place.subsurface / std::max(record.largestSubsurface, 1e-30f);
    return glm::pow(glm::min(ratio, 1.0f), Vec3(static_cast<float>(collisions))) * share;
}

} // namespace

/// Holds walks of photons that come to places where light leaves bodies.
struct ChunkTracer::BodyWalks
{
    RayHitBlock leaving;       ///< see meetFromOutside
    uint32_t material[kLanes]; ///< below which the walk has begun
    uint32_t collisions[kLanes];
    Bsdf surfaces[kLanes]; ///< those of MaterialRecord::subsurfaceVaries there
};

/// Takes the photon of a lane below its surface, by chance, or leaves it the surface's other lobes.
/// Returns whether it has come to a place where it leaves the body, which is in the lane of walks.
bool ChunkTracer::walkBelowSurface(PhotonPathBlock& block, const SurfaceLanes& surface, int i,
                                   int bounce, BodyWalks& walks)
{
    const Vec3 normal = laneOf(_normal, i), geometric = laneOf(surface.geometricNormal, i);
    const Vec3 direction = laneOf(block.direction, i), power = laneOf(block.power, i);
    Bsdf whole = *_bsdfs[i];
    if (whole.needsAxes()) alignLayers(_inputs.traced, _rays, surface, i, normal, whole);
    const MaterialRecord& record = _inputs.materials[surface.material[i]];
    SubsurfaceEntry entry;
    entry.sigma = record.radiusVaries
                      ? _inputs.materials.subsurfaceSigma(surface.material[i], pointAt(surface, i))
                      : record.subsurfaceSigma;
    entry.offset = surface.offset[i];
    const Vec3 wo = toLocal(-direction, normal);
    const Vec3 channels = walkingChannels(entry.sigma, entry.offset);
    const SubsurfaceSplit split = splitSubsurface(whole, wo, channels);
    const SubsurfaceSplit walking =
        record.subsurfaceVaries ? largestSplit(record, whole, split.local, wo, channels) : split;
    const float p = walking.probability;
    if (!(p > 0.0f)) return false;
    constexpr uint32_t kBelow = 0x736b696eu; // tells these numbers from all others
    const uint32_t key =
        hash(dimension(hash(kBelow, static_cast<uint32_t>(bounce))), block.photon[i]);
    if (!(unitFloat(key) < p))
    {
        setLane(block.power, i, power / (1.0f - p));
        _textured[i] = split.local;
        _bsdfs[i] = &_textured[i];
        _aligned |= 1u << i;
        return false;
    }
    const Vec3 entering = power * walking.entering *
                          (shadingFactor(direction, normal, geometric) / (whole.baseAverage * p));
    entry.position = laneOf(trianglePoints(surface), i);
    entry.normal = geometric;
    entry.color = walking.color;
    entry.throughput = entering;
    entry.least = largestOf(power);
    entry.key = hash(key, 1u);
    entry.direction = Vec2(unitFloat(hash(key, 2u)), unitFloat(hash(key, 3u)));
    const SubsurfaceWalk walk = walkBelow(_inputs.traced, entry);
    _chunk.rays += walk.rays;
    _chunk.cutWalks += walk.end == SubsurfaceWalk::End::Cut;
    setLane(block.power, i, walk.throughput);
    switch (walk.end)
    {
    case SubsurfaceWalk::End::Left:
        meetFromOutside(walk, walks.leaving, i);
        walks.material[i] = surface.material[i];
        walks.collisions[i] = walk.collisions;
        if (record.subsurfaceVaries) walks.surfaces[i] = whole;
        return true;
    case SubsurfaceWalk::End::Open:
        ++_chunk.openWalks;
        _textured[i] = split.leaving;
        _textured[i].diffuse = split.color * whole.baseAverage;
        _bsdfs[i] = &_textured[i];
        _aligned |= 1u << i;
        setLane(block.power, i,
                entering *
                    (record.subsurfaceVaries ? factorOfPlace(record, whole, 0) : Vec3(1.0f)) /
                    shadingFactor(direction, normal, geometric));
        return false;
    default:
        _general &= ~(1u << i);
        return false;
    }
}

/// Sets the surfaces of lanes to those at which their photons leave bodies.
void ChunkTracer::leaveBodies(PhotonPathBlock& block, const BodyWalks& walks, LaneMask lanes,
                              SurfaceLanes& surface)
{
    const TracedScene& traced = _inputs.traced;
    const RayHitBlock& leaving = walks.leaving;
    SurfaceLanes found;
    surfacesOf(traced.surfaces(), leaving, lanes, found);
    if (traced.traits().normalMaps) applyNormalMaps(traced, leaving, found);
    Vec3Lanes normals;
    facingNormalLanes(leaving.ray, found, normals);
    mergeHits(leaving, found, lanes, _rays, surface);
    for (const int i : lanesIn(lanes))
    {
        const Vec3 inwards(leaving.ray.directionX[i], leaving.ray.directionY[i],
                           leaving.ray.directionZ[i]);
        _rays.ray.directionX[i] = inwards.x;
        _rays.ray.directionY[i] = inwards.y;
        _rays.ray.directionZ[i] = inwards.z;
        setLane(block.direction, i, inwards);
        const Vec3 normal = laneOf(normals, i);
        setLane(block.power, i,
                laneOf(block.power, i) /
                    shadingFactor(inwards, normal, laneOf(surface.geometricNormal, i)));
        const MaterialRecord& record = traced.materials()[surface.material[i]];
        const Bsdf place = record.constant
                               ? record.front
                               : traced.materials().bsdf(surface.material[i], pointAt(surface, i));
        const MaterialRecord& begun = traced.materials()[walks.material[i]];
        if (begun.subsurfaceVaries) // within bodies of several materials, those of the entry count
            setLane(block.power, i,
                    laneOf(block.power, i) *
                        factorOfPlace(begun, &begun == &record ? place : walks.surfaces[i],
                                      walks.collisions[i]));
        _textured[i] = leavingBody(place);
        if (_textured[i].needsAxes()) alignLayers(traced, _rays, surface, i, normal, _textured[i]);
        _textured[i].diffuse = Vec3(_textured[i].baseAverage);
        _bsdfs[i] = &_textured[i];
        if (!traced.media().hasInteriors()) continue;
        const Vec3 before = laneOf(trianglePoints(surface), i) +
                            laneOf(surface.geometricNormal, i) * surface.offset[i];
        block.bodies[i] = bodiesAround(traced, before).word();
    }
    _aligned |= lanes;
    _oneSided &= ~lanes;
    _seen &= ~lanes;
}

/// Takes photons to where their light leaves the bodies of surfaces with diffuse boundaries.
void ChunkTracer::walkBelowSurfaces(PhotonPathBlock& block, SurfaceLanes& surface, int bounce)
{
    LaneMask entering = 0;
    for (const int i : lanesIn(_general & ~mirrorsOnly(bounce)))
        if (_inputs.materials[surface.material[i]].subsurface && ((surface.front >> i) & 1u) != 0)
            entering |= 1u << i;
    if (!entering) return;
    facingNormalLanes(_rays.ray, surface, _normal);
    BodyWalks walks;
    walks.leaving.ray = _rays.ray;
    std::fill(std::begin(walks.leaving.geometry.v), std::end(walks.leaving.geometry.v), kInvalid);
    LaneMask left = 0;
    for (const int i : lanesIn(entering))
        left |= static_cast<LaneMask>(walkBelowSurface(block, surface, i, bounce, walks)) << i;
    if (left) leaveBodies(block, walks, left, surface);
}

} // namespace osgRayTrace::engine
