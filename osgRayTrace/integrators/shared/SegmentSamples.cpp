// SegmentSamples.cpp - a point of a stretch within a medium with a sample of a light. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/SegmentSamples.h"

#include "osgRayTrace/integrators/shared/ShadowLanes.h"
#include "osgRayTrace/media/FreeFlight.h"
#include "osgRayTrace/media/PhaseFunction.h"
#include "osgRayTrace/media/Transmittance.h"
#include "osgRayTrace/shading/SoftLight.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the bits of a random number, which tell the numbers of one light from another's.
uint32_t bitsOf(float u)
{
    uint32_t bits;
    std::memcpy(&bits, &u, sizeof bits);
    return bits;
}

} // namespace

/// Returns a point that is spread evenly by angle around a light.
Place SegmentSamples::near(int i, Vec3 light, float u) const
{
    const RayPart& part = _segments.parts[i];
    const Equiangular stretch(plainOrigin(*_segments.ray, i), plainDirection(*_segments.ray, i),
                              part.begin, part.end, plainOf(light));
    const EquiangularSample sample = stretch.sample(u);
    if (!(sample.pdf > 0.0f) || !(sample.pdf < kInfinity)) return {};
    return placeAt(i, sample, u);
}

/// Returns the point at a sample, which the number u has chosen.
Place SegmentSamples::placeAt(int i, EquiangularSample sample, float u) const
{
    const RayPart& part = _segments.parts[i];
    const MediumRecord& medium = mediumOf(i);
    Vec3 left;
    if (const GridRay* grids = _segments.gridsOf(i))
    {
        NumberStream numbers(_segments.numbers[i].seedOf(MediumGridWay + bitsOf(u)));
        left = grids->transmittance(part.begin, sample.t, numbers);
    }
    else if (medium.thins)
    {
        const MediumWay way = _segments.wayOf(i, medium);
        left = transmittance(medium.sigmaT, way.lengthTo(sample.t)) * way.density(sample.t);
    }
    else
        left = transmittance(medium.sigmaT, sample.t - part.begin);
    return {origin(i) + direction(i) * sample.t, left / sample.pdf, sample.t};
}

/// Returns a point at which light that travels against the ray would collide.
Place SegmentSamples::byFlight(int i, float u) const
{
    const Vec3 pmf = channelPmf(laneOf(_segments.throughput, i));
    if (const GridRay* grids = _segments.gridsOf(i))
    {
        NumberStream numbers(_segments.numbers[i].seedOf(MediumGrid + bitsOf(u)));
        const GridFlight flight = grids->flight(pmf, numbers);
        if (!flight.collides) return {};
        return {origin(i) + direction(i) * flight.distance, flight.weight, flight.distance};
    }
    const MediumRecord& medium = mediumOf(i);
    const float length = _segments.lengthOf(i, medium);
    const FreeFlight flight = sampleFlightWithin(medium.sigmaT, length, pmf, u);
    if (!flight.collides) return {};
    const float distance = _segments.distanceAt(i, medium, flight.distance);
    return {origin(i) + direction(i) * distance, flight.weight, distance};
}

/// Returns the point for which the tree chooses a light. A flight through volumes may not collide;
/// they have any point of their extent.
Place SegmentSamples::pivotOf(int i, float u) const
{
    if (!_segments.gridsOf(i)) return byFlight(i, u);
    const RayPart& part = _segments.parts[i];
    const float distance = part.begin + u * (part.end - part.begin);
    return {origin(i) + direction(i) * distance, Vec3(1.0f), distance};
}

/// Returns the density with which a collision at a distance would find a direction.
float SegmentSamples::phaseDensity(int i, float distance, float cosTheta) const
{
    if (const GridRay* grids = _segments.gridsOf(i))
        return grids->scatterersAt(distance).pdf(cosTheta);
    return evalPhase(mediumOf(i).phase, cosTheta);
}

/// Sets the sample of lane i on a point of an area light.
bool SegmentSamples::setTowards(int i, const Place& place, Vec3 light, Vec3 normal, bool twoSided,
                                float area, float offset, float pmf, Vec3 radiance)
{
    const Vec3 way = light - place.point;
    const float distance = glm::length(way);
    if (!(distance > 0.0f) || place.weight == Vec3(0.0f)) return false;
    const Vec3 wi = way / distance;
    const float cosine = -glm::dot(wi, normal);
    const float cosThetaL = twoSided ? std::fabs(cosine) : cosine;
    if (!(cosThetaL > 0.0f)) return false;
    const float weight = cosThetaL * area / (distance * distance * pmf);
    if (!(weight < 1e30f)) return false;
    _places[i] = place;
    setSample(_samples, i, wi, radiance, weight);
    setRay(_samples.shadow, i, plainOf(place.point), plainOf(wi), 0.0f,
           std::max(0.0f, distance - offset / cosThetaL));
    return true;
}

void SegmentSamples::setStretch(int i)
{
    _stretches.begin[i] = _segments.parts[i].begin;
    _stretches.end[i] = _segments.parts[i].end;
}

/// Sets the place of lane i to the point that was chosen with a sample of a rectangle. Returns
/// false if no light gets from there.
bool SegmentSamples::setPlace(int i)
{
    _places[i] = placeAt(i, {_stretches.t[i], _stretches.pdf[i]}, _stretches.along[i]);
    return _places[i].weight != Vec3(0.0f);
}

bool SegmentSamples::setRectangle(int i, const ShiningRectangle& light)
{
    return rectangleLane(light, *_segments.ray, i, _stretches, _samples) && setPlace(i);
}

/// Sets the sample of lane i of a directional, point or spot light.
bool SegmentSamples::setDelta(int i, const Light& light, float weight, float along, Vec2 onLight)
{
    const bool fades =
        light.kind == LightKind::Point && (light.attenuationQuadratic > 0.0f || light.range > 0.0f);
    const Place place = fades ? near(i, light.position, along) : byFlight(i, along);
    if (place.weight == Vec3(0.0f)) return false;
    const SoftLightSample sample =
        sampleSoft(light, place.point, isSoft(light) ? onLight : Vec2(0.0f));
    if (!(sample.attenuation > 0.0f)) return false;
    _places[i] = place;
    setSample(_samples, i, sample.wi, light.diffuse * (kPi * sample.attenuation),
              sample.weight * weight);
    setRay(_samples.shadow, i, plainOf(place.point), plainOf(sample.wi), 0.0f, sample.distance);
    return true;
}

/// Returns a light of the table that is a rectangle.
ShiningRectangle SegmentSamples::rectangleOf(const LightTable::Choice& chosen) const
{
    const Light& light = (*_context.lights)[chosen.light];
    return {*_table.rectangle(chosen.light), _table.pointOffset(chosen.light),
            maskOf(light.twoSided), 1.0f / chosen.pmf, plainOf(light.radiance)};
}

/// Sets the sample of lane i on an area light.
bool SegmentSamples::setArea(int i, const LightTable::Choice& chosen)
{
    if (_table.rectangle(chosen.light)) return setRectangle(i, rectangleOf(chosen));
    const Light& light = (*_context.lights)[chosen.light];
    const std::optional<LightPoint> point =
        _table.samplePoint(chosen.light, _stretches.u[i], _stretches.v[i]);
    if (!point) return false;
    Vec3 radiance = light.radiance;
    if (light.kind == LightKind::Mesh)
    {
        const Scene& scene = _context.traced->scene();
        const uint32_t material = scene.instances[light.instance].material;
        MaterialPoint at;
        at.setUv(emissionUvSet(scene.materials[material]), point->uv);
        radiance = _context.traced->materials().emission(material, at);
    }
    return setTowards(i, near(i, point->position, _stretches.along[i]), point->position,
                      point->normal, light.twoSided || light.kind == LightKind::Mesh,
                      _table.area(chosen.light), point->offset, chosen.pmf, radiance);
}

} // namespace osgRayTrace::engine
