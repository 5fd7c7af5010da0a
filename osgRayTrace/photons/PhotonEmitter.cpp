// PhotonEmitter.cpp - photons as they leave the lights. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonEmitter.h"

#include "osgRayTrace/sampling/Warp.h"
#include "osgRayTrace/shading/SoftLight.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

using Sphere = PhotonEmitter::Sphere;

struct Box
{
    Vec3d low{std::numeric_limits<double>::infinity()};
    Vec3d high{-std::numeric_limits<double>::infinity()};

    void add(Vec3d p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    bool empty() const { return !(low.x <= high.x); }
};

Box boxOf(const Scene& scene, const Instance& instance)
{
    Box box;
    for (const Vec3& p : scene.meshes[instance.mesh]->positions)
        box.add(Vec3d(instance.placed ? transformPoint(instance.engineFromLocal, p) : p));
    return box;
}

/// The smallest sphere around the box's centre that holds it. Balls fill their box's sphere badly, but a
/// cone that is too wide only wastes photons.
Sphere sphereOf(const Box& box)
{
    const Vec3d half = (box.high - box.low) * 0.5;
    return {Vec3((box.low + box.high) * 0.5), static_cast<float>(glm::length(half) * 1.000001)};
}

/// The sphere around the vertices with the box's centre: tight for balls.
Sphere tightSphere(const Scene& scene, const Instance& instance, const Box& box)
{
    const Vec3 centre((box.low + box.high) * 0.5);
    float radius2 = 0.0f;
    for (const Vec3& p : scene.meshes[instance.mesh]->positions)
    {
        const Vec3 q = (instance.placed ? transformPoint(instance.engineFromLocal, p) : p) - centre;
        radius2 = std::max(radius2, glm::dot(q, q));
    }
    return {centre, std::sqrt(radius2) * 1.00001f};
}

/// True if a photon can be mirrored or let through by a mirror-like lobe.
bool bendsLight(const MaterialRecord& record)
{
    const auto bends = [&](const Bsdf& bsdf)
    {
        if (!bsdf.reflects() && !bsdf.transmits()) return false;
        // Textures may make smooth what is rough on the average; without an interface nothing is bent.
        return !record.constant || bsdf.isSmooth() || (bsdf.transmits() && bsdf.eta == 1.0f);
    };
    return bends(record.front) || bends(record.back);
}

/// Joins the two halves of a list, split at the median of its longest axis, until few enough are left.
void group(std::vector<Sphere> spheres, std::size_t limit, std::vector<Sphere>& groups)
{
    if (limit <= 1 || spheres.size() <= 1)
    {
        Box box;
        for (const Sphere& s : spheres)
        {
            box.add(Vec3d(s.centre) - Vec3d(s.radius));
            box.add(Vec3d(s.centre) + Vec3d(s.radius));
        }
        groups.push_back(spheres.size() == 1 ? spheres[0] : sphereOf(box));
        return;
    }
    Box box;
    for (const Sphere& s : spheres)
        box.add(Vec3d(s.centre));
    const Vec3d size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = spheres.size() / 2;
    std::nth_element(spheres.begin(), spheres.begin() + static_cast<std::ptrdiff_t>(half), spheres.end(),
                     [axis](const Sphere& a, const Sphere& b) { return a.centre[axis] < b.centre[axis]; });
    group({spheres.begin(), spheres.begin() + static_cast<std::ptrdiff_t>(half)}, limit / 2, groups);
    group({spheres.begin() + static_cast<std::ptrdiff_t>(half), spheres.end()}, limit - limit / 2, groups);
}

Vec3 toWorld(Vec3 axis, Vec3 local)
{
    Vec3 tangent, bitangent;
    frameOf(axis.x, axis.y, axis.z, tangent, bitangent);
    return tangent * local.x + bitangent * local.y + axis * local.z;
}

std::size_t pick(const std::vector<float>& cumulative, float u)
{
    return static_cast<std::size_t>(std::upper_bound(cumulative.begin(), cumulative.end() - 1, u) -
                                    cumulative.begin());
}

constexpr float kWholeSphere = 4.0f * kPi;

} // namespace

/// The cone that holds a target; a target around the origin has none.
struct PhotonEmitter::Aim
{
    Vec3 axis;
    float oneMinusCosine;
};

PhotonEmitter::PhotonEmitter(const TracedScene& traced, const std::vector<Light>& lights, float aimedShare)
    : _traced(traced), _lights(lights), _aimedShare(aimedShare)
{
    const Scene& scene = traced.scene();
    Box all;
    std::vector<Sphere> targets;
    for (const Instance& instance : scene.instances)
    {
        const Box box = boxOf(scene, instance);
        if (box.empty()) continue;
        all.add(box.low);
        all.add(box.high);
        if (bendsLight(traced.materials()[instance.material]))
            targets.push_back(tightSphere(scene, instance, box));
    }
    if (!all.empty()) _scene = sphereOf(all);
    if (!targets.empty()) group(std::move(targets), kMaxTargets, _targets);
    if (_targets.empty()) _aimedShare = 0.0f;

    // In proportion to power; that of point and directional lights is what they send into the scene.
    std::vector<double> powers;
    double total = 0.0;
    for (uint32_t i = 0; i < lights.size(); ++i)
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
            power = double(luminance(light.diffuse)) * kPi * solidAngle * falloff(i, float(distance));
            break;
        }
        case LightKind::Directional:
            power = double(luminance(light.diffuse)) * kPi * kPi * double(_scene.radius) * _scene.radius;
            break;
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

std::optional<PhotonStart> PhotonEmitter::emit(const EmissionPoint& point) const
{
    if (_cumulative.empty()) return std::nullopt;
    const std::size_t chosen = pick(_cumulative, point.light);
    const float pmf = _cumulative[chosen] - (chosen ? _cumulative[chosen - 1] : 0.0f);
    const uint32_t light = _emitters[chosen];
    std::optional<PhotonStart> start;
    switch (_lights[light].kind)
    {
    case LightKind::Parallelogram:
    case LightKind::Mesh: start = emitArea(light, point); break;
    case LightKind::Point: start = emitPoint(light, point); break;
    case LightKind::Directional: start = emitDirectional(light, point); break;
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
    return denominator > 0.0f ? distance * distance / denominator : 0.0f;
}

/// Cones of the targets as seen from origin, and the sum of their solid angles over 2 pi. spread: photons
/// start so far beside the origin.
int PhotonEmitter::conesFrom(Vec3 origin, float spread, Aim* aims, float& total) const
{
    int count = 0;
    total = 0.0f;
    if (_aimedShare <= 0.0f) return 0;
    for (const Sphere& target : _targets)
    {
        const Vec3 d = target.centre - origin;
        const float distance2 = glm::dot(d, d);
        const float radius = target.radius + spread;
        const float sin2 = radius * radius / distance2;
        if (!(sin2 < 0.999f)) continue; // around or beside the origin: the plain emission finds it
        // 1 - cos without cancellation.
        const float oneMinusCosine = sin2 / (1.0f + std::sqrt(1.0f - sin2));
        if (!(oneMinusCosine > 0.0f)) continue;
        aims[count++] = {d / std::sqrt(distance2), oneMinusCosine};
        total += oneMinusCosine;
    }
    return count;
}

/// [1/sr] of the aimed part of the mixture.
float PhotonEmitter::aimedPdf(const Aim* aims, int count, float total, Vec3 direction) const
{
    int inside = 0;
    for (int i = 0; i < count; ++i)
    {
        const Vec3 off = direction - aims[i].axis; // |off|^2 / 2 = 1 - cosine
        inside += 0.5f * glm::dot(off, off) <= aims[i].oneMinusCosine;
    }
    return static_cast<float>(inside) / (2.0f * kPi * total);
}

namespace
{

/// One of the aims, by solid angle; point.aim is rescaled to [0,1) of the aimed share.
template <class Aim> const Aim& chooseAim(const Aim* aims, int count, float total, float u)
{
    float at = u * total;
    for (int i = 0; i < count - 1; ++i)
    {
        if (at < aims[i].oneMinusCosine) return aims[i];
        at -= aims[i].oneMinusCosine;
    }
    return aims[count - 1];
}

} // namespace

std::optional<PhotonStart> PhotonEmitter::emitArea(uint32_t index, const EmissionPoint& point) const
{
    const std::optional<LightPoint> from = _traced.lights().samplePoint(index, point.position.x,
                                                                        point.position.y);
    if (!from) return std::nullopt;
    const Light& light = _lights[index];
    const bool twoSided = light.twoSided || light.kind == LightKind::Mesh;

    Vec3 radiance = light.radiance;
    if (light.kind == LightKind::Mesh)
    {
        MaterialPoint at;
        at.uv = from->uv;
        radiance = _traced.materials().emission(_traced.scene().instances[light.instance].material, at);
    }
    Aim aims[kMaxTargets];
    float total;
    const int count = conesFrom(from->position, 0.0f, aims, total);
    const float share = count ? _aimedShare : 0.0f;

    Vec3 direction;
    if (point.aim < share)
    {
        const Aim& aim = chooseAim(aims, count, total, point.aim / share);
        direction = toWorld(aim.axis, squareToCone(point.direction, aim.oneMinusCosine));
    }
    else
    {
        const float rest = (point.aim - share) / (1.0f - share);
        const Vec3 side = twoSided && rest >= 0.5f ? -from->normal : from->normal;
        direction = toWorld(side, squareToCosineHemisphere(point.direction.x, point.direction.y));
    }
    const float signedCosine = glm::dot(direction, from->normal);
    const float cosine = std::fabs(signedCosine);
    if (!(cosine > 0.0f) || (signedCosine < 0.0f && !twoSided)) return std::nullopt;
    float pdf = (1.0f - share) * cosine * kInvPi * (twoSided ? 0.5f : 1.0f);
    if (share > 0.0f) pdf += share * aimedPdf(aims, count, total, direction);
    if (!(pdf > 0.0f)) return std::nullopt;

    PhotonStart start;
    start.origin = from->position + from->normal * (signedCosine >= 0.0f ? from->offset : -from->offset);
    start.direction = direction;
    start.power = radiance * (cosine * _traced.lights().area(index) / pdf);
    return start;
}

std::optional<PhotonStart> PhotonEmitter::emitPoint(uint32_t index, const EmissionPoint& point) const
{
    const Light& light = _lights[index];
    Aim aims[kMaxTargets];
    float total;
    const int count = conesFrom(light.position, light.radius, aims, total);
    const float share = count ? _aimedShare : 0.0f;
    const float oneMinusCutoff = 1.0f - std::max(-1.0f, light.spotCosCutoff);

    Vec3 direction;
    if (point.aim < share)
    {
        const Aim& aim = chooseAim(aims, count, total, point.aim / share);
        direction = toWorld(aim.axis, squareToCone(point.direction, aim.oneMinusCosine));
    }
    else
        direction = toWorld(light.direction, squareToCone(point.direction, oneMinusCutoff));

    const float cosine = glm::dot(direction, light.direction);
    const bool inSpot = light.spotCosCutoff <= -1.0f || cosine >= light.spotCosCutoff;
    if (!inSpot) return std::nullopt;
    float pdf = (1.0f - share) / (2.0f * kPi * oneMinusCutoff);
    if (share > 0.0f) pdf += share * aimedPdf(aims, count, total, direction);
    const float spot = light.spotCosCutoff <= -1.0f || light.spotExponent == 0.0f
                           ? 1.0f
                           : std::pow(std::max(cosine, 0.0f), light.spotExponent);
    PhotonStart start;
    start.origin = isSoft(light) ? softOrigin(light, direction, point.position) : light.position;
    start.direction = direction;
    start.power = light.diffuse * (kPi * spot / pdf);
    return start;
}

std::optional<PhotonStart> PhotonEmitter::emitDirectional(uint32_t index, const EmissionPoint& point) const
{
    const Light& light = _lights[index];
    if (!(_scene.radius > 0.0f)) return std::nullopt;
    const Vec3 direction = isSoft(light) ? softDirection(light, point.direction) : light.direction;
    const float sceneArea = kPi * _scene.radius * _scene.radius;
    float total = 0.0f;
    for (const Sphere& target : _targets)
        total += kPi * target.radius * target.radius;
    const float share = total > 0.0f ? _aimedShare : 0.0f;

    const Sphere* disc = &_scene;
    if (point.aim < share)
    {
        float at = point.aim / share * total;
        std::size_t chosen = 0;
        for (; chosen + 1 < _targets.size(); ++chosen)
        {
            const float area = kPi * _targets[chosen].radius * _targets[chosen].radius;
            if (at < area) break;
            at -= area;
        }
        disc = &_targets[chosen];
    }
    float s, c;
    sinCosTurn(point.position.x, s, c);
    const float radius = disc->radius * std::sqrt(point.position.y);
    const Vec3 q = disc->centre + toWorld(direction, Vec3(radius * c, radius * s, 0.0f));

    const auto isIn = [&](const Sphere& sphere)
    {
        const Vec3 d = q - sphere.centre;
        const Vec3 across = d - direction * glm::dot(d, direction);
        return glm::dot(across, across) <= sphere.radius * sphere.radius * 1.000002f;
    };
    float pdf = isIn(_scene) ? (1.0f - share) / sceneArea : 0.0f;
    if (share > 0.0f)
    {
        int inside = 0;
        for (const Sphere& target : _targets)
            inside += isIn(target);
        pdf += share * static_cast<float>(inside) / total;
    }
    if (!(pdf > 0.0f)) return std::nullopt;
    PhotonStart start;
    const Vec3 toCentre = _scene.centre - q;
    start.origin = q + direction * (glm::dot(toCentre, direction) - 2.0f * _scene.radius);
    start.direction = direction;
    start.power = light.diffuse * (kPi * softWeight(light.sine) / pdf);
    return start;
}

} // namespace osgRayTrace::engine
