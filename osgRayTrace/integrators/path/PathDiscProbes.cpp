// PathDiscProbes.cpp - rays that tell where the surface under a disc ends. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// Rays run from a point above the disc's centre to points of the disc. A ray that meets the disc's
// plane there, and nothing before, tells that the surface is there. If all that do so are aimed at
// one side of a line, and all others at the other side, and if the line is one that the scene has,
// and more rays beside it agree, the surface ends at the line: where a wall stands on it, or at an
// edge of one of its triangles.
#include "osgRayTrace/integrators/path/PathDiscProbes.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/shared/HitShading.h"

#include <cmath>
#include <optional>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kProbeHeight = 0.5f; ///< of the point above the disc, over the disc's radius

/// Rays within this share of the radius from a straight edge may meet either side of the edge.
constexpr float kEdgeRounding = 1e-3f;
constexpr float kBesideEdge = 0.02f;   ///< how far from an edge rays look for it, over the radius
constexpr float kLeastEdgeSine = 0.2f; ///< between planes that meet in a straight edge

/// Rays from a point above a disc to sixteen points of the disc.
struct Probes
{
    Vec3Lanes targets;
    RayHitBlock rays;
    SurfaceLanes surface;
    LaneMask on = 0; ///< rays that meet the plane of the disc
};

/// Points of a disc at which rays are aimed: one in each of sixteen sectors.
struct Spread
{
    float turn = 0.0f; ///< of the sectors, in sectors
    FloatLanes share;  ///< of the disc's area that is nearer to the centre than the point
};

/// Spreads points evenly over sixteen rings, too. ring: from 0 to 1.
Spread evenly(float turn, float ring)
{
    Spread spread{turn, {}};
    for (int i = 0; i < kLanes; ++i)
        spread.share[i] = (static_cast<float>((i * 7) % kLanes) + ring) / kLanes;
    return spread;
}

/// Puts all points on the rim, which every straight edge of the disc crosses.
Spread onRim(float turn)
{
    Spread spread{turn, {}};
    for (int i = 0; i < kLanes; ++i)
        spread.share[i] = 1.0f;
    return spread;
}

/// The directions of sixteen sectors.
struct Sectors
{
    Sectors()
    {
        for (int i = 0; i < kLanes; ++i)
        {
            const float angle = 2.0f * kPi * static_cast<float>(i) / kLanes;
            cosine[i] = std::cos(angle);
            sine[i] = std::sin(angle);
        }
    }
    FloatLanes cosine, sine;
};

/// The centre of a disc and its axes, which are as long as its radius.
struct DiscFrame
{
    PlainVec3 centre, x, y;
};

OSGRAYTRACE_INLINE PlainVec3 pointOf(DiscFrame disc, float x, float y)
{
    return mad(disc.y, y, mad(disc.x, x, disc.centre));
}

/// Sets points of a disc.
OSGRAYTRACE_KERNEL
void setPoints(const DiscFrame& disc, const Sectors& sectors, const FloatLanes& share,
               Vec3Lanes& points)
{
    const DiscFrame axes = disc;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float radius = std::sqrt(share[i]);
        setLane(points, i, pointOf(axes, radius * sectors.cosine[i], radius * sectors.sine[i]));
    }
}

/// What surfaces have to be like to count as on a disc.
struct OnDisc
{
    float radius; ///< with which photons are looked up
    /// Tilted surfaces may be farther from the plane, as photons may, whose disc has this centre.
    /// Nothing: for several discs.
    std::optional<Vec3> centre;
};

/// Sends rays to the targets.
void send(Tile& tile, const PhotonQuery& disc, const OnDisc& onDisc, Probes& probes)
{
    aimAt(plainOf(startAbove(disc)), probes.targets, 1.5f, probes.rays.ray);
    const TracedScene& traced = *tile.context.traced;
    traced.intersector().closestHits(probes.rays, kAllLanes, Coherence::Coherent);
    tile.counts.secondaryRays += kLanes;
    surfacesOf(traced.surfaces(), probes.rays, kAllLanes, probes.surface);
    const Plane plane = planeOf(disc);
    probes.on = 0;
    for (const int i : lanesIn(probes.surface.hits))
    {
        const Vec3 point = laneOf(probes.surface.position, i);
        const float distance = onDisc.centre ? glm::distance(point, *onDisc.centre) : 0.0f;
        if (isOn(plane, onDisc.radius, distance, point, laneOf(probes.surface.geometricNormal, i)))
            probes.on |= 1u << i;
    }
}

/// Sends rays to points that are spread over the disc.
void probe(Tile& tile, const PhotonQuery& disc, const Spread& spread, const OnDisc& onDisc,
           Probes& probes)
{
    static const Sectors kSectors;
    const ShadingFrame frame(disc.normal);
    const float angle = 2.0f * kPi / kLanes * spread.turn;
    const Vec3 x = disc.radius * std::cos(angle) * frame.tangent +
                   disc.radius * std::sin(angle) * frame.bitangent;
    const Vec3 y = glm::cross(disc.normal, x);
    setPoints({plainOf(disc.position), plainOf(x), plainOf(y)}, kSectors, spread.share,
              probes.targets);
    send(tile, disc, onDisc, probes);
}

/// Several sets of rays to one disc.
struct ProbeSets
{
    static constexpr int kCount = 3;
    Probes sets[kCount];
};

/// Returns the line in which a wall meets a plane: its points are those of the plane that are on
/// the result, too, whose normal is in the plane, on the side behind the wall. Nothing: the two
/// hardly differ.
std::optional<Plane> lineAtWall(const Plane& plane, const Plane& wall)
{
    const float cosine = glm::dot(plane.normal, wall.normal);
    const Vec3 across = plane.normal * cosine - wall.normal;
    const float sine = glm::length(across);
    if (!(sine >= kLeastEdgeSine)) return std::nullopt;
    return Plane{across / sine, (cosine * plane.offset - wall.offset) / sine};
}

/// Returns the line through a triangle's edge from a to b, as lineAtWall does. c: the third vertex.
std::optional<Plane> lineAtEdge(const Plane& plane, Vec3 a, Vec3 b, Vec3 c)
{
    Vec3 across = glm::cross(b - a, plane.normal);
    const float length = glm::length(across);
    if (!(length > 0.0f)) return std::nullopt;
    across *= (glm::dot(across, c - a) > 0.0f ? -1.0f : 1.0f) / length;
    return Plane{across, glm::dot(across, a)};
}

/// Returns whether the rays that meet the disc's plane do so before the line, and no others are
/// aimed there.
bool parts(const Plane& line, float rounding, const ProbeSets& probes)
{
    for (const Probes& p : probes.sets)
        for (int i = 0; i < kLanes; ++i)
        {
            const float beyond = heightAbove(line, laneOf(p.targets, i));
            if (((p.on >> i) & 1u) ? beyond > rounding : beyond < -rounding) return false;
        }
    return true;
}

/// Sends rays to both sides of all of a line within the disc. Returns whether those before it meet
/// the disc's plane, and those beyond do not: a body that overhangs the plane is no wall.
bool isEdge(Tile& tile, const PhotonQuery& disc, const Plane& line, const OnDisc& onDisc)
{
    const float height = heightAbove(line, disc.position);
    const float half2 = disc.radius * disc.radius - height * height;
    if (!(half2 > 0.0f)) return false;
    const Vec3 middle = disc.position - line.normal * height;
    const Vec3 along = glm::cross(disc.normal, line.normal) * std::sqrt(half2);
    constexpr int kPairs = kLanes / 2;
    Probes probes;
    for (int i = 0; i < kLanes; ++i)
    {
        const float place = (2.0f * static_cast<float>(i % kPairs) + 1.0f) / kPairs - 1.0f;
        const float side = i < kPairs ? -kBesideEdge : kBesideEdge;
        setLane(probes.targets, i, middle + along * place + line.normal * (side * disc.radius));
    }
    send(tile, disc, onDisc, probes);
    return probes.on == (1u << kPairs) - 1u;
}

/// Returns the line that parts the rays that meet the disc's plane from the others: where a wall
/// stands on the plane, or an edge of one of the triangles that they meet.
std::optional<Plane> straightEdge(Tile& tile, const PhotonQuery& disc, const OnDisc& onDisc,
                                  const ProbeSets& probes)
{
    const Plane plane = planeOf(disc);
    const auto isFound = [&](const std::optional<Plane>& line)
    {
        return line && parts(*line, kEdgeRounding * disc.radius, probes) &&
               isEdge(tile, disc, *line, onDisc);
    };
    for (const Probes& p : probes.sets)
    {
        const LaneMask off = p.surface.hits & ~p.on;
        if (!off) continue;
        const int i = firstLane(off);
        const Vec3 normal = laneOf(p.surface.geometricNormal, i);
        const Plane wall{normal, glm::dot(normal, laneOf(p.surface.position, i))};
        const std::optional<Plane> line = lineAtWall(plane, wall);
        if (isFound(line)) return line;
        break;
    }
    uint32_t seen[2] = {kInvalid, kInvalid}; // the last triangle
    for (const Probes& p : probes.sets)
        for (const int i : lanesIn(p.on))
        {
            if (p.rays.primitive[i] == seen[0] && p.surface.instance[i] == seen[1]) continue;
            seen[0] = p.rays.primitive[i];
            seen[1] = p.surface.instance[i];
            const PlainTriangle t = triangleAt(tile.context.traced->surfaces(), p.rays, i);
            const Vec3 vertices[] = {Vec3(t.a.x, t.a.y, t.a.z), Vec3(t.b.x, t.b.y, t.b.z),
                                     Vec3(t.c.x, t.c.y, t.c.z)};
            for (int k = 0; k < 3; ++k)
            {
                const std::optional<Plane> line =
                    lineAtEdge(plane, vertices[k], vertices[(k + 1) % 3], vertices[(k + 2) % 3]);
                if (isFound(line)) return line;
            }
        }
    return std::nullopt;
}

} // namespace

Vec3 startAbove(const PhotonQuery& disc)
{
    return disc.position + disc.normal * (kProbeHeight * disc.radius);
}

OSGRAYTRACE_KERNEL
void aimAt(PlainVec3 start, const Vec3Lanes& targets, float reach, RayBlock& rays)
{
    // Compilers take the two loops for vector code, and do not take one loop of both.
    for (int i = 0; i < kLanes; ++i)
        setRay(rays, i, start, start, 0.0f, 0.0f);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float x = targets.x[i] - start.x, y = targets.y[i] - start.y,
                    z = targets.z[i] - start.z;
        const float length = std::sqrt(x * x + y * y + z * z), scale = 1.0f / length;
        rays.directionX[i] = x * scale;
        rays.directionY[i] = y * scale;
        rays.directionZ[i] = z * scale;
        rays.tFar[i] = length * reach;
    }
}

DiscShare shareOf(Tile& tile, const PhotonQuery& disc, uint32_t seed)
{
    float turn, ring;
    sobol2Ordered(tile.context.key.index, dimensionSeed(seed, DimensionDiscEdge), turn, ring);
    const float tolerance = kPlaneShare * disc.radius;
    Probes probes;
    probe(tile, disc, evenly(turn, ring), {disc.radius, disc.position}, probes);
    DiscShare result;
    result.share = static_cast<float>(countLanes(probes.on)) / kLanes;
    for (const int i : lanesIn(probes.surface.hits & ~probes.on))
        result.blocked |=
            heightAbove(planeOf(disc), laneOf(probes.surface.position, i)) > -tolerance;
    return result;
}

FoundEdge findEdge(Tile& tile, const PhotonQuery& disc, float radius, uint32_t seed)
{
    const OnDisc onDisc{radius, std::nullopt};
    float turn, ring;
    sobol2Ordered(tile.context.key.index, dimensionSeed(seed, DimensionDiscEdge), turn, ring);
    const Spread spreads[ProbeSets::kCount] = {
        onRim(turn), evenly(turn + 0.5f, ring),
        evenly(turn, ring < 0.5f ? ring + 0.5f : ring - 0.5f)};
    ProbeSets probes;
    bool isClear = true;
    for (int k = 0; k < ProbeSets::kCount; ++k)
    {
        probe(tile, disc, spreads[k], onDisc, probes.sets[k]);
        isClear &= probes.sets[k].on == kAllLanes;
    }
    if (isClear) return {DiscEdge::None, {}};
    const std::optional<Plane> line = straightEdge(tile, disc, onDisc, probes);
    return line ? FoundEdge{DiscEdge::Straight, *line} : FoundEdge{};
}

} // namespace osgRayTrace::engine
