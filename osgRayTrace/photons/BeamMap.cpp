// BeamMap.cpp - finds photon beams near rays and sums up their light. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/BeamMap.h"

#include "osgRayTrace/film/PowerLanes.h"
#include "osgRayTrace/media/MediumWay.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// The most pieces of a beam. Scenes with few long beams would gain little by more.
constexpr float kMostPieces = 64.0f;

constexpr float kLog2E = 1.44269504f;

/// Holds a bundle and how far from its rays something counts. What a loop over lanes does stands in
/// a function of one lane: vectors that are declared in such a loop keep GCC from vectorizing it.
struct Neighbourhood
{
    PlainVec3 origin, axis;
    float begin, end, slope, distance;
    float width; ///< the bundle's radius and the distance

    OSGRAYTRACE_INLINE Neighbourhood(const RayBundle& bundle, float reach)
        : origin(plainOf(bundle.origin)),
          axis(plainOf(bundle.axis)),
          begin(bundle.begin),
          end(bundle.end),
          slope(bundle.slope),
          distance(reach),
          width(bundle.radius + reach)
    {
    }
};

OSGRAYTRACE_INLINE uint32_t isNodeNear(const BoxTree::Node& node, int i, const Neighbourhood& rays)
{
    const PlainVec3 w = plainOf(node.centre, i) - rays.origin;
    const float radius = node.radius[i];
    const float along = dot(w, rays.axis);
    const float later = select(along > rays.begin, along, rays.begin);
    const float t = select(later < rays.end, later, rays.end);
    const PlainVec3 off = mad(rays.axis, -t, w);
    // The slope holds at the end of the sphere that is farther away.
    const float reach = rays.width + radius + rays.slope * (t + radius + rays.distance);
    return maskOf(dot(off, off) <= reach * reach) & maskOf(radius >= 0.0f);
}

/// Returns the boxes of a node that may come within a distance of the rays of a bundle.
OSGRAYTRACE_KERNEL
LaneMask nodesNear(const BoxTree::Node& node, const RayBundle& bundle, float distance)
{
    const Neighbourhood rays(bundle, distance);
    LaneMask near = 0;
    OSGRAYTRACE_SIMD_OR(near)
    for (int i = 0; i < kLanes; ++i)
        near |= bitOfLane(isNodeNear(node, i, rays), i);
    return near;
}

/// Holds where the rays of a query are nearest to a beam.
struct Crossings
{
    FloatLanes along, onBeam, sine2, cosine;
    FloatLanes way{}, density{}; ///< see thinOut(): from the beam's origin to the ray's begin
};

/// Sets lane i of crossings. Returns all bits if the ray passes the piece within the radius.
OSGRAYTRACE_INLINE uint32_t crossLane(const BeamPiece& piece, const RayBlock& ray,
                                      const BeamQuery& q, int i, Crossings& c)
{
    const PlainVec3 beam = piece.direction;
    const PlainVec3 d = plainDirection(ray, i);
    const PlainVec3 w = piece.origin - plainOrigin(ray, i);
    const PlainVec3 n = cross(d, beam);
    const float sine2 = dot(n, n);
    const float inverse = 1.0f / select(sine2 > 1e-20f, sine2, 1e-20f);
    const float height = dot(w, n);
    const float along = dot(cross(w, beam), n) * inverse;
    const float onBeam = dot(cross(w, d), n) * inverse;
    c.along[i] = along;
    c.onBeam[i] = onBeam;
    c.sine2[i] = sine2;
    c.cosine[i] = dot(d, beam);
    return maskOf(height * height <= q.radius * q.radius * sine2) & maskOf(along >= q.begin[i]) &
           maskOf(along < q.end[i]) & maskOf(onBeam >= piece.begin) & maskOf(onBeam < piece.end) &
           maskOf(static_cast<int32_t>(q.medium[i]) == piece.medium) & maskOf(sine2 > 1e-20f);
}

/// Returns the lanes whose rays pass a piece within the radius.
OSGRAYTRACE_INLINE LaneMask crossingsOf(const BeamPiece& piece, const BeamQuery& q, Crossings& c)
{
    const RayBlock& ray = *q.ray;
    const BeamPiece beam = piece;
    LaneMask lanes = 0;
    OSGRAYTRACE_SIMD_OR(lanes)
    for (int i = 0; i < kLanes; ++i)
        lanes |= bitOfLane(crossLane(beam, ray, q, i, c), i);
    return lanes & q.lanes;
}

OSGRAYTRACE_INLINE float left(float sigmaT, float distance)
{
    // Lanes that no beam crosses may have any distance, or none.
    const float exponent = -kLog2E * sigmaT * distance;
    const float below = select(exponent < 0.0f, exponent, 0.0f);
    return exp2Lanes(select(below > -126.0f, below, -126.0f));
}

/// Returns the phase function of Henyey and Greenstein: PhaseFunction.h.
OSGRAYTRACE_INLINE float henyeyGreenstein(float g, float cosine)
{
    const float size = std::fabs(g);
    const float cosTheta = select(g < 0.0f, -cosine, cosine);
    const float d = (1.0f - size) * (1.0f - size) + 2.0f * size * (1.0f - cosTheta);
    return 0.25f * kInvPi * (1.0f - g * g) / (d * std::sqrt(d));
}

Vec3 vecOf(PlainVec3 v)
{
    return {v.x, v.y, v.z};
}

/// Sets the ways and the densities of crossings, some of which are in a medium that thins out.
void thinOut(const BeamPiece& piece, const BeamQuery& q, LaneMask lanes, Crossings& c)
{
    for (const int i : lanesIn(lanes))
    {
        const MediumRecord& medium = (*q.thinning)[static_cast<MediumId>(q.medium[i])];
        const Vec3 origin = vecOf(plainOrigin(*q.ray, i)),
                   direction = vecOf(plainDirection(*q.ray, i));
        const MediumWay ray(medium, origin, direction, {q.begin[i], c.along[i]});
        const MediumWay beam(medium, vecOf(piece.origin), vecOf(piece.direction),
                             {0.0f, c.onBeam[i]});
        c.way[i] = ray.length() + beam.length();
        c.density[i] = ray.density(c.along[i]);
    }
}

/// Adds what a piece scatters towards the rays that pass it.
template <bool kDroplets, bool kThins>
OSGRAYTRACE_INLINE void addCrossings(const BeamPiece& piece, const BeamQuery& q, LaneMask lanes,
                                     const Crossings& c, Vec3Lanes& radiance)
{
    const float perWidth = 0.5f / q.radius, leastSine = q.leastSine;
    const PlainVec3 power = piece.power;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float root = std::sqrt(c.sine2[i]);
        const float sine = select(root > leastSine, root, leastSine);
        // The light turns from the beam to the ray.
        float phase = henyeyGreenstein(q.anisotropy[i], -c.cosine[i]);
        if (kDroplets)
        {
            const float own = q.draineG[i], alpha = q.draineAlpha[i];
            const float draine = henyeyGreenstein(own, -c.cosine[i]) *
                                 (1.0f + alpha * c.cosine[i] * c.cosine[i]) /
                                 (1.0f + alpha * (1.0f + 2.0f * own * own) * (1.0f / 3.0f));
            phase += q.draineShare[i] * (draine - phase);
        }
        const float way = kThins ? c.way[i] : c.along[i] - q.begin[i] + c.onBeam[i];
        const float density = kThins ? c.density[i] : 1.0f;
        const float weight = select(laneBit(lanes, i), phase * perWidth * density / sine, 0.0f);
        const PlainVec3 sigmaT = plainOf(q.sigmaT, i);
        radiance.x[i] += weight * power.x * q.sigmaS.x[i] * left(sigmaT.x, way);
        radiance.y[i] += weight * power.y * q.sigmaS.y[i] * left(sigmaT.y, way);
        radiance.z[i] += weight * power.z * q.sigmaS.z[i] * left(sigmaT.z, way);
    }
}

ItemBox boxOf(const BeamPiece& piece)
{
    const auto at = [&](float t)
    {
        const PlainVec3 p = mad(piece.direction, t, piece.origin);
        return Vec3(p.x, p.y, p.z);
    };
    const Vec3 a = at(piece.begin), b = at(piece.end);
    return {glm::min(a, b), glm::max(a, b)};
}

} // namespace

RayBundle bundleOf(const RayBlock* const* blocks, const LaneMask* lanes, int count)
{
    RayBundle bundle;
    Vec3 origins(0.0f), directions(0.0f);
    float used = 0.0f;
    const auto forEach = [&](auto&& use)
    {
        for (int b = 0; b < count; ++b)
            for (const int i : lanesIn(lanes[b]))
            {
                const RayBlock& ray = *blocks[b];
                use(Vec3(ray.originX[i], ray.originY[i], ray.originZ[i]),
                    Vec3(ray.directionX[i], ray.directionY[i], ray.directionZ[i]));
            }
    };
    forEach(
        [&](Vec3 origin, Vec3 direction)
        {
            origins += origin;
            directions += direction;
            used += 1.0f;
        });
    if (!(used > 0.0f)) return bundle;
    bundle.origin = origins / used;
    const float length = glm::length(directions);
    bundle.axis = length > 1e-3f * used ? directions / length : Vec3(0.0f, 0.0f, 1.0f);
    // A ray o + s d is at t = (o - origin + s d).axis along the axis, and |o - origin + s d - t
    // axis| off it, which is at most |across o| + |across d| s.
    bool behind = false;
    forEach(
        [&](Vec3 origin, Vec3 direction)
        {
            const Vec3 w = origin - bundle.origin;
            const float along = glm::dot(w, bundle.axis);
            const float cosine = glm::dot(direction, bundle.axis);
            behind |= !(cosine > 0.1f);
            const float tangent =
                glm::length(direction - bundle.axis * cosine) / std::max(cosine, 0.1f);
            bundle.slope = std::max(bundle.slope, tangent);
            bundle.radius = std::max(bundle.radius, glm::length(w - bundle.axis * along) +
                                                        tangent * std::fabs(along));
            bundle.begin = std::min(bundle.begin, along);
        });
    bundle.slope *= 1.0001f;
    bundle.radius = bundle.radius * 1.0001f + 1e-6f * glm::length(bundle.origin);
    if (behind) bundle.radius = kInfinity;
    return bundle;
}

BeamMap::BeamMap(const std::vector<PhotonBeam>& beams, float pieceLength) : _beams(beams.size())
{
    std::vector<BeamPiece> pieces;
    std::vector<ItemBox> boxes;
    for (const PhotonBeam& beam : beams)
    {
        const float begin = beam.begin, length = beam.length - begin;
        const float wanted = std::ceil(length / pieceLength);
        const int count = static_cast<int>(std::clamp(wanted, 1.0f, kMostPieces));
        for (int k = 0; k < count; ++k)
        {
            const auto at = [&](int end) {
                return end == count ? beam.length
                                    : begin + length * static_cast<float>(end) / count;
            };
            pieces.push_back({plainOf(beam.origin), plainOf(beam.direction), at(k), at(k + 1),
                              plainOf(beam.power), beam.medium, static_cast<int32_t>(beam.edges)});
            boxes.push_back(boxOf(pieces.back()));
        }
    }
    std::vector<uint32_t> order;
    _tree = BoxTree(boxes, order);
    for (const uint32_t k : order)
        _pieces.add(pieces[k]);
}

void BeamPieces::clear()
{
    _pieces.clear();
    _ends.clear();
}

void BeamPieces::add(const BeamPiece& piece)
{
    const auto lane = static_cast<int>(_pieces.size() % kLanes);
    if (lane == 0) _ends.emplace_back();
    const PlainVec3 begin = mad(piece.direction, piece.begin, piece.origin);
    const PlainVec3 end = mad(piece.direction, piece.end, piece.origin);
    for (int i = lane; i < (lane == 0 ? kLanes : lane + 1); ++i) // lanes behind the last are read
    {
        setLane(_ends.back().begin, i, begin);
        setLane(_ends.back().end, i, end);
    }
    _pieces.push_back(piece);
}

namespace
{

/// Tests the segment that a piece is as seen along the axis: a segment in a plane, which must come
/// as near to the axis as the bundle is wide where the piece is farthest.
OSGRAYTRACE_INLINE uint32_t isPieceNear(const Vec3Lanes& begins, const Vec3Lanes& ends, int i,
                                        const Neighbourhood& rays)
{
    const PlainVec3 low = plainOf(begins, i) - rays.origin;
    const PlainVec3 high = plainOf(ends, i) - rays.origin;
    const float lowAlong = dot(low, rays.axis), highAlong = dot(high, rays.axis);
    const uint32_t ahead = maskOf(lowAlong < highAlong);
    const float nearest = select(ahead, lowAlong, highAlong);
    const float farthest = select(ahead, highAlong, lowAlong);
    const float reach = rays.width + rays.slope * rays.distance +
                        rays.slope * select(farthest > 0.0f, farthest, 0.0f);
    const PlainVec3 a = mad(rays.axis, -lowAlong, low), b = mad(rays.axis, -highAlong, high);
    const PlainVec3 ab = b - a;
    const float length2 = dot(ab, ab);
    const float part = -dot(a, ab) / select(length2 > 1e-30f, length2, 1e-30f);
    const float most = select(part < 1.0f, part, 1.0f);
    const PlainVec3 off = mad(ab, select(most > 0.0f, most, 0.0f), a);
    return maskOf(dot(off, off) <= reach * reach * 1.0002f) &
           maskOf(farthest >= rays.begin - reach) & maskOf(nearest <= rays.end + reach);
}

} // namespace

OSGRAYTRACE_KERNEL
LaneMask BeamPieces::near(std::size_t first, const RayBundle& bundle, float distance) const
{
    const Ends& ends = _ends[first / kLanes];
    const Neighbourhood rays(bundle, distance);
    LaneMask near = 0;
    OSGRAYTRACE_SIMD_OR(near)
    for (int i = 0; i < kLanes; ++i)
        near |= bitOfLane(isPieceNear(ends.begin, ends.end, i, rays), i);
    const std::size_t left = _pieces.size() - first;
    return left < kLanes ? near & ((1u << left) - 1u) : near;
}

void BeamMap::find(const RayBundle& bundle, float distance, BeamPieces& found) const
{
    found.clear();
    _tree.visit([&](const BoxTree::Node& node) { return nodesNear(node, bundle, distance); },
                [&](std::size_t first, std::size_t)
                {
                    for (const int i : lanesIn(_pieces.near(first, bundle, distance)))
                        found.add(_pieces[first + static_cast<std::size_t>(i)]);
                });
}

namespace
{

/// Adds what pieces scatter towards the rays that pass them.
template <bool kDroplets, bool kThins>
OSGRAYTRACE_INLINE void addPieces(const BeamPieces& pieces, std::size_t first, LaneMask near,
                                  const BeamQuery& query, Vec3Lanes& radiance)
{
    const auto mostEdges = static_cast<int32_t>(query.mostEdges);
    Crossings crossings;
    for (const int k : lanesIn(near))
    {
        const BeamPiece& piece = pieces[first + static_cast<std::size_t>(k)];
        if (piece.edges > mostEdges) continue;
        const LaneMask lanes = crossingsOf(piece, query, crossings);
        if (!lanes) continue;
        if (kThins) thinOut(piece, query, lanes, crossings);
        addCrossings<kDroplets, kThins>(piece, query, lanes, crossings, radiance);
    }
}

OSGRAYTRACE_KERNEL
void gatherPieces(const BeamPieces& pieces, std::size_t first, LaneMask near,
                  const BeamQuery& query, Vec3Lanes& radiance)
{
    addPieces<false, false>(pieces, first, near, query, radiance);
}

OSGRAYTRACE_KERNEL
void gatherDroplets(const BeamPieces& pieces, std::size_t first, LaneMask near,
                    const BeamQuery& query, Vec3Lanes& radiance)
{
    addPieces<true, false>(pieces, first, near, query, radiance);
}

OSGRAYTRACE_KERNEL
void gatherThinning(const BeamPieces& pieces, std::size_t first, LaneMask near,
                    const BeamQuery& query, Vec3Lanes& radiance)
{
    addPieces<true, true>(pieces, first, near, query, radiance);
}

} // namespace

void gatherBeams(const BeamPieces& pieces, const RayBundle& bundle, const BeamQuery& query,
                 Vec3Lanes& radiance)
{
    for (int i = 0; i < kLanes; ++i)
        radiance.x[i] = radiance.y[i] = radiance.z[i] = 0.0f;
    for (std::size_t first = 0; first < pieces.size(); first += kLanes)
    {
        const LaneMask near = pieces.near(first, bundle, query.radius);
        if (near && query.thinning)
            gatherThinning(pieces, first, near, query, radiance);
        else if (near && query.hasDroplets)
            gatherDroplets(pieces, first, near, query, radiance);
        else if (near)
            gatherPieces(pieces, first, near, query, radiance);
    }
}

float distanceToBeams(const std::vector<PhotonBeam>& beams, Vec3 point, Vec3 direction,
                      std::size_t count)
{
    std::vector<float> distances;
    for (const PhotonBeam& beam : beams)
    {
        const Vec3 w = beam.origin - point, n = glm::cross(direction, beam.direction);
        const float sine2 = glm::dot(n, n);
        if (!(sine2 > 1e-12f)) continue;
        const float onBeam = glm::dot(glm::cross(w, direction), n) / sine2;
        if (!(onBeam >= beam.begin) || !(onBeam < beam.length)) continue;
        distances.push_back(std::fabs(glm::dot(w, n)) / std::sqrt(sine2));
    }
    if (count == 0 || distances.size() < count) return kInfinity;
    const auto nth = distances.begin() + static_cast<std::ptrdiff_t>(count - 1);
    std::nth_element(distances.begin(), nth, distances.end());
    return *nth;
}

} // namespace osgRayTrace::engine
