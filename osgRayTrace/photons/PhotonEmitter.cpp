// PhotonEmitter.cpp - photons as they leave the lights. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonEmitter.h"

#include "osgRayTrace/accel/Bodies.h"
#include "osgRayTrace/sampling/Warp.h"
#include "osgRayTrace/shading/SoftLight.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

std::size_t pick(const std::vector<float>& cumulative, float u)
{
    return static_cast<std::size_t>(std::upper_bound(cumulative.begin(), cumulative.end() - 1, u) -
                                    cumulative.begin());
}

/// Returns the smallest sphere that holds both.
Sphere around(const Sphere& a, const Sphere& b)
{
    const float apart = glm::length(b.centre - a.centre);
    if (apart + b.radius <= a.radius) return a;
    if (apart + a.radius <= b.radius) return b;
    const float radius = 0.5f * (apart + a.radius + b.radius);
    return {a.centre + (b.centre - a.centre) * ((radius - a.radius) / apart), radius * 1.000001f};
}

/// Returns the bodies in which the lights of a scene are, by light; empty if there are no bodies.
std::vector<MediumStack> bodiesOfLights(const TracedScene& traced, const std::vector<Light>& lights)
{
    const Scene& scene = traced.scene();
    const auto fills = [&](std::size_t m)
    { return traced.media().interiorOf(static_cast<uint32_t>(m)) != kOutside; };
    bool any = false;
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        any |= fills(m);
    if (!any) return {};
    std::vector<MediumStack> bodies(lights.size());
    for (const uint32_t i : traced.lights().lightsInSpace())
    {
        if (lights[i].kind == LightKind::Point)
            bodies[i] = bodiesAround(traced, lights[i].position);
        else if (lights[i].kind == LightKind::Parallelogram || lights[i].kind == LightKind::Mesh)
            if (const auto on = traced.lights().samplePoint(i, 0.5f, 0.5f))
                bodies[i] = bodiesAround(traced, on->position + on->normal * on->offset);
    }
    return bodies;
}

} // namespace

/// The cones that hold the targets as seen from a point; a target around the point has none.
struct PhotonEmitter::Cones
{
    struct Cone
    {
        Vec3 axis;
        float oneMinusCosine;
        float share; ///< share of the guided photons: 1 - cosine, times the target's weight
        uint32_t target;
    };

    /// Returns one of the cones, by share; u in [0,1).
    const Cone& choose(float u) const
    {
        float at = u * total;
        for (int i = 0; i < count - 1; ++i)
        {
            if (at < cones[i].share) return cones[i];
            at -= cones[i].share;
        }
        return cones[count - 1];
    }

    /// Samples a direction within a cone, and sets bin to the direction's bin within the cone.
    Vec3 sample(const Cone& cone, LightGuide guide, Vec2 u, uint32_t& bin) const
    {
        if (guide.photonGuide)
            u = guide.photonGuide->sample(guide.light, cone.target, u, bin);
        else
            bin = guideBinOf(u.x, u.y);
        return turnedTo(cone.axis, squareToCone(u, cone.oneMinusCosine));
    }

    /// Returns the density of the guided part of the mixture [1/sr].
    float pdf(LightGuide guide, Vec3 direction) const
    {
        float inside = 0.0f;
        for (int i = 0; i < count; ++i)
        {
            const Cone& cone = cones[i];
            const Vec3 off = direction - cone.axis; // |off|^2 / 2 = 1 - cosine
            const float height = 0.5f * glm::dot(off, off);
            if (!(height <= cone.oneMinusCosine)) continue;
            inside += guide.photonGuide
                          ? guide.photonGuide->weightAt(guide.light, cone.target, cone.axis,
                                                        direction, height / cone.oneMinusCosine)
                          : 1.0f;
        }
        return inside / (2.0f * kPi * total);
    }

    Cone cones[kMaxTargets];
    int count = 0;
    float total = 0.0f; ///< of the shares
};

PhotonEmitter::PhotonEmitter(const TracedScene& traced, const std::vector<Light>& lights,
                             float guidedShare, PhotonUse use)
    : _traced(traced), _lights(lights), _guidedShare(guidedShare)
{
    PhotonTargets targets = photonTargets(traced, use, kMaxTargets);
    _scene = targets.scene;
    _targets = std::move(targets.spheres);
    if (_targets.empty()) _guidedShare = 0.0f;
    if (traced.traits().media)
    {
        const MediumTable& media = traced.media();
        // Light from far away collides in the whole of the medium around all bodies.
        if (!media[kOutside].isClear) _scene = around(_scene, {media.centre(), media.radius()});
        if (traced.grids().size() > 0)
        {
            Vec3 low(kInfinity), high(-kInfinity);
            traced.grids().widen(low, high);
            _scene = around(_scene, {0.5f * (low + high), 0.5f * glm::length(high - low)});
        }
        _bodies = bodiesOfLights(traced, lights);
    }

    // Lights are chosen in proportion to power. The power of point and directional lights is what
    // they send into the scene. Groups of lights that a PhotonGuide does not tell apart are
    // clusters in space.
    std::vector<double> powers;
    double total = 0.0;
    for (const uint32_t i : traced.lights().lightsInSpace())
    {
        const Light& light = lights[i];
        double power = 0.0;
        switch (light.kind)
        {
        case LightKind::Parallelogram:
        case LightKind::Mesh:
            power = double(luminance(light.radiance)) * traced.lights().area(i) * kPi *
                    (light.twoSided || light.kind == LightKind::Mesh ? 2.0 : 1.0);
            break;
        case LightKind::Point:
        {
            const double solidAngle = 2.0 * kPi * (1.0 - std::max(-1.0f, light.spotCosCutoff));
            const double distance = std::max(_scene.radius, 1e-30f);
            power =
                double(luminance(light.diffuse)) * kPi * solidAngle * falloff(i, float(distance));
            break;
        }
        case LightKind::Directional:
            power = double(luminance(light.diffuse)) * kPi * kPi * double(_scene.radius) *
                    _scene.radius;
            break;
        case LightKind::Environment:
        {
            const PlacedEnvironment* environment = traced.lights().shiningEnvironment();
            if (environment && environment->light() == i)
                power = double(luminance(environment->integral())) * kPi * double(_scene.radius) *
                        _scene.radius;
            break;
        }
        }
        if (!(power > 0.0) || !std::isfinite(power)) continue;
        _emitters.push_back(i);
        powers.push_back(power);
        total += power;
    }
    double sum = 0.0;
    for (const double power : powers)
        _cumulative.push_back(static_cast<float>((sum += power) / total));
    if (!_cumulative.empty()) _cumulative.back() = 1.0f;
}

std::optional<PhotonStart> PhotonEmitter::emit(const EmissionPoint& point,
                                               const PhotonGuide* photonGuide) const
{
    if (_cumulative.empty()) return std::nullopt;
    const std::vector<float>& cumulative = photonGuide ? photonGuide->cumulative() : _cumulative;
    const std::size_t chosen = pick(cumulative, point.light);
    const float pmf = cumulative[chosen] - (chosen ? cumulative[chosen - 1] : 0.0f);
    const uint32_t light = _emitters[chosen];
    const LightGuide guide{photonGuide, PhotonGuide::lightOf(chosen, _emitters.size())};
    std::optional<PhotonStart> start;
    switch (_lights[light].kind)
    {
    case LightKind::Parallelogram:
    case LightKind::Mesh:
        start = emitArea(light, point, guide);
        break;
    case LightKind::Point:
        start = emitPoint(light, point, guide);
        break;
    case LightKind::Directional:
        start = emitDirectional(_lights[light], point, guide);
        break;
    case LightKind::Environment:
        start = emitEnvironment(point, guide);
        break;
    }
    if (!start || !(pmf > 0.0f)) return std::nullopt;
    start->power /= pmf;
    start->light = light;
    if (!isFinite(start->power) || !isFinite(start->direction) || !isFinite(start->origin))
        return std::nullopt;
    return start;
}

float PhotonEmitter::falloff(uint32_t index, float distance) const
{
    const Light& light = _lights[index];
    if (light.kind != LightKind::Point) return 1.0f;
    const float denominator = light.attenuationConstant + light.attenuationLinear * distance +
                              light.attenuationQuadratic * distance * distance;
    if (!(denominator > 0.0f)) return 0.0f;
    const float falloff = distance * distance / denominator;
    return light.range > 0.0f ? falloff * rangeTerm(light, distance) : falloff;
}

std::size_t PhotonEmitter::guideBins() const
{
    return std::min<std::size_t>(_emitters.size(), kMostGuideLights) * _targets.size() * kGuideBins;
}

std::shared_ptr<const PhotonGuide> PhotonEmitter::learn(const std::vector<uint32_t>& emitted,
                                                        const std::vector<double>& seen) const
{
    std::vector<float> pmf;
    for (std::size_t e = 0; e < _cumulative.size(); ++e)
        pmf.push_back(_cumulative[e] - (e ? _cumulative[e - 1] : 0.0f));
    return std::make_shared<const PhotonGuide>(static_cast<uint32_t>(_targets.size()), emitted,
                                               seen, pmf);
}

uint32_t PhotonEmitter::binOf(LightGuide guide, uint32_t target, uint32_t bin) const
{
    return PhotonGuide::index(guide.light, target, static_cast<uint32_t>(_targets.size()), bin);
}

/// Samples the direction of a photon that is guided, and sets its bin. share: of the photons that
/// are guided; point.choice is below it.
Vec3 PhotonEmitter::guidedDirection(const Cones& cones, float share, const EmissionPoint& point,
                                    LightGuide guide, uint32_t& bin) const
{
    const Cones::Cone& cone = cones.choose(point.choice / share);
    uint32_t inCone;
    const Vec3 direction = cones.sample(cone, guide, point.direction, inCone);
    bin = binOf(guide, cone.target, inCone);
    return direction;
}

/// Returns the cones of the targets as seen from origin. spread: photons start up to so far beside
/// the origin.
PhotonEmitter::Cones PhotonEmitter::conesFrom(Vec3 origin, float spread, LightGuide guide) const
{
    Cones result;
    if (_guidedShare <= 0.0f) return result;
    const float* weights =
        guide.photonGuide ? guide.photonGuide->targetWeights(guide.light) : nullptr;
    for (uint32_t t = 0; t < _targets.size(); ++t)
    {
        const Sphere& target = _targets[t];
        const Vec3 d = target.centre - origin;
        const float distance2 = glm::dot(d, d);
        const float radius = target.radius + spread;
        const float sin2 = radius * radius / distance2;
        if (!(sin2 < 0.999f)) continue; // a target around the origin needs no guiding
        // 1 - cosine without cancellation
        const float oneMinusCosine = sin2 / (1.0f + std::sqrt(1.0f - sin2));
        if (!(oneMinusCosine > 0.0f)) continue;
        const float share = weights ? weights[t] * oneMinusCosine : oneMinusCosine;
        result.cones[result.count++] = {d / std::sqrt(distance2), oneMinusCosine, share, t};
        result.total += share;
    }
    return result;
}

std::optional<PhotonStart> PhotonEmitter::emitArea(uint32_t index, const EmissionPoint& point,
                                                   LightGuide guide) const
{
    const std::optional<LightPoint> from =
        _traced.lights().samplePoint(index, point.position.x, point.position.y);
    if (!from) return std::nullopt;
    const Light& light = _lights[index];
    const bool twoSided = light.twoSided || light.kind == LightKind::Mesh;

    Vec3 radiance = light.radiance;
    if (light.kind == LightKind::Mesh)
    {
        MaterialPoint at;
        const uint32_t material = _traced.scene().instances[light.instance].material;
        at.setUv(emissionUvSet(_traced.scene().materials[material]), from->uv);
        radiance = _traced.materials().emission(material, at);
    }
    const Cones cones = conesFrom(from->position, 0.0f, guide);
    const float share = cones.count ? _guidedShare : 0.0f;

    PhotonStart start;
    Vec3 direction;
    if (point.choice < share)
        direction = guidedDirection(cones, share, point, guide, start.bin);
    else
    {
        const float rest = (point.choice - share) / (1.0f - share);
        const Vec3 side = twoSided && rest >= 0.5f ? -from->normal : from->normal;
        direction = turnedTo(side, squareToCosineHemisphere(point.direction.x, point.direction.y));
    }
    const float signedCosine = glm::dot(direction, from->normal);
    const float cosine = std::fabs(signedCosine);
    if (!(cosine > 0.0f) || (signedCosine < 0.0f && !twoSided)) return std::nullopt;
    float pdf = (1.0f - share) * cosine * kInvPi * (twoSided ? 0.5f : 1.0f);
    if (share > 0.0f) pdf += share * cones.pdf(guide, direction);
    if (!(pdf > 0.0f)) return std::nullopt;

    start.origin =
        from->position + from->normal * (signedCosine >= 0.0f ? from->offset : -from->offset);
    start.direction = direction;
    start.power = radiance * (cosine * _traced.lights().area(index) / pdf);
    return start;
}

std::optional<PhotonStart> PhotonEmitter::emitPoint(uint32_t index, const EmissionPoint& point,
                                                    LightGuide guide) const
{
    const Light& light = _lights[index];
    const Cones cones = conesFrom(light.position, light.radius, guide);
    const float share = cones.count ? _guidedShare : 0.0f;
    const float oneMinusCutoff = 1.0f - std::max(-1.0f, light.spotCosCutoff);

    PhotonStart start;
    Vec3 direction;
    if (point.choice < share)
        direction = guidedDirection(cones, share, point, guide, start.bin);
    else
        direction = turnedTo(light.direction, squareToCone(point.direction, oneMinusCutoff));

    const float cosine = glm::dot(direction, light.direction);
    const bool inSpot = light.spotCosCutoff <= -1.0f || cosine >= light.spotCosCutoff;
    if (!inSpot) return std::nullopt;
    float pdf = (1.0f - share) / (2.0f * kPi * oneMinusCutoff);
    if (share > 0.0f) pdf += share * cones.pdf(guide, direction);
    const float spot = light.spotCosCutoff <= -1.0f || light.spotExponent == 0.0f
                           ? 1.0f
                           : std::pow(std::max(cosine, 0.0f), light.spotExponent);
    start.origin = isSoft(light) ? softOrigin(light, direction, point.position) : light.position;
    start.direction = direction;
    start.power = light.diffuse * (kPi * spot / pdf);
    return start;
}

} // namespace osgRayTrace::engine
