// SegmentLights.cpp - samples the lights of stretches within media. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/SegmentLights.h"

#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"
#include "osgRayTrace/integrators/shared/SegmentRectangles.h"
#include "osgRayTrace/integrators/shared/ShadowLanes.h"
#include "osgRayTrace/integrators/shared/TreeLights.h"
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

/// The share of choices by LightTree that is even among all its emitters: one that does not shine
/// on the point for which the tree is asked may shine on others of the stretch.
constexpr float kEvenShare = 0.25f;

/// Returns the bits of a random number, which tell the numbers of one light from another's.
uint32_t bitsOf(float u)
{
    uint32_t bits;
    std::memcpy(&bits, &u, sizeof bits);
    return bits;
}

/// A point of a stretch with its weight: transmittance over density [length], times that of a
/// medium which thins out.
struct Place
{
    Vec3 point;
    Vec3 weight{0.0f};     ///< 0: there is none
    float distance = 0.0f; ///< along the ray
};

class Segments
{
public:
    Segments(const PassContext& context, const MediumSegments& segments, TileCounts& counts,
             Vec3Lanes& radiance)
        : _context(context),
          _table(context.traced->lights()),
          _segments(segments),
          _counts(counts),
          _radiance(radiance)
    {
    }

    void addEnvironment();
    void addDelta(uint32_t light, uint32_t slot, float weight, LaneMask lanes);
    void addOneDelta(const SampledLights& lights);
    void addArea();
    void addTree();

private:
    const MediumRecord& mediumOf(int i) const
    {
        return _context.traced->media()[_segments.media[i]];
    }
    Vec2 numbers(int i, uint32_t dimension) const { return _segments.numbers[i].at(dimension); }
    Vec3 origin(int i) const
    {
        const RayBlock& ray = *_segments.ray;
        return Vec3(ray.originX[i], ray.originY[i], ray.originZ[i]);
    }
    Vec3 direction(int i) const { return directionOf(*_segments.ray, i); }

    Place near(int i, Vec3 light, float u) const;
    Place placeAt(int i, EquiangularSample sample, float u) const;
    void setStretch(int i);
    bool setPlace(int i);
    ShiningRectangle rectangleOf(const LightTable::Choice& chosen) const;
    bool setRectangle(int i, const ShiningRectangle& light);
    bool setArea(int i, const LightTable::Choice& chosen);
    Place byFlight(int i, float u) const;
    Place pivotOf(int i, float u) const;
    float phaseDensity(int i, float distance, float cosTheta) const;
    bool setTowards(int i, const Place& place, Vec3 light, Vec3 normal, bool twoSided, float area,
                    float offset, float pmf, Vec3 radiance);
    bool setDelta(int i, const Light& light, float weight, float along, Vec2 onLight);
    void begin() { _samples.lit = _samples.tinted = 0; }
    void finish(LaneMask visible);

    const PassContext& _context;
    const LightTable& _table;
    const MediumSegments& _segments;
    TileCounts& _counts;
    Vec3Lanes& _radiance;
    LightLanes _samples;
    StretchLanes _stretches;
    Place _places[kLanes];
};

/// Returns a point that is spread evenly by angle around a light.
Place Segments::near(int i, Vec3 light, float u) const
{
    const RayPart& part = _segments.parts[i];
    const Equiangular stretch(plainOrigin(*_segments.ray, i), plainDirection(*_segments.ray, i),
                              part.begin, part.end, plainOf(light));
    const EquiangularSample sample = stretch.sample(u);
    if (!(sample.pdf > 0.0f) || !(sample.pdf < kInfinity)) return {};
    return placeAt(i, sample, u);
}

/// Returns the point at a sample, which the number u has chosen.
Place Segments::placeAt(int i, EquiangularSample sample, float u) const
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
Place Segments::byFlight(int i, float u) const
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
Place Segments::pivotOf(int i, float u) const
{
    if (!_segments.gridsOf(i)) return byFlight(i, u);
    const RayPart& part = _segments.parts[i];
    const float distance = part.begin + u * (part.end - part.begin);
    return {origin(i) + direction(i) * distance, Vec3(1.0f), distance};
}

/// Returns the density with which a collision at a distance would find a direction.
float Segments::phaseDensity(int i, float distance, float cosTheta) const
{
    if (const GridRay* grids = _segments.gridsOf(i))
        return grids->scatterersAt(distance).pdf(cosTheta);
    return evalPhase(mediumOf(i).phase, cosTheta);
}

/// Adds the light of the samples that the lanes see.
void Segments::finish(LaneMask visible)
{
    if (!visible) return;
    dimByMedia(_context, _segments.bodies, visible, _samples);
    for (const int i : lanesIn(visible))
    {
        const MediumRecord& medium = mediumOf(i);
        const float cosTheta = glm::dot(direction(i), laneOf(_samples.wi, i));
        const Vec3 light(_samples.radiance[0][i], _samples.radiance[1][i], _samples.radiance[2][i]);
        if (const GridRay* grids = _segments.gridsOf(i))
        {
            const Scatterers here = grids->scatterersAt(_places[i].distance);
            const Vec3 scattered = here.scattered(cosTheta) * _places[i].weight * light;
            setLane(_radiance, i,
                    laneOf(_radiance, i) +
                        laneOf(_segments.throughput, i) * scattered * _samples.weight[i]);
            continue;
        }
        const float phase = evalPhase(medium.phase, cosTheta);
        const Vec3 sum = laneOf(_segments.throughput, i) * medium.sigmaS * _places[i].weight *
                         light * (phase * _samples.weight[i]);
        setLane(_radiance, i, laneOf(_radiance, i) + sum);
    }
}

/// Sets the sample of lane i on a point of an area light.
bool Segments::setTowards(int i, const Place& place, Vec3 light, Vec3 normal, bool twoSided,
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

void Segments::setStretch(int i)
{
    _stretches.begin[i] = _segments.parts[i].begin;
    _stretches.end[i] = _segments.parts[i].end;
}

/// Sets the place of lane i to the point that was chosen with a sample of a rectangle. Returns
/// false if no light gets from there.
bool Segments::setPlace(int i)
{
    _places[i] = placeAt(i, {_stretches.t[i], _stretches.pdf[i]}, _stretches.along[i]);
    return _places[i].weight != Vec3(0.0f);
}

bool Segments::setRectangle(int i, const ShiningRectangle& light)
{
    return rectangleLane(light, *_segments.ray, i, _stretches, _samples) && setPlace(i);
}

/// Sets the sample of lane i of a directional, point or spot light.
bool Segments::setDelta(int i, const Light& light, float weight, float along, Vec2 onLight)
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

void Segments::addDelta(uint32_t index, uint32_t slot, float weight, LaneMask lanes)
{
    begin();
    const Light& light = (*_context.lights)[index];
    for (const int i : lanesIn(lanes))
    {
        const bool lit = setDelta(i, light, weight, numbers(i, MediumDelta + 2 * slot).x,
                                  numbers(i, MediumDeltaPoint + 2 * slot));
        _samples.lit |= static_cast<LaneMask>(lit) << i;
    }
    finish(visibleLanes(_context, light, _samples, _counts));
}

/// Adds one of the delta lights, which stands for all of them.
void Segments::addOneDelta(const SampledLights& lights)
{
    const auto count = static_cast<float>(lights.size());
    uint32_t chosen[kLanes];
    LaneMask open = _segments.lanes;
    for (const int i : lanesIn(open))
        chosen[i] = std::min(static_cast<uint32_t>(numbers(i, MediumDelta).y * count),
                             static_cast<uint32_t>(lights.size() - 1));
    while (open)
    {
        const uint32_t slot = chosen[firstLane(open)];
        LaneMask same = 0;
        for (const int i : lanesIn(open))
            same |= static_cast<LaneMask>(chosen[i] == slot) << i;
        addDelta(lights[slot].light, 0, lights[slot].weight * count, same);
        open &= ~same;
    }
}

/// Adds one point of one area light.
void Segments::addArea()
{
    begin();
    FloatLanes choice;
    setNumbers(_segments.numbers, MediumChoice, choice, _stretches.along);
    setNumbers(_segments.numbers, MediumLightPoint, _stretches.u, _stretches.v);
    LightTable::Choice chosen[kLanes];
    LaneMask lanes = 0;
    for (const int i : lanesIn(_segments.lanes))
    {
        setStretch(i);
        chosen[i] = _table.chooseAreaLight(choice[i]);
        const bool shines = chosen[i].light != kInvalid && chosen[i].pmf > 0.0f;
        lanes |= static_cast<LaneMask>(shines) << i;
    }
    // The first rectangle serves all its lanes at once, and those of others are undone: there are
    // few others without a LightTree.
    LaneMask first = 0;
    for (const int i : lanesIn(lanes))
    {
        const bool same = chosen[i].light == chosen[firstLane(lanes)].light;
        first |= static_cast<LaneMask>(same) << i;
    }
    if (first && _table.rectangle(chosen[firstLane(first)].light))
    {
        const ShiningRectangle light = rectangleOf(chosen[firstLane(first)]);
        const LaneMask lit = rectangleLanes(light, *_segments.ray, _stretches, _samples) & first;
        for (const int i : lanesIn(lit))
            _samples.lit |= static_cast<LaneMask>(setPlace(i)) << i;
        lanes &= ~first;
    }
    for (const int i : lanesIn(lanes))
        _samples.lit |= static_cast<LaneMask>(setArea(i, chosen[i])) << i;
    finish(visibleLanes(_context, _samples, _counts));
}

/// Returns a light of the table that is a rectangle.
ShiningRectangle Segments::rectangleOf(const LightTable::Choice& chosen) const
{
    const Light& light = (*_context.lights)[chosen.light];
    return {*_table.rectangle(chosen.light), _table.pointOffset(chosen.light),
            maskOf(light.twoSided), 1.0f / chosen.pmf, plainOf(light.radiance)};
}

/// Sets the sample of lane i on an area light.
bool Segments::setArea(int i, const LightTable::Choice& chosen)
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

/// Adds one emitter of the LightTree, chosen for some point of each stretch.
void Segments::addTree()
{
    const SceneLightTree& tree = *_table.tree();
    begin();
    LaneMask unshadowed = 0;
    for (const int i : lanesIn(_segments.lanes))
    {
        const Vec2 choice = numbers(i, MediumChoice), on = numbers(i, MediumLightPoint);
        const Place pivot = pivotOf(i, numbers(i, MediumDelta).x);
        if (pivot.weight == Vec3(0.0f)) continue;
        const auto count = static_cast<float>(tree.size());
        const bool even = choice.x < kEvenShare;
        const float u =
            even ? choice.x / kEvenShare : (choice.x - kEvenShare) / (1.0f - kEvenShare);
        const uint32_t number =
            even
                ? std::min(static_cast<uint32_t>(u * count), static_cast<uint32_t>(tree.size() - 1))
                : tree.choose(pivot.point, Vec3(0.0f), std::min(u, kOneMinusEpsilon)).emitter;
        const float pmf =
            kEvenShare / count + (1.0f - kEvenShare) * tree.pmf(pivot.point, Vec3(0.0f), number);
        const LightEmitter emitter = tree.emitter(number);
        const Light& light = (*_context.lights)[emitter.light];
        bool lit = false;
        if (emitter.isPoint())
        {
            lit = setDelta(i, light, 1.0f / pmf, choice.y, on);
            unshadowed |= static_cast<LaneMask>(lit && !light.castsShadows) << i;
        }
        else if (emitter.flags & kRectangle)
        {
            const EmitterPoint middle = emitterPoint(_context, emitter, 0.5f, 0.5f);
            setStretch(i);
            _stretches.along[i] = choice.y;
            _stretches.u[i] = on.x;
            _stretches.v[i] = on.y;
            lit = setRectangle(i, {rectangleLight(emitter), middle.offset,
                                   maskOf((emitter.flags & kTwoSided) != 0), 1.0f / pmf,
                                   plainOf(middle.radiance)});
        }
        else
        {
            const EmitterPoint point = emitterPoint(_context, emitter, on.x, on.y);
            const bool twoSided = (emitter.flags & (kTwoSided | kTriangle)) != 0;
            lit = setTowards(i, near(i, point.position, choice.y), point.position, point.normal,
                             twoSided, emitter.area, point.offset, pmf, point.radiance);
        }
        _samples.lit |= static_cast<LaneMask>(lit) << i;
    }
    _samples.lit &= ~unshadowed;
    finish(visibleLanes(_context, _samples, _counts) | unshadowed);
}

void Segments::addEnvironment()
{
    const PlacedEnvironment& sky = *_table.shiningEnvironment();
    const RenderOptions& options = _context.options;
    const bool uniform = options.environmentSampling == EnvironmentSampling::Uniform;
    const bool mis = _segments.withMis && !_context.strata;
    if (mis && !uniform && sky.isEven()) return; // collisions find all of its light
    begin();
    for (const int i : lanesIn(_segments.lanes))
    {
        const Vec2 along = numbers(i, MediumSkyPoint), towards = numbers(i, MediumSky);
        const Place place = byFlight(i, along.x);
        if (place.weight == Vec3(0.0f)) continue;
        SkySample sample;
        if (_context.strata)
        {
            const auto count = static_cast<float>(_context.strata->size());
            const auto k = static_cast<std::size_t>(along.y * count);
            const EnvironmentStratum& stratum =
                (*_context.strata)[std::min(k, _context.strata->size() - 1)];
            sample = {stratum.direction, stratum.integral, 1.0f / count};
        }
        else
            sample = sampleSky(_context, sky, towards, !mis);
        if (!(sample.pdfW > 0.0f)) continue;
        float weight = 1.0f / sample.pdfW;
        if (mis)
        {
            const float phase =
                phaseDensity(i, place.distance, glm::dot(direction(i), sample.direction));
            const float ratio = phase * collisionProbability(_context, _segments, i) / sample.pdfW;
            weight /= 1.0f + ratio * ratio; // the power heuristic
        }
        _places[i] = place;
        setSample(_samples, i, sample.direction, sample.radiance, weight);
        setRay(_samples.shadow, i, plainOf(place.point), plainOf(sample.direction), 0.0f,
               kInfinity);
        _samples.lit |= 1u << i;
    }
    finish(visibleLanes(_context, _samples, _counts));
}

} // namespace

MediumWay MediumSegments::wayOf(int i, const MediumRecord& medium) const
{
    const Vec3 origin(ray->originX[i], ray->originY[i], ray->originZ[i]);
    return {medium, origin, directionOf(*ray, i), parts[i]};
}

float collisionProbability(const PassContext& context, const MediumSegments& segments, int i)
{
    if (segments.gridsOf(i)) return 1.0f;
    const MediumRecord& medium = context.traced->media()[segments.media[i]];
    return collisionProbability(medium.sigmaT, segments.lengthOf(i, medium),
                                channelPmf(laneOf(segments.throughput, i)));
}

void addSegmentLights(const PassContext& context, const SampledLights& deltaLights,
                      const MediumSegments& segments, TileCounts& counts, Vec3Lanes& radiance)
{
    if (!segments.lanes) return;
    const LightTable& table = context.traced->lights();
    Segments at(context, segments, counts, radiance);
    if (table.shiningEnvironment()) at.addEnvironment();
    if (samplesTree(context))
        at.addTree();
    else if (!table.areaLights().empty())
        at.addArea();
    if (deltaLights.empty()) return;
    if (!segments.eachLight)
    {
        at.addOneDelta(deltaLights);
        return;
    }
    for (uint32_t k = 0; k < deltaLights.size(); ++k)
        at.addDelta(deltaLights[k].light, k, deltaLights[k].weight, segments.lanes);
}

} // namespace osgRayTrace::engine
