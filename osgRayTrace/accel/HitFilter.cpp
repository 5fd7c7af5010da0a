// HitFilter.cpp - surfaces that let some rays pass: alpha, alpha test, culled faces, panes. Layer:
// accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/HitFilter.h"

#include "osgRayTrace/accel/Embree.h"
#include "osgRayTrace/accel/SurfaceAttributes.h"
#include "osgRayTrace/sampling/Hash.h"

#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

/// The opacity below which a surface cannot be seen in 8 bits.
constexpr float kSmallestOpacity = 1.0f / 512.0f;

float chance(const HitFilter::Candidate& c)
{
    uint32_t bits[6];
    std::memcpy(bits, &c.origin, 12);
    std::memcpy(bits + 3, &c.direction, 12);
    uint32_t key = hash(c.instance, c.primitive);
    for (const uint32_t b : bits)
        key = hash(key, b);
    return unitFloat(key);
}

/// Returns whether the ray meets a side of the face that is culled for the ray.
bool passesFace(const Material& material, bool front, HitRule rule)
{
    if (!rule.culls && !material.cullsAllRays) return false;
    if (rule.fromLight) return material.culling == FaceCulling::FrontAndBack; // see PhotonTracer
    return isCulled(material, front);
}

HitFilter::Candidate candidateOf(const RTCFilterFunctionNArguments* args, unsigned int i,
                                 uint32_t instance)
{
    const unsigned int n = args->N;
    HitFilter::Candidate c;
    c.instance = instance;
    c.primitive = RTCHitN_primID(args->hit, n, i);
    c.u = RTCHitN_u(args->hit, n, i);
    c.v = RTCHitN_v(args->hit, n, i);
    c.origin = Vec3(RTCRayN_org_x(args->ray, n, i), RTCRayN_org_y(args->ray, n, i),
                    RTCRayN_org_z(args->ray, n, i));
    c.direction = Vec3(RTCRayN_dir_x(args->ray, n, i), RTCRayN_dir_y(args->ray, n, i),
                       RTCRayN_dir_z(args->ray, n, i));
    const Vec3 normal(RTCHitN_Ng_x(args->hit, n, i), RTCHitN_Ng_y(args->hit, n, i),
                      RTCHitN_Ng_z(args->hit, n, i));
    c.front = glm::dot(normal, c.direction) < 0.0f;
    return c;
}

PaneCrossing crossingOf(const RTCFilterFunctionNArguments* args, unsigned int i)
{
    const unsigned int n = args->N;
    return {RTCRayN_tfar(args->ray, n, i),   RTCHitN_u(args->hit, n, i),
            RTCHitN_v(args->hit, n, i),      RTCHitN_primID(args->hit, n, i),
            RTCHitN_geomID(args->hit, n, i), RTCHitN_instID(args->hit, n, i, 0)};
}

/// Refuses the hits that do not stop their rays.
void filter(const RTCFilterFunctionNArguments* args)
{
    const auto& context = *static_cast<const FilterContext*>(args->context);
    const HitFilter& hits = *context.filter;
    const unsigned int n = args->N;
    for (unsigned int i = 0; i < n; ++i)
    {
        if (args->valid[i] == 0) continue;
        const uint32_t instance =
            hitInstance(RTCHitN_geomID(args->hit, n, i), RTCHitN_instID(args->hit, n, i, 0));
        const bool stops =
            hits.isSolid(instance) || hits.stops(candidateOf(args, i, instance), context.rule);
        const bool passesPane =
            stops && context.crossings && hits.isPane(instance) &&
            context.crossings->note(RTCRayN_id(args->ray, n, i), crossingOf(args, i));
        if (!stops || passesPane) args->valid[i] = 0;
    }
}

} // namespace

bool HitFilter::stops(const Candidate& c, HitRule rule) const
{
    if (rule.solid) return true;
    const SurfaceRecord& surface = _surfaces[c.instance];
    const MaterialRecord& record = _materials[surface.material];
    if (record.interface && rule.passesInterfaces) return false;
    if (!record.partial) return true;
    const Material& material = *record.material;
    if (passesFace(material, isFrontFace(material, c.front), rule)) return false;
    if (!material.blended && material.alphaTest == AlphaTest::Always) return true;

    Vec3 direction = c.direction;
    if (record.generated && surface.placed)
        direction = surface.placed->engineFromLocal.linear * direction;
    const float opacity =
        _materials.opacity(surface.material, materialPointOf(surface, record, c.primitive, c.u, c.v,
                                                             c.front, direction));
    if (opacity >= 1.0f) return true;
    if (rule.keepsBlended) return opacity >= kSmallestOpacity;
    return chance(c) < opacity;
}

bool needsFilter(const MaterialRecord& record, bool masks)
{
    const Material& material = *record.material;
    const bool transparent = material.blended || material.alphaTest != AlphaTest::Always;
    if (record.interface || record.pane) return true;
    return record.partial && (transparent || !masks || !isHiddenFromCamera(material));
}

void setHitFilter(void* geometry)
{
    rtcSetGeometryIntersectFilterFunction(static_cast<RTCGeometry>(geometry), filter);
    rtcSetGeometryOccludedFilterFunction(static_cast<RTCGeometry>(geometry), filter);
}

} // namespace osgRayTrace::engine
