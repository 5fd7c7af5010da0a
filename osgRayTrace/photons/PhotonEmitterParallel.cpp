// PhotonEmitterParallel.cpp - photons from light of one direction at a time: directional lights and
// environments. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonEmitter.h"

#include "osgRayTrace/sampling/Warp.h"
#include "osgRayTrace/shading/SoftLight.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the part of a vector that lies across a unit direction.
Vec3 acrossOf(Vec3 v, Vec3 direction)
{
    return v - direction * glm::dot(v, direction);
}

/// Returns whether the disc of a sphere holds a place across it; across: from the sphere's centre.
bool isInDisc(const Sphere& sphere, Vec3 across)
{
    return glm::dot(across, across) <= sphere.radius * sphere.radius * 1.000002f;
}

} // namespace

/// The discs that the targets' spheres are across any direction.
struct PhotonEmitter::Discs
{
    Discs(const std::vector<Sphere>& targets, const float* weights)
        : count(static_cast<uint32_t>(targets.size()))
    {
        for (uint32_t t = 0; t < count; ++t)
        {
            shares[t] = kPi * targets[t].radius * targets[t].radius * (weights ? weights[t] : 1.0f);
            total += shares[t];
        }
    }

    /// Returns one of the discs, by share; u in [0,1).
    uint32_t choose(float u) const
    {
        float left = u * total;
        uint32_t chosen = 0;
        for (; chosen + 1 < count && left >= shares[chosen]; ++chosen)
            left -= shares[chosen];
        return chosen;
    }

    float shares[kMaxTargets]; ///< of the guided photons: the area, times the target's weight
    uint32_t count;
    float total = 0.0f; ///< of the shares
};

/// Samples a direction in proportion to the environment's radiance, then emits as a directional
/// light there does.
std::optional<PhotonStart> PhotonEmitter::emitEnvironment(const EmissionPoint& point,
                                                          LightGuide guide) const
{
    const EnvironmentSample sample =
        _traced.lights().environment()->sample(point.direction.x, point.direction.y);
    if (!(sample.pdfW > 0.0f)) return std::nullopt;
    return emitParallel(-sample.direction, sample.radiance / sample.pdfW, point, guide);
}

std::optional<PhotonStart> PhotonEmitter::emitDirectional(const Light& light,
                                                          const EmissionPoint& point,
                                                          LightGuide guide) const
{
    const Vec3 direction = isSoft(light) ? softDirection(light, point.direction) : light.direction;
    return emitParallel(direction, light.diffuse * (kPi * softWeight(light.sine)), point, guide);
}

/// Returns the density per area across direction with which emitParallel starts a photon at q.
/// share: of the photons that are guided.
float PhotonEmitter::parallelPdf(Vec3 q, Vec3 direction, const Discs& discs, float share,
                                 LightGuide guide) const
{
    const float sceneArea = kPi * _scene.radius * _scene.radius;
    const bool inScene = isInDisc(_scene, acrossOf(q - _scene.centre, direction));
    float pdf = inScene ? (1.0f - share) / sceneArea : 0.0f;
    if (!(share > 0.0f)) return pdf;
    float inside = 0.0f;
    for (uint32_t t = 0; t < discs.count; ++t)
    {
        const Sphere& target = _targets[t];
        const Vec3 across = acrossOf(q - target.centre, direction);
        if (!isInDisc(target, across)) continue;
        const float area = glm::dot(across, across) / (target.radius * target.radius);
        inside += guide.photonGuide
                      ? guide.photonGuide->weightAt(guide.light, t, direction, across, area)
                      : 1.0f;
    }
    pdf += share * inside / discs.total;
    return pdf;
}

/// Emits light that travels in one direction; irradiance: across that direction.
std::optional<PhotonStart> PhotonEmitter::emitParallel(Vec3 direction, Vec3 irradiance,
                                                       const EmissionPoint& point,
                                                       LightGuide guide) const
{
    if (!(_scene.radius > 0.0f)) return std::nullopt;
    const Discs discs(_targets,
                      guide.photonGuide ? guide.photonGuide->targetWeights(guide.light) : nullptr);
    const float share = discs.total > 0.0f ? _guidedShare : 0.0f;

    PhotonStart start;
    const Sphere* disc = &_scene;
    Vec2 at = point.position; // a turn, and the share of the disc's area
    if (point.choice < share)
    {
        const uint32_t chosen = discs.choose(point.choice / share);
        disc = &_targets[chosen];
        uint32_t bin = guideBinOf(at.x, at.y);
        if (guide.photonGuide) at = guide.photonGuide->sample(guide.light, chosen, at, bin);
        start.bin = binOf(guide, chosen, bin);
    }
    float s, c;
    sinCosTurn(at.x, s, c);
    const float radius = disc->radius * std::sqrt(at.y);
    const Vec3 q = disc->centre + turnedTo(direction, Vec3(radius * c, radius * s, 0.0f));
    const float pdf = parallelPdf(q, direction, discs, share, guide);
    if (!(pdf > 0.0f)) return std::nullopt;
    const Vec3 toCentre = _scene.centre - q;
    start.origin = q + direction * (glm::dot(toCentre, direction) - 2.0f * _scene.radius);
    start.direction = direction;
    start.power = irradiance / pdf;
    return start;
}

} // namespace osgRayTrace::engine
