// PhotonEmitterLanes.cpp - sixteen photons leave the lights at once. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonEmitter.h"

#include "osgRayTrace/sampling/Warp.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// A light that is a parallelogram, and the targets that photons are guided to.
struct Source
{
    Vec3 corner, edgeU, edgeV, normal;
    float offset, area;
    Vec3 radiance;
    uint32_t twoSided; ///< all bits or none are set
    const Sphere* targets;
    int targetCount;
    float guidedShare;
    const PhotonGuide* photonGuide; ///< or null
};

/// The cones of a target from the lanes' points on the light.
struct TargetCones
{
    Vec3Lanes axis;
    FloatLanes oneMinusCosine; ///< 0: the point is in or beside the target
};

/// The lanes' points on the light, and the cones that their directions are sampled in.
struct PointLanes
{
    Vec3Lanes position;
    FloatLanes total; ///< sum of 1 - cosine over the cones, times the target's weight
    TargetCones targetCones[PhotonEmitter::kMaxTargets];
    Vec3Lanes chosenAxis;
    FloatLanes chosenCone;
    UintLanes chosenTarget;
};

OSGRAYTRACE_KERNEL
void pointsOn(const Source& source, const EmissionLanes& e, PointLanes& p)
{
    const Source s = source;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float u = e.positionU[i], v = e.positionV[i];
        p.position.x[i] = s.corner.x + u * s.edgeU.x + v * s.edgeV.x;
        p.position.y[i] = s.corner.y + u * s.edgeU.y + v * s.edgeV.y;
        p.position.z[i] = s.corner.z + u * s.edgeU.z + v * s.edgeV.z;
        p.total[i] = 0.0f;
        p.chosenAxis.x[i] = p.chosenAxis.y[i] = p.chosenAxis.z[i] = 0.0f;
        p.chosenCone[i] = 0.0f;
        p.chosenTarget[i] = 0u;
    }
}

/// Adds the cone of a target, as PhotonEmitter::conesFrom does.
OSGRAYTRACE_KERNEL
void addCone(const Sphere& sphere, float weight, PointLanes& p, TargetCones& targetCone)
{
    const Vec3 centre = sphere.centre;
    const float radius = sphere.radius;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float dx = centre.x - p.position.x[i], dy = centre.y - p.position.y[i],
                    dz = centre.z - p.position.z[i];
        const float distance2 = dx * dx + dy * dy + dz * dz;
        const float sin2 = radius * radius / distance2;
        const float inverse = 1.0f / std::sqrt(distance2);
        const uint32_t outside = maskOf(sin2 < 0.999f);
        const float cosine2 = select(outside, 1.0f - sin2, 1.0f);
        const float cone = select(outside, sin2 / (1.0f + std::sqrt(cosine2)), 0.0f);
        targetCone.axis.x[i] = dx * inverse;
        targetCone.axis.y[i] = dy * inverse;
        targetCone.axis.z[i] = dz * inverse;
        targetCone.oneMinusCosine[i] = cone;
        p.total[i] += cone * weight;
    }
}

/// Chooses the cone of a target in the lanes whose at has not yet been counted down below 0. Called
/// for one target after the other, so the last cone stays chosen if rounding leaves a rest.
OSGRAYTRACE_KERNEL
void chooseCone(const TargetCones& targetCone, float weight, uint32_t target, FloatLanes& at,
                PointLanes& p)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float cone = targetCone.oneMinusCosine[i];
        const uint32_t take = maskOf(cone > 0.0f) & maskOf(at[i] >= 0.0f);
        p.chosenAxis.x[i] = select(take, targetCone.axis.x[i], p.chosenAxis.x[i]);
        p.chosenAxis.y[i] = select(take, targetCone.axis.y[i], p.chosenAxis.y[i]);
        p.chosenAxis.z[i] = select(take, targetCone.axis.z[i], p.chosenAxis.z[i]);
        p.chosenCone[i] = select(take, cone, p.chosenCone[i]);
        p.chosenTarget[i] = (target & take) | (p.chosenTarget[i] & ~take);
        at[i] = select(take, at[i] - cone * weight, at[i]);
    }
}

/// Sets the bins of the lanes that are guided. Returns e, with the numbers for directions replaced
/// in these lanes by their places in the cones.
EmissionLanes chooseBins(const Source& source, const EmissionLanes& e, const PointLanes& p,
                         UintLanes& bins)
{
    EmissionLanes chosen = e;
    for (int i = 0; i < kLanes; ++i)
    {
        bins[i] = kInvalid;
        if (!(p.total[i] > 0.0f) || !(e.choice[i] < source.guidedShare)) continue;
        const uint32_t target = p.chosenTarget[i];
        uint32_t bin = guideBinOf(e.directionU[i], e.directionV[i]);
        if (source.photonGuide)
        {
            const Vec2 at =
                source.photonGuide->sample(0, target, Vec2(e.directionU[i], e.directionV[i]), bin);
            chosen.directionU[i] = at.x;
            chosen.directionV[i] = at.y;
        }
        bins[i] = PhotonGuide::index(0, target, static_cast<uint32_t>(source.targetCount), bin);
    }
    return chosen;
}

/// Samples directions, guided or as the light shines.
OSGRAYTRACE_INLINE PlainVec3 direction(const Source& s, const EmissionLanes& e, const PointLanes& p,
                                       int i)
{
    const float share = select(p.total[i] > 0.0f, s.guidedShare, 0.0f);
    const uint32_t guided = maskOf(e.choice[i] < share);
    const float rest = (e.choice[i] - share) / (1.0f - share);
    const float side = select(s.twoSided & maskOf(rest >= 0.5f), -1.0f, 1.0f);
    const PlainVec3 axis = select(guided, plainOf(p.chosenAxis, i), plainOf(s.normal) * side);

    float sine, cosine;
    sinCosTurn(e.directionU[i], sine, cosine);
    const float v = e.directionV[i];
    // Guided directions are uniform in a cone (see squareToCone), the others go by the cosine.
    const float height = v * p.chosenCone[i];
    const float lz = select(guided, 1.0f - height, std::sqrt(1.0f - v));
    const float radius = std::sqrt(select(guided, height * (2.0f - height), v));
    return toWorld(frameOf(axis), {radius * cosine, radius * sine, lz});
}

OSGRAYTRACE_KERNEL
void directions(const Source& source, const EmissionLanes& e, const PointLanes& p,
                StartLanes& starts)
{
    const Source s = source;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        setLane(starts.direction, i, direction(s, e, p, i));
}

/// Counts the cones that directions lie in.
OSGRAYTRACE_KERNEL
void countInside(const TargetCones& targetCone, const StartLanes& starts, FloatLanes& inside)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float x = starts.direction.x[i] - targetCone.axis.x[i],
                    y = starts.direction.y[i] - targetCone.axis.y[i],
                    z = starts.direction.z[i] - targetCone.axis.z[i];
        const float cone = targetCone.oneMinusCosine[i];
        const uint32_t in = maskOf(0.5f * (x * x + y * y + z * z) <= cone) & maskOf(cone > 0.0f);
        inside[i] += select(in, 1.0f, 0.0f);
    }
}

/// Adds the weights of the bins that directions lie in. Most directions are in one cone.
void addWeightsInside(const PhotonGuide& weights, uint32_t target, const TargetCones& targetCone,
                      const StartLanes& starts, FloatLanes& inside)
{
    for (int i = 0; i < kLanes; ++i)
    {
        const Vec3 direction = laneOf(starts.direction, i), axis = laneOf(targetCone.axis, i);
        const Vec3 off = direction - axis;
        const float cone = targetCone.oneMinusCosine[i], height = 0.5f * glm::dot(off, off);
        if (height <= cone && cone > 0.0f)
            inside[i] += weights.weightAt(0, target, axis, direction, height / cone);
    }
}

/// Sets powers, divided by the density of the mixture, and origins. Returns the lanes that leave a
/// side that shines.
OSGRAYTRACE_KERNEL
LaneMask powers(const Source& source, const PointLanes& p, const FloatLanes& inside,
                StartLanes& starts)
{
    const Source s = source;
    LaneMask alive = 0;
    OSGRAYTRACE_SIMD_OR(alive)
    for (int i = 0; i < kLanes; ++i)
    {
        const float share = select(p.total[i] > 0.0f, s.guidedShare, 0.0f);
        const float signedCosine = starts.direction.x[i] * s.normal.x +
                                   starts.direction.y[i] * s.normal.y +
                                   starts.direction.z[i] * s.normal.z;
        const float cosine = std::fabs(signedCosine);
        const float sides = select(s.twoSided, 0.5f, 1.0f);
        const float guided =
            select(share > 0.0f, share * inside[i] / (2.0f * kPi * p.total[i]), 0.0f);
        const float pdf = (1.0f - share) * cosine * kInvPi * sides + guided;
        const float power = cosine * s.area / pdf;
        starts.power.x[i] = s.radiance.x * power;
        starts.power.y[i] = s.radiance.y * power;
        starts.power.z[i] = s.radiance.z * power;
        const float offset = select(signedCosine >= 0.0f, s.offset, -s.offset);
        starts.origin.x[i] = p.position.x[i] + s.normal.x * offset;
        starts.origin.y[i] = p.position.y[i] + s.normal.y * offset;
        starts.origin.z[i] = p.position.z[i] + s.normal.z * offset;
        const float all = starts.power.x[i] + starts.power.y[i] + starts.power.z[i] +
                          starts.origin.x[i] + starts.origin.y[i] + starts.origin.z[i];
        const uint32_t shines = maskOf(signedCosine >= 0.0f) | s.twoSided;
        alive |= bitOfLane(maskOf(cosine > 0.0f) & maskOf(pdf > 0.0f) &
                               maskOf(std::fabs(all) < kInfinity) & shines,
                           i);
    }
    return alive;
}

LaneMask emitFrom(const Source& source, const EmissionLanes& points, StartLanes& starts)
{
    PointLanes p;
    pointsOn(source, points, p);
    const float* weights = source.photonGuide ? source.photonGuide->targetWeights(0) : nullptr;
    for (int t = 0; t < source.targetCount; ++t)
        addCone(source.targets[t], weights ? weights[t] : 1.0f, p, p.targetCones[t]);
    FloatLanes at, inside = {};
    for (int i = 0; i < kLanes; ++i)
        at[i] =
            source.guidedShare > 0.0f ? points.choice[i] / source.guidedShare * p.total[i] : 0.0f;
    for (int t = 0; t < source.targetCount; ++t)
        chooseCone(p.targetCones[t], weights ? weights[t] : 1.0f, static_cast<uint32_t>(t), at, p);
    directions(source, chooseBins(source, points, p, starts.bin), p, starts);
    for (int t = 0; t < source.targetCount; ++t)
        if (source.photonGuide)
            addWeightsInside(*source.photonGuide, static_cast<uint32_t>(t), p.targetCones[t],
                             starts, inside);
        else
            countInside(p.targetCones[t], starts, inside);
    return powers(source, p, inside, starts);
}

} // namespace

LaneMask PhotonEmitter::emitLanes(const EmissionLanes& points, StartLanes& starts,
                                  const PhotonGuide* photonGuide) const
{
    // Most scenes have one parallelogram as their light. Photons of all others are emitted singly.
    if (_emitters.size() != 1 || _lights[_emitters[0]].kind != LightKind::Parallelogram)
        return emitSingly(points, starts, photonGuide);
    const uint32_t index = _emitters[0];
    const Light& light = _lights[index];
    const LightTable& table = _traced.lights();
    const int targets = _guidedShare > 0.0f ? static_cast<int>(_targets.size()) : 0;
    const Source source{light.corner,
                        light.edgeU,
                        light.edgeV,
                        table.normal(index),
                        table.pointOffset(index),
                        table.area(index),
                        light.radiance,
                        maskOf(light.twoSided),
                        _targets.data(),
                        targets,
                        _guidedShare,
                        photonGuide};
    for (int i = 0; i < kLanes; ++i)
        starts.light[i] = index;
    return emitFrom(source, points, starts);
}

LaneMask PhotonEmitter::emitSingly(const EmissionLanes& points, StartLanes& starts,
                                   const PhotonGuide* photonGuide) const
{
    LaneMask alive = 0;
    for (int i = 0; i < kLanes; ++i)
    {
        const std::optional<PhotonStart> start =
            emit({points.light[i], points.choice[i], Vec2(points.positionU[i], points.positionV[i]),
                  Vec2(points.directionU[i], points.directionV[i])},
                 photonGuide);
        if (!start) continue;
        setLane(starts.origin, i, start->origin);
        setLane(starts.direction, i, start->direction);
        setLane(starts.power, i, start->power);
        starts.light[i] = start->light;
        starts.bin[i] = start->bin;
        alive |= 1u << i;
    }
    return alive;
}

} // namespace osgRayTrace::engine
