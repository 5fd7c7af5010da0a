// PhotonOpenings.cpp - small openings that photons are sent through. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonOpenings.h"

#include "osgRayTrace/sampling/Warp.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// A cone that holds an opening, as a point on a surface sees it.
struct Cone
{
    float distance2;  ///< from the point to the centre [length^2]
    float above;      ///< along the normal
    float solidAngle; ///< times the opening's weight [sr]; 0 unless used
    uint32_t used;    ///< mask: light that comes from the point may go through the opening
};

/// An opening as loops over lanes read it.
struct PlainOpening
{
    PlainVec3 centre, axis;
    float radius2, weight;
};

OSGRAYTRACE_INLINE PlainOpening plainOpening(const PhotonOpening& opening)
{
    return {plainOf(opening.centre), plainOf(opening.axis), opening.radius * opening.radius,
            opening.weight};
}

OSGRAYTRACE_INLINE Cone coneOf(const PlainOpening& opening, PlainVec3 at, PlainVec3 normal)
{
    const PlainVec3 d = opening.centre - at;
    const float distance2 = dot(d, d);
    const float sin2 = opening.radius2 / distance2;
    const float rest = select(maskOf(sin2 < 1.0f), 1.0f - sin2, 0.0f);
    const float oneMinusCosine = sin2 / (1.0f + std::sqrt(rest));
    const float above = dot(d, normal);
    const uint32_t used =
        maskOf(dot(d, opening.axis) > 0.0f) & maskOf(above > 0.0f) & maskOf(sin2 < 0.9f);
    return {distance2, above, select(used, 2.0f * kPi * opening.weight * oneMinusCosine, 0.0f),
            used};
}

} // namespace

PhotonOpenings::PhotonOpenings(std::vector<PhotonOpening> openings, float childrenPerFlux)
    : _openings(std::move(openings)), _childrenPerFlux(childrenPerFlux)
{
}

OSGRAYTRACE_KERNEL
static void addOpening(const PhotonOpening& opening, PhotonOpenings::Views& views)
{
    const PlainOpening plain = plainOpening(opening);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const Cone cone = coneOf(plain, plainOf(views.position, i), plainOf(views.normal, i));
        views.solidAngle[i] += cone.solidAngle;
        const float cosine = cone.above / std::sqrt(cone.distance2);
        views.flux[i] += select(cone.used, cone.solidAngle * cosine * kInvPi, 0.0f);
    }
}

void PhotonOpenings::look(const FloatLanes& power, LaneMask lanes, Views& views) const
{
    views.solidAngle = {};
    views.flux = {};
    for (const PhotonOpening& opening : _openings)
        addOpening(opening, views);
    views.lanes = 0;
    for (int i = 0; i < kLanes; ++i)
    {
        const float wanted = _childrenPerFlux * power[i] * views.flux[i];
        views.children[i] = wanted < 1.0f ? wanted : 1.0f;
        if (wanted > 0.0f && std::isfinite(views.solidAngle[i])) views.lanes |= lanes & (1u << i);
    }
}

OSGRAYTRACE_KERNEL
static void chooseOpening(const PhotonOpening& opening, const PhotonOpenings::Views& views,
                          FloatLanes& left, Vec3Lanes& d, FloatLanes& solidAngle,
                          FloatLanes& weight)
{
    const PlainOpening plain = plainOpening(opening);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const Cone cone = coneOf(plain, plainOf(views.position, i), plainOf(views.normal, i));
        const uint32_t chosen = maskOf(left[i] >= 0.0f) & cone.used;
        d.x[i] = select(chosen, plain.centre.x - views.position.x[i], d.x[i]);
        d.y[i] = select(chosen, plain.centre.y - views.position.y[i], d.y[i]);
        d.z[i] = select(chosen, plain.centre.z - views.position.z[i], d.z[i]);
        solidAngle[i] = select(chosen, cone.solidAngle, solidAngle[i]);
        weight[i] = select(chosen, plain.weight, weight[i]);
        left[i] -= cone.solidAngle;
    }
}

void PhotonOpenings::sample(const Views& views, const FloatLanes& choice, const FloatLanes& u,
                            const FloatLanes& v, LaneMask lanes, Vec3Lanes& wi,
                            FloatLanes& chosen) const
{
    chosen = {};
    FloatLanes left, solidAngle = {};
    Vec3Lanes d = {};
    for (int i = 0; i < kLanes; ++i)
        left[i] = choice[i] * views.solidAngle[i];
    for (const PhotonOpening& opening : _openings)
        chooseOpening(opening, views, left, d, solidAngle, chosen);
    for (const int i : lanesIn(lanes))
        setLane(wi, i,
                turnedTo(glm::normalize(laneOf(d, i)),
                         squareToCone({u[i], v[i]}, solidAngle[i] / (2.0f * kPi * chosen[i]))));
}

OSGRAYTRACE_KERNEL
static void addMet(const PhotonOpening& opening, const PhotonOpenings::Views& views,
                   const Vec3Lanes& wi, FloatLanes& met)
{
    const PlainOpening plain = plainOpening(opening);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const Cone cone = coneOf(plain, plainOf(views.position, i), plainOf(views.normal, i));
        const float along = dot(plain.centre - plainOf(views.position, i), plainOf(wi, i));
        const uint32_t meets = maskOf(cone.distance2 - along * along <= plain.radius2) &
                               maskOf(along > 0.0f) & cone.used;
        met[i] += select(meets, plain.weight, 0.0f);
    }
}

void PhotonOpenings::weigh(const Views& views, const Vec3Lanes& wi, const FloatLanes& least,
                           FloatLanes& weights) const
{
    FloatLanes met = {};
    Vec3Lanes used = {}; // numbers of other lanes may be of any kind, and slow
    for (const int i : lanesIn(views.lanes))
        setLane(used, i, laneOf(wi, i));
    for (const PhotonOpening& opening : _openings)
        addMet(opening, views, used, met);
    for (int i = 0; i < kLanes; ++i)
    {
        weights[i] = 1.0f;
        if (!((views.lanes >> i) & 1u)) continue;
        const float pdf = kInvPi * std::max(glm::dot(laneOf(views.normal, i), laneOf(wi, i)), 0.0f);
        const float through = views.children[i] * std::max(met[i], least[i]) / views.solidAngle[i];
        weights[i] = through > 0.0f ? pdf / (pdf + through) : 1.0f;
    }
}

} // namespace osgRayTrace::engine
