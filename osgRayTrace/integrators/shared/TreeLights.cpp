// TreeLights.cpp - light samples of surface points on lights that a tree chooses. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/TreeLights.h"

#include "osgRayTrace/integrators/shared/QuadLane.h"

namespace osgRayTrace::engine
{

namespace
{

OSGRAYTRACE_INLINE float sumAbs(PlainVec3 v)
{
    return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
}

OSGRAYTRACE_INLINE Quad quadOf(const LightEmitter& e)
{
    const PlainVec3 corner{e.corner[0], e.corner[1], e.corner[2]};
    const PlainVec3 u{e.edgeU[0], e.edgeU[1], e.edgeU[2]};
    const PlainVec3 v{e.edgeV[0], e.edgeV[1], e.edgeV[2]};
    const PlainVec3 perpendicular = cross(u, v);
    const float inverse = 1.0f / std::sqrt(dot(perpendicular, perpendicular));
    const uint32_t twoSided = 0u - ((e.flags / kTwoSided) & 1u);
    return {corner,   u,
            v,        perpendicular * inverse,
            e.area,   kLightOffsetScale * (sumAbs(corner) + sumAbs(u) + sumAbs(v)),
            twoSided, {e.radiance[0], e.radiance[1], e.radiance[2]}};
}

/// Sets the sample of lane i on a parallelogram. Returns all bits if its light can reach the
/// surface.
OSGRAYTRACE_INLINE uint32_t emitterLane(const LightEmitter& e, float inversePmf,
                                        const SurfaceLanes& surface, float u, float v, int i,
                                        uint32_t transmissive, LightLanes& samples)
{
    const Quad q = quadOf(e);
    return quadLane(q, inversePmf, surface, i, transmissive, {pointOn(q, u, v), 0.0f}, samples);
}

/// Returns all bits if the emitter is a rectangle that may be wide from lane i.
OSGRAYTRACE_INLINE uint32_t nearLane(const LightEmitter& e, const SurfaceLanes& surface, int i)
{
    const uint32_t rectangle = 0u - ((e.flags / kRectangle) & 1u);
    return rectangle & mayExceed(rectangleLight(e), plainOf(surface.position, i), kWideAngle);
}

OSGRAYTRACE_KERNEL
LaneMask nearEmitters(const LightEmitter* emitters, const UintLanes& numbers,
                      const SurfaceLanes& surface)
{
    LaneMask near = 0;
    OSGRAYTRACE_SIMD_OR(near)
    for (int i = 0; i < kLanes; ++i)
        near |= bitOfLane(nearLane(emitters[numbers[i]], surface, i), i);
    return near;
}

/// Sets the sample of lane i on a rectangle that may be wide.
bool rectangleLane(const LightEmitter& e, float pmf, const LightReceivers& receivers, int i,
                   uint32_t transmissive, LightLanes& samples)
{
    const Quad q = quadOf(e);
    const QuadPoint point =
        rectanglePoint(q, rectangleLight(e), plainOf(receivers.surface.position, i), receivers.u[i],
                       receivers.v[i]);
    return quadLane(q, 1.0f / pmf, receivers.surface, i, transmissive, point, samples) != 0;
}

OSGRAYTRACE_KERNEL
LaneMask emitterLanes(const LightEmitter* emitters, const UintLanes& numbers, const FloatLanes& pmf,
                      const LightReceivers& receivers, LaneMask transmissive, LightLanes& samples)
{
    const SurfaceLanes& surface = receivers.surface;
    const FloatLanes &u = receivers.u, &v = receivers.v;
    LaneMask lit = 0;
    OSGRAYTRACE_SIMD_OR(lit)
    for (int i = 0; i < kLanes; ++i)
        lit |= bitOfLane(emitterLane(emitters[numbers[i]], 1.0f / pmf[i], surface, u[i], v[i], i,
                                     laneBit(transmissive, i), samples),
                         i);
    return lit;
}

/// Sets the sample of lane i on a triangle. Returns false if its light cannot reach the surface.
/// The distance is measured from the start of the ray, as the path tracer measures it if a path
/// meets the triangle by chance. Far from the origin of space the start is not at the surface, and
/// densities that disagree would weight light twice.
bool triangleLane(const LightEmitter& e, float pmf, const LightReceivers& receivers, int i,
                  bool transmissive, LightLanes& samples)
{
    const Quad q = quadOf(e);
    const float u = receivers.u[i], v = receivers.v[i];
    const bool folded = u + v > 1.0f;
    const PlainVec3 on = pointOn(q, folded ? 1.0f - u : u, folded ? 1.0f - v : v);
    const Vec3 point(on.x, on.y, on.z), normal(q.normal.x, q.normal.y, q.normal.z);
    const SurfaceLanes& surface = receivers.surface;
    const Vec3 towards = point - laneOf(surface.position, i);
    if (!transmissive && !(glm::dot(laneOf(surface.geometricNormal, i), towards) > 0.0f))
        return false;
    const float length = glm::length(towards);
    if (!(length > 0.0f)) return false;
    const RayBegin begin = leave(surface, i, towards / length);
    const Vec3 way = point - begin.origin;
    const float distance = glm::length(way);
    if (!(distance > 0.0f)) return false;
    const Vec3 wi = way / distance;
    const float cosThetaL = std::fabs(glm::dot(wi, normal));
    const float weight = cosThetaL * e.area / (distance * distance * pmf);
    if (!(weight > 0.0f) || !(weight < 1e30f)) return false;
    setRay(samples.shadow, i, begin, wi, std::max(begin.tNear, distance - q.offset / cosThetaL));
    setSample(samples, i, wi, Vec3(q.radiance.x, q.radiance.y, q.radiance.z), weight);
    return true;
}

/// Returns the radiance of a point of a textured triangle.
Vec3 texturedRadiance(const PassContext& context, const LightEmitter& emitter, float u, float v)
{
    const Scene& scene = context.traced->scene();
    const Instance& instance = scene.instances[scene.lights[emitter.light].instance];
    const Mesh& mesh = *scene.meshes[instance.mesh];
    const bool folded = u + v > 1.0f;
    const float b = folded ? 1.0f - u : u, c = folded ? 1.0f - v : v;
    MaterialPoint point;
    const uint32_t set = emissionUvSet(scene.materials[instance.material]);
    const SharedArray<Vec2>& uvs = uvsOfSet(mesh, set);
    Vec2 uv(0.0f);
    if (!uvs.empty())
    {
        const UVec3& t = mesh.triangles[emitter.primitive];
        uv = uvs[t.x] + b * (uvs[t.y] - uvs[t.x]) + c * (uvs[t.z] - uvs[t.x]);
    }
    point.setUv(set, uv);
    return context.traced->materials().emission(instance.material, point);
}

} // namespace

EmitterPoint emitterPoint(const PassContext& context, const LightEmitter& emitter, float u, float v)
{
    const Quad q = quadOf(emitter);
    const bool folded = (emitter.flags & kTriangle) && u + v > 1.0f;
    const PlainVec3 on = pointOn(q, folded ? 1.0f - u : u, folded ? 1.0f - v : v);
    const Vec3 radiance = emitter.flags & kTextured
                              ? texturedRadiance(context, emitter, u, v)
                              : Vec3(q.radiance.x, q.radiance.y, q.radiance.z);
    return {Vec3(on.x, on.y, on.z), Vec3(q.normal.x, q.normal.y, q.normal.z), q.offset, radiance};
}

TreePoints treePoints(const SurfaceLanes& surface, const Vec3Lanes& normal, LaneMask throughSurface)
{
    TreePoints points{surface.position, normal};
    for (const int i : lanesIn(throughSurface))
        setLane(points.normal, i, Vec3(0.0f));
    return points;
}

void treeLightLanes(const PassContext& context, const TreePoints& points, const FloatLanes& choice,
                    float picks, const LightReceivers& receivers, TreeSamples& samples)
{
    SceneLightTree::Pick chosen;
    chosen.u = choice;
    context.traced->lights().tree()->chooseLanes(points.position, points.normal, &chosen, 1);
    treeLightLanes(context, chosen, picks, receivers, samples);
}

void treeLightLanes(const PassContext& context, const SceneLightTree::Pick& chosen, float picks,
                    const LightReceivers& receivers, TreeSamples& samples)
{
    const SceneLightTree& tree = *context.traced->lights().tree();
    samples.emitters = chosen.emitters;
    SceneLightTree::Gathered gathered;
    tree.gather(samples.emitters, gathered);
    for (int i = 0; i < kLanes; ++i)
        samples.pmf[i] = chosen.pmf[i] * picks;
    LightLanes& lights = samples.lights;
    const LaneMask transmissive = receivers.throughSurface | receivers.surface.terminatorLanes;
    LaneMask parallelograms = 0;
    for (const int i : lanesIn(receivers.active))
        parallelograms |= LaneMask((gathered.of(i).flags & (kTriangle | kPoint)) == 0) << i;
    LaneMask lit = 0, near = 0;
    if (parallelograms)
        lit = emitterLanes(gathered.emitters, gathered.at, samples.pmf, receivers, transmissive,
                           lights);
    if (parallelograms && tree.hasRectangles())
        near = nearEmitters(gathered.emitters, gathered.at, receivers.surface);
    lights.lit = lights.tinted = samples.points = 0;
    for (const int i : lanesIn(receivers.active))
    {
        const LightEmitter& emitter = gathered.of(i);
        if (emitter.isPoint())
        {
            samples.points |= 1u << i;
            if (!deltaLane(context, emitter.light, receivers, i, lights)) continue;
            lights.weight[i] /= samples.pmf[i];
            lights.lit |= 1u << i;
            continue;
        }
        bool isLit = ((lit >> i) & 1u) != 0;
        if (emitter.flags & kTriangle)
            isLit = triangleLane(emitter, samples.pmf[i], receivers, i, (transmissive >> i) & 1u,
                                 lights);
        else if ((near >> i) & 1u)
            isLit = rectangleLane(emitter, samples.pmf[i], receivers, i, laneBit(transmissive, i),
                                  lights);
        lights.lit |= static_cast<LaneMask>(isLit) << i;
        if (!(emitter.flags & kTextured)) continue;
        const Vec3 radiance = texturedRadiance(context, emitter, receivers.u[i], receivers.v[i]);
        for (int k = 0; k < 3; ++k)
            lights.radiance[k][i] = radiance[k];
    }
}

LaneMask visibleLanes(const PassContext& context, TreeSamples& samples, TileCounts& counts)
{
    const SceneLightTree& tree = *context.traced->lights().tree();
    LaneMask unshadowed = 0;
    for (const int i : lanesIn(samples.points & samples.lights.lit))
    {
        const Light& light = (*context.lights)[tree.emitter(samples.emitters[i]).light];
        unshadowed |= static_cast<LaneMask>(!light.castsShadows) << i;
    }
    samples.lights.lit &= ~unshadowed;
    return visibleLanes(context, samples.lights, counts) | unshadowed;
}

} // namespace osgRayTrace::engine
