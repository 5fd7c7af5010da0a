// MediumTable.cpp - puts the media of a scene into a table. Layer: media.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/MediumTable.h"

#include "osgRayTrace/scene/Bodies.h"
#include "osgRayTrace/scene/FogMedium.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// The largest coefficient [1/engine unit]. Optical depths up to 1e30 leave floats finite.
constexpr float kLargestCoefficient = 1e24f;

/// The least scale height, over the radius of the medium's sphere.
constexpr float kLeastScaleHeight = 1e-6f;

Vec3 usable(Vec3 coefficient, float unit)
{
    Vec3 result;
    for (int c = 0; c < 3; ++c) // comparisons with NaN are false
        result[c] =
            coefficient[c] > 0.0f ? std::min(coefficient[c] * unit, kLargestCoefficient) : 0.0f;
    return result;
}

MediumRecord recordOf(const Medium& medium, float unit)
{
    MediumRecord record;
    record.sigmaS = usable(medium.sigmaS, unit);
    record.sigmaT = record.sigmaS + usable(medium.sigmaA, unit);
    record.emission = usable(medium.emission, unit);
    record.phase = phaseOf(medium);
    record.priority = medium.priority;
    record.scatters = record.sigmaS != Vec3(0.0f);
    record.emits = record.emission != Vec3(0.0f);
    record.isClear = record.sigmaT == Vec3(0.0f) && !record.emits;
    return record;
}

/// Has the medium thin out from a place on.
void thinOut(MediumRecord& record, const Atmosphere& around, float radius)
{
    // Floats have no heights of thinner layers.
    const float scale = std::max(around.scaleHeight, kLeastScaleHeight * radius);
    record.thins = scale > 0.0f && scale < kInfinity;
    if (!record.thins) return;
    record.rise = around.up / scale;
    record.base = glm::dot(record.rise, around.centre);
}

} // namespace

MediumTable::MediumTable(const Scene& scene, Vec3 low, Vec3 high)
{
    const auto unit = static_cast<float>(scene.unit);
    const std::optional<Atmosphere> around = atmosphereOf(scene);
    _records.push_back(recordOf(around ? around->medium : Medium(), unit));
    const bool own = around && around->radius > 0.0f;
    _centre = own ? around->centre : 0.5f * (low + high);
    _radius = own ? around->radius : 0.5f * glm::length(high - low);
    if (!(_radius >= 0.0f) || !(_radius < kInfinity)) _radius = 0.0f;
    if (around && around->scaleHeight > 0.0f) thinOut(_records.front(), *around, _radius);

    _interiors.assign(scene.materials.size(), kOutside);
    _interfaces.assign(scene.materials.size(), false);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
    {
        const Material& material = scene.materials[i];
        if (!enclosesBody(material) || _records.size() > 0xffff) continue;
        _interiors[i] = static_cast<MediumId>(_records.size());
        _interfaces[i] = engine::isInterface(material);
        _hasInterfaces = _hasInterfaces || _interfaces[i];
        _nests = _nests || (material.detail && material.detail->interior.priority != 0);
        _records.push_back(recordOf(material.detail ? material.detail->interior : Medium(), unit));
        _records.back().ior = usableIor(material.ior);
    }
    const float mostSigma = 1.0f / (kDenseMeanWay * 0.5f * glm::length(high - low));
    for (MediumRecord& record : _records)
    {
        const Vec3 sigma = record.sigmaT;
        record.isDense =
            record.scatters && std::max(sigma.x, std::max(sigma.y, sigma.z)) > mostSigma;
    }
}

RayPart MediumTable::clipped(MediumId medium, Vec3 origin, Vec3 direction, float begin,
                             float end) const
{
    // A body that is closed needs no bound: its ray ends at its surface.
    if (medium != kOutside && end < kInfinity) return {begin, end};
    // Distances from the foot of the centre's perpendicular cancel less than those from the origin.
    const Vec3 d = _centre - origin;
    const float foot = glm::dot(d, direction);
    const Vec3 across = d - direction * foot;
    const float half2 = _radius * _radius - glm::dot(across, across);
    if (!(half2 > 0.0f)) return {begin, begin};
    const float half = std::sqrt(half2);
    return {std::max(begin, foot - half), std::min(end, foot + half)};
}

} // namespace osgRayTrace::engine
