// SegmentLights.cpp - adds what all lights send to stretches within media. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/SegmentLights.h"

#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"
#include "osgRayTrace/integrators/shared/SegmentSamples.h"
#include "osgRayTrace/integrators/shared/ShadowLanes.h"
#include "osgRayTrace/integrators/shared/TreeLights.h"
#include "osgRayTrace/media/FreeFlight.h"
#include "osgRayTrace/media/PhaseFunction.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// The share of choices by LightTree that is even among all its emitters: one that does not shine
/// on the point for which the tree is asked may shine on others of the stretch.
constexpr float kEvenShare = 0.25f;

class Segments : SegmentSamples
{
public:
    Segments(const PassContext& context, const MediumSegments& segments, TileCounts& counts,
             Vec3Lanes& radiance)
        : SegmentSamples(context, segments), _counts(counts), _radiance(radiance)
    {
    }

    void addEnvironment();
    void addDelta(uint32_t light, uint32_t slot, float weight, LaneMask lanes);
    void addOneDelta(const SampledLights& lights);
    void addArea();
    void addTree();

private:
    void begin() { _samples.lit = _samples.tinted = 0; }
    void finish(LaneMask visible);

    TileCounts& _counts;
    Vec3Lanes& _radiance;
};

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
    // The first rectangle serves all its lanes at once, and writes to those of others, whose own
    // samples follow: there are few others without a LightTree.
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
