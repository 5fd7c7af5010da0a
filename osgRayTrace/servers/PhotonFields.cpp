// PhotonFields.cpp - photons and what look-ups of them read and write, in messages. Layer: servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/PhotonFields.h"

#include <algorithm>

namespace osgRayTrace::engine
{

template <> struct LastEnumerator<PixelLookup>
{
    static constexpr PixelLookup value = PixelLookup::Footprint;
};
template <> struct LastEnumerator<DiscEdge>
{
    static constexpr DiscEdge value = DiscEdge::Near;
};

namespace
{

#if defined(__x86_64__) && defined(__linux__)
// Whoever adds a member to one of these adds it below, too.
static_assert(sizeof(SeenPlane) == 48 && sizeof(Photon) == 60 && sizeof(SeenPhoton) == 8 &&
              sizeof(SeenPoint) == 24);
static_assert(sizeof(GatheredPhotons) == 8736);
#endif

template <class Archive> void fieldsOf(Archive& a, SeenPlane& p)
{
    a(p.plane.normal, p.plane.offset, p.line.normal, p.line.offset, p.lookup, p.edge, p.undecided,
      p.compared, p.discPixels, p.difference, p.squares);
}

constexpr std::size_t kPlaneBytes = 2 * sizeof(Plane) + 3 * sizeof(float) + 4;

void putPlanes(WireWriter& out, const TilePhotons& photons)
{
    for (const SeenPlane& plane : photons.planes)
        fieldsOf(out, const_cast<SeenPlane&>(plane));
}

/// Reads kTilePixels planes, or none.
void takePlanes(WireReader& in, bool has, TilePhotons& photons)
{
    photons.planes.clear();
    if (!has || in.left() < kTilePixels * kPlaneBytes) return has ? in.fail() : void();
    photons.planes.resize(kTilePixels);
    for (SeenPlane& plane : photons.planes)
        fieldsOf(in, plane);
}

} // namespace

void putWanted(WireWriter& out, const TilePhotons& photons)
{
    const GatheredPhotons& g = photons.gathered;
    const bool hasRadii =
        std::any_of(g.radius, g.radius + kTilePixels, [](float r) { return r != 0.0f; });
    out(g.choosesPlanes, g.shrink2, g.smoothShrink2, g.smallDisc, g.separate, g.wantsFirstHits,
        g.balances, g.wantsBlur, g.takesBlur, g.earlierBlur, g.comparedBlock, g.seenFirst,
        g.seenStride, g.pointStride, hasRadii);
    if (hasRadii) out.append(g.radius, sizeof g.radius);
    out(!photons.planes.empty());
    putPlanes(out, photons);
}

void takeWanted(WireReader& in, TilePhotons& photons)
{
    GatheredPhotons& g = photons.gathered;
    bool hasRadii = false, hasPlanes = false;
    in(g.choosesPlanes, g.shrink2, g.smoothShrink2, g.smallDisc, g.separate, g.wantsFirstHits,
       g.balances, g.wantsBlur, g.takesBlur, g.earlierBlur, g.comparedBlock, g.seenFirst,
       g.seenStride, g.pointStride, hasRadii);
    if (hasRadii) in.copy(g.radius, sizeof g.radius);
    in(hasPlanes);
    takePlanes(in, hasPlanes, photons);
    if (g.comparedBlock < -1 || g.comparedBlock >= kTileBlocks) in.fail();
}

void putFound(WireWriter& out, const TilePhotons& photons)
{
    const GatheredPhotons& g = photons.gathered;
    const bool hasPlanes = g.choosesPlanes && !photons.planes.empty();
    out(g.separate, g.wantsFirstHits, g.carried, g.leaked, g.blur, g.blurred, g.comparedBlock,
        hasPlanes);
    out.append(g.radius, sizeof g.radius);
    if (g.separate) out.append(g.count, sizeof g.count);
    if (g.separate) out.append(g.flux, sizeof g.flux);
    if (g.wantsFirstHits) out.append(g.atFirstHits, sizeof g.atFirstHits);
    if (g.comparedBlock >= 0) out.append(g.differences, sizeof g.differences);
    if (hasPlanes) putPlanes(out, photons);
    out.array(g.seen);
    out.array(g.points);
}

void takeFound(WireReader& in, TilePhotons& photons)
{
    GatheredPhotons& g = photons.gathered;
    bool hasPlanes = false;
    in(g.separate, g.wantsFirstHits, g.carried, g.leaked, g.blur, g.blurred, g.comparedBlock,
       hasPlanes);
    in.copy(g.radius, sizeof g.radius);
    if (g.separate) in.copy(g.count, sizeof g.count);
    if (g.separate) in.copy(g.flux, sizeof g.flux);
    if (g.wantsFirstHits) in.copy(g.atFirstHits, sizeof g.atFirstHits);
    if (g.comparedBlock >= 0) in.copy(g.differences, sizeof g.differences);
    takePlanes(in, hasPlanes, photons);
    in.array(g.seen);
    in.array(g.points);
}

} // namespace osgRayTrace::engine
