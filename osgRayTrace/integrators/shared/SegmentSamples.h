// SegmentSamples.h - a point of a stretch within a medium with a sample of a light. Layer:
// integrators; private to SegmentLights.cpp.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/SegmentLights.h"
#include "osgRayTrace/integrators/shared/SegmentRectangles.h"
#include "osgRayTrace/shading/LightTable.h"

namespace osgRayTrace::engine
{

/// A point of a stretch with its weight: transmittance over density [length], times that of a
/// medium which thins out.
struct Place
{
    Vec3 point;
    Vec3 weight{0.0f};     ///< 0: there is none
    float distance = 0.0f; ///< along the ray
};

/// Points of the stretches of a block and samples of lights from there, lane by lane. Functions
/// that set lane i return false if no light gets there.
class SegmentSamples
{
protected:
    SegmentSamples(const PassContext& context, const MediumSegments& segments)
        : _context(context), _table(context.traced->lights()), _segments(segments)
    {
    }

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
    Place byFlight(int i, float u) const;
    Place pivotOf(int i, float u) const;
    float phaseDensity(int i, float distance, float cosTheta) const;

    void setStretch(int i);
    bool setPlace(int i);
    ShiningRectangle rectangleOf(const LightTable::Choice& chosen) const;
    bool setRectangle(int i, const ShiningRectangle& light);
    bool setArea(int i, const LightTable::Choice& chosen);
    bool setTowards(int i, const Place& place, Vec3 light, Vec3 normal, bool twoSided, float area,
                    float offset, float pmf, Vec3 radiance);
    bool setDelta(int i, const Light& light, float weight, float along, Vec2 onLight);

    const PassContext& _context;
    const LightTable& _table;
    const MediumSegments& _segments;
    LightLanes _samples;
    StretchLanes _stretches;
    Place _places[kLanes];
};

} // namespace osgRayTrace::engine
