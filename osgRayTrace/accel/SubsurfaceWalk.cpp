// SubsurfaceWalk.cpp - the way of light within a body with a diffuse boundary. Layer: accel.
// SPDX-License-Identifier: MIT
//
// Light enters by the cosine law, whatever direction it came from, collides within an isotropic
// medium of the extinction sigma, and leaves as from a Lambert surface [Chiang16]. With one channel
// the weight of a walk of n collisions is albedo^n, as free flights take the extinction and the
// phase function of their samples. In RGB each flight is one of all channels, chosen in proportion
// to the throughput, with the balance heuristic over the channels [Miller19, sect. 5]:
//
//   beta' = beta sigma albedo exp(-sigma t) / sum_c p_c sigma_c exp(-sigma_c t)    collision at t
//   beta' = beta exp(-sigma d) / sum_c p_c exp(-sigma_c d)                 boundary at d
//
// with p = beta / sum beta. Choosing anew at each flight is the same as choosing once by the
// throughput at the entry, weighted over whole walks: the sum of beta changes by albedo alone.
//
// Rays of flights end at their collision, as most surfaces are far away in mean ways. The rays of
// the first flight and of every collision whose number is a power of two go on to infinity: one
// that meets nothing has left the mesh through a hole.
//
// Where metal, or what is clear, covers a share of the surface, no light enters by that share, and
// light that comes to it from below goes back by the cosine law, as it does below the layers of a
// diffuse boundary (Kelemen's normalization, LayeredBsdf.h). Walks are reciprocal so, and keep
// their energy.
#include "osgRayTrace/accel/SubsurfaceWalk.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/SingleSurface.h"
#include "osgRayTrace/accel/SurfaceAttributes.h"
#include "osgRayTrace/media/FreeFlight.h"
#include "osgRayTrace/media/PhaseFunction.h"
#include "osgRayTrace/sampling/Hash.h"
#include "osgRayTrace/sampling/Warp.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Rays of walks meet every diffuse boundary, also one that is transparent or culled, and nothing
/// else: a body may stand on a floor that is exactly where the body ends.
constexpr HitRule kWalkRays{false, false, false, true, false, true};

/// The number of surfaces that one flight is followed through.
constexpr int kMostPassed = 64;

float largestOf(Vec3 v)
{
    return std::max(v.x, std::max(v.y, v.z));
}

/// Returns two numbers of a collision.
Vec2 numbersOf(uint32_t key, uint32_t collision, uint32_t use)
{
    const uint32_t first = hash(hash(key, collision), use);
    return {unitFloat(first), unitFloat(hash(first + 0x9e3779b9u))};
}

/// What a flight comes to.
enum class FlightEnd : uint8_t
{
    Collision,
    Boundary,
    Inwards, ///< a boundary, from which it goes back
    Nothing, ///< there is no surface on the whole ray
};

/// Follows a walk.
class Walker
{
public:
    Walker(const TracedScene& traced, const SubsurfaceEntry& entry, SubsurfaceWalk& walk)
        : _traced(traced), _entry(entry), _walk(walk)
    {
        for (int c = 0; c < 3; ++c)
            _albedo[c] = static_cast<float>(albedoOfColor(double(entry.color[c]), 0.0));
        walk.throughput = entry.throughput;
        goInwards(entry.position, -entry.normal, entry.offset, entry.direction);
    }

    SubsurfaceWalk::End run()
    {
        for (; _step <= kMostSubsurfaceCollisions; ++_step)
        {
            Vec2 u = numbersOf(_entry.key, _step, 0);
            const Vec3 pmf = channelPmf(_walk.throughput);
            const int channel = chooseChannel(pmf, u.x);
            const float distance = -std::log1p(-u.x) / _entry.sigma[channel];
            switch (fly(distance))
            {
            case FlightEnd::Nothing:
                return SubsurfaceWalk::End::Open;
            case FlightEnd::Boundary:
                _walk.throughput *= flightWeight(_entry.sigma, pmf, Vec3(1.0f), _walk.hit.t);
                _walk.position += _walk.direction * _walk.hit.t;
                return SubsurfaceWalk::End::Left;
            case FlightEnd::Inwards:
                _walk.throughput *= flightWeight(_entry.sigma, pmf, Vec3(1.0f), _walk.hit.t);
                continue;
            case FlightEnd::Collision:
                break;
            }
            _walk.throughput *=
                _entry.sigma * _albedo * flightWeight(_entry.sigma, pmf, _entry.sigma, distance);
            if (!survives(u.y)) return SubsurfaceWalk::End::Absorbed;
            const Vec2 turn = numbersOf(_entry.key, _step, 1);
            _walk.position += _walk.direction * distance;
            _walk.direction = samplePhase(0.0f, _walk.direction, turn.x, turn.y);
            _begin = 0.0f;
            ++_walk.collisions;
        }
        return SubsurfaceWalk::End::Cut;
    }

private:
    /// Lets light go into the body from a triangle. inwards: its normal, on that side.
    void goInwards(Vec3 point, Vec3 inwards, float offset, Vec2 u)
    {
        Vec3 tangent, bitangent;
        frameOf(inwards.x, inwards.y, inwards.z, tangent, bitangent);
        const Vec3 local = squareToCosineHemisphere(u.x, u.y);
        _walk.direction = tangent * local.x + bitangent * local.y + inwards * local.z;
        _walk.position = point;
        // The point is exact on its triangle, and the ray leaves that behind.
        _begin = offset / std::max(local.z, 1e-3f);
    }

    /// Decides whether the walk leaves at a boundary; otherwise it goes back from there.
    FlightEnd atBoundary(const SingleSurface& met)
    {
        const SurfaceLanes& surface = met.surface;
        const uint32_t material = surface.material[0];
        const MaterialTable& materials = _traced.materials();
        if (!materials[material].baseShareVaries) return FlightEnd::Boundary;
        const Hit& hit = _walk.hit;
        const MaterialPoint point =
            materialPointOf(_traced.surfaces()[surface.instance[0]], materials[material],
                            hit.primitive, hit.u, hit.v, true, -_walk.direction);
        const Vec2 u = numbersOf(_entry.key, _step, 2);
        if (u.x < materials.leavingShare(material, point)) return FlightEnd::Boundary;
        const Vec3 normal = laneOf(surface.geometricNormal, 0);
        const bool isOutwards = glm::dot(normal, _walk.direction) > 0.0f;
        goInwards(laneOf(trianglePoints(surface), 0), isOutwards ? -normal : normal,
                  surface.offset[0], numbersOf(_entry.key, _step, 3));
        return FlightEnd::Inwards;
    }

    /// Plays roulette.
    bool survives(float u)
    {
        const float most = largestOf(_walk.throughput);
        if (!(most > 0.0f)) return false; // least is 0, too, for photons without power
        const float survival = std::min(1.0f, most / _entry.least);
        if (!(u < survival)) return false;
        _walk.throughput /= survival;
        return true;
    }

    /// Finds what comes first on the way, the collision at a distance or the inner side of a
    /// boundary.
    FlightEnd fly(float distance)
    {
        const bool probes = (_walk.collisions & (_walk.collisions - 1u)) == 0;
        bool isClosed = !probes;
        float begin = _begin;
        for (int k = 0; k < kMostPassed; ++k)
        {
            const float end = isClosed ? distance : kInfinity;
            if (!(begin < end)) return FlightEnd::Collision;
            const std::optional<Hit> hit = _traced.intersector().closestHit(
                _walk.position, _walk.direction, begin, end, kWalkRays);
            ++_walk.rays;
            if (!hit) return isClosed ? FlightEnd::Collision : FlightEnd::Nothing;
            const SingleSurface met(_traced, _walk.position, _walk.direction, *hit);
            const uint32_t material = met.surface.material[0];
            begin = std::nextafter(std::nextafter(hit->t, kInfinity), kInfinity);
            if (!_traced.materials()[material].subsurface) continue; // Embree masks no rays
            isClosed = true;
            if (hit->t >= distance) return FlightEnd::Collision;
            if (met.isFront())
                ++_entered; // of a body that overlaps this one
            else if (_entered > 0)
                --_entered;
            else
            {
                _walk.hit = *hit;
                return atBoundary(met);
            }
        }
        return FlightEnd::Collision;
    }

    const TracedScene& _traced;
    const SubsurfaceEntry& _entry;
    SubsurfaceWalk& _walk;
    Vec3 _albedo{0.0f};
    float _begin = 0.0f; ///< where on its way the next ray begins
    uint32_t _entered = 0;
    uint32_t _step = 0; ///< collisions and turns at boundaries
};

} // namespace

Vec3 walkingChannels(Vec3 sigma, float offset)
{
    constexpr float kLeastWay = 8.0f; // offsets: 256 steps of floats
    Vec3 channels;
    for (int c = 0; c < 3; ++c)
        channels[c] = sigma[c] * offset * kLeastWay < 1.0f ? 1.0f : 0.0f;
    return channels;
}

SubsurfaceWalk walkBelow(const TracedScene& traced, const SubsurfaceEntry& entry)
{
    SubsurfaceWalk walk;
    walk.end = Walker(traced, entry, walk).run();
    if (!isFinite(walk.throughput)) walk.end = SubsurfaceWalk::End::Absorbed;
    return walk;
}

void meetFromOutside(const SubsurfaceWalk& walk, RayHitBlock& rays, int i)
{
    const Vec3 outside = walk.position + walk.direction * walk.hit.t;
    setRay(rays.ray, i, plainOf(outside), plainOf(-walk.direction), 0.0f, walk.hit.t);
    rays.geometry[i] = walk.hit.instance; // see hitInstance
    rays.instance[i] = kInvalid;
    rays.primitive[i] = walk.hit.primitive;
    rays.u[i] = walk.hit.u;
    rays.v[i] = walk.hit.v;
}

} // namespace osgRayTrace::engine
