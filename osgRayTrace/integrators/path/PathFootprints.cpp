// PathFootprints.cpp - photons in the pixel's own footprint on a plane. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// A photon i of the flux power_i at y_i stands for the radiance f power_i / dA. The mean of the
// radiance over a pixel is the integral over the part of the surface that the pixel sees, weighted
// by the pixels per area there:
//
//   L = sum over photons that project into the pixel of f power_i / A(y_i)
//
// A(y) is the area that a pixel covers on the plane at y. No point of the sum depends on the place
// of the ray within the pixel, and no photon is blurred, so there is no bias if the pixel sees the
// plane alone [Hachisuka08, eq. 9, with the pixel for the disc]. Discs of several pixels have less
// noise, so pixels compare both estimates, pass by pass, and take the footprint as soon as the disc
// is seen to be wrong. They do so in the first passes alone (GatheredPhotons::choosesPlanes), so
// that a later pass does not depend on how many others one machine has made.
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/PixelProjection.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Discs of less than this many times the pixel's area are compared with the footprint. In larger
/// ones a pixel has few photons of its own.
constexpr float kLargestDisc = 64.0f;

/// A pixel takes the photons of its footprint from the pass on after which the sum of the
/// differences is so many of its standard errors. The light of caustics is sharp more often than
/// that of all photons, for which footprints have more noise.
constexpr float kCausticSignificance = 2.0f, kIndirectSignificance = 3.0f;

/// A footprint without a photon says little as long as fewer than so many are expected in it: by
/// the photons of the disc, in all passes that were compared. The standard error is too small then.
/// Where photons bring all light, three let one in twenty pixels change over by chance.
constexpr float kCausticExpected = 3.0f, kIndirectExpected = 5.0f;

/// Sets the corner of a pixel with the least x and y: its place in the image.
void setCorner(const Tile& tile, uint32_t pixel, int i, PixelLanes& pixels)
{
    const int block = static_cast<int>(pixel) / kLanes, lane = static_cast<int>(pixel) % kLanes;
    pixels.x[i] = static_cast<float>(tile.left + laneX(block, lane));
    pixels.y[i] = static_cast<float>(tile.bottom + laneY(block, lane));
}

/// Sets the products of vectors.
OSGRAYTRACE_KERNEL
void dotLanes(const Vec3Lanes& a, const Vec3Lanes& b, FloatLanes& products)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        products[i] = a.x[i] * b.x[i] + a.y[i] * b.y[i] + a.z[i] * b.z[i];
}

Plane planeOf(const Bounce& bounce, int i)
{
    const Vec3 normal = laneOf(bounce.surface.geometricNormal, i);
    return {normal, glm::dot(normal, laneOf(trianglePoints(bounce.surface), i))};
}

} // namespace

namespace
{

/// The corners of a block's pixels, and what is seen there.
struct BlockCorners
{
    static constexpr int kSide = kBlockSize + 1, kCount = kSide * kSide;
    Vec3 position[kCount], normal[kCount];
    bool isHit[kCount];
};

/// Sends rays through the corners of a block whose first corner is given.
void traceCorners(Tile& tile, float left, float bottom, BlockCorners& corners)
{
    const PixelProjection& projection = *tile.context.projection;
    const TracedScene& traced = *tile.context.traced;
    for (int first = 0; first < BlockCorners::kCount; first += kLanes)
    {
        const int count = std::min(kLanes, BlockCorners::kCount - first);
        RayHitBlock rays = {};
        for (int k = 0; k < count; ++k)
        {
            const float x = left + static_cast<float>((first + k) % BlockCorners::kSide),
                        y = bottom + static_cast<float>((first + k) / BlockCorners::kSide);
            const Vec3 direction = projection.direction(x, y);
            const float length = glm::length(direction);
            setRay(rays.ray, k, plainOf(projection.origin(x, y)), plainOf(direction / length),
                   projection.nearS() * length, kInfinity);
        }
        const LaneMask asked = (1u << count) - 1u;
        traced.intersector().closestHits(rays, asked, Coherence::Coherent, kCameraRays);
        tile.counts.secondaryRays += static_cast<uint64_t>(count);
        SurfaceLanes surface;
        surfacesOf(traced.surfaces(), rays, asked, surface);
        for (int k = 0; k < count; ++k)
        {
            corners.isHit[first + k] = (surface.hits >> k) & 1u;
            corners.position[first + k] = laneOf(surface.position, k);
            corners.normal[first + k] = laneOf(surface.geometricNormal, k);
        }
    }
}

/// Returns the lanes all of whose pixels' corners see their planes, as photons have to be on them
/// that look-ups with these radii find.
LaneMask seenAlone(Tile& tile, const PathBlock& block, const PlaneLanes& planes,
                   const FloatLanes& radius, LaneMask lanes)
{
    BlockCorners corners;
    int traced = -1; // the block of pixels whose corners these are
    for (const int i : lanesIn(lanes))
    {
        const int pixel = static_cast<int>(block.flagsOf(i).pixel());
        const int pixels = pixel / kLanes;
        if (pixels != traced)
            traceCorners(tile, static_cast<float>(tile.left + laneX(pixels, 0)),
                         static_cast<float>(tile.bottom + laneY(pixels, 0)), corners);
        traced = pixels;
        const Plane plane{laneOf(planes.normal, i), planes.offset[i]};
        const int first = laneX(0, pixel % kLanes) + BlockCorners::kSide * laneY(0, pixel % kLanes);
        for (const int k :
             {first, first + 1, first + BlockCorners::kSide, first + BlockCorners::kSide + 1})
            if (!corners.isHit[k] ||
                !isOn(plane, radius[i], corners.position[k], corners.normal[k]))
                lanes &= ~(1u << i);
    }
    return lanes;
}

/// Returns the lane of those given whose pixel a place is in; negative: none.
int laneAt(const PixelProjection::Place& place, const PixelLanes& pixels, LaneMask lanes)
{
    for (const int i : lanesIn(lanes))
        if (place.x >= pixels.x[i] && place.x < pixels.x[i] + 1.0f && place.y >= pixels.y[i] &&
            place.y < pixels.y[i] + 1.0f)
            return i;
    return -1;
}

/// Sums up the photons that the queries find in the pixels of their lanes.
void addFound(Tile& tile, const PathBlock& block, const Bounce& bounce,
              const PhotonQueryLanes& queries, const PixelLanes& pixels, FootprintSums& sums)
{
    GatheredPhotons& gathered = *tile.result.photons.gathered;
    const PhotonMap& map = *tile.context.photons;
    const PixelProjection& projection = *tile.context.projection;
    sums.radiance = {};
    std::vector<FoundPhoton>& found = tile.gatherScratch.foundLanes;
    found.clear();
    map.find(queries, projection.windowOf(pixels, queries.lanes), found);
    if (found.empty()) return;
    GatherLanes points{queries, {}, bounce.bsdfs, bounce.gathering & ~bounce.rough};
    for (const int i : lanesIn(queries.lanes & ~bounce.diffuse))
        setLane(points.wo, i, -directionOf(block.rays.ray, i));
    for (const FoundPhoton& f : found)
    {
        const PixelProjection::Place place = projection.place(map.position(f.photon));
        const int i = laneAt(place, pixels, f.lanes);
        if (i < 0) continue;
        const Photon photon = map.photon(f.photon);
        if (!photon.direct && ((points.directOnly >> i) & 1u)) continue;
        const float area =
            projection.pixelArea(photon.position, place.s, laneOf(queries.normal, i));
        const Vec3 radiance = laneOf(block.throughput, i) *
                              scatterPhoton(points, bounce.albedo, bounce.diffuse, i, photon) *
                              photon.power / area;
        setLane(sums.radiance, i, laneOf(sums.radiance, i) + radiance);
        const uint32_t pixel = block.flagsOf(i).pixel();
        if (gathered.seenStride && photon.bin != kInvalid && ((sums.chosen >> i) & 1u) &&
            (pixel + gathered.seenFirst) % gathered.seenStride == 0)
            gathered.seen.push_back({photon.bin, luminance(radiance)});
    }
}

/// Sets the planes that undecided pixels compare their discs on, if these are small enough and the
/// pixels see nothing but that plane.
void choosePlanes(Tile& tile, const PathBlock& block, const Bounce& bounce,
                  const PhotonQueryLanes& queries, LaneMask undecided)
{
    const PixelProjection& projection = *tile.context.projection;
    SeenPlane* const known = tile.result.photons.gathered->planes;
    PixelLanes pixels;
    PlaneLanes planes;
    LaneMask seesPlane = 0;
    for (const int i : lanesIn(undecided))
    {
        const uint32_t pixel = block.flagsOf(i).pixel();
        SeenPlane& seen = known[pixel];
        ++seen.undecided;
        const Vec3 point = laneOf(queries.position, i), normal = laneOf(queries.normal, i);
        const float discArea = kPi * queries.radius[i] * queries.radius[i];
        const float area = projection.pixelArea(point, projection.place(point).s, normal);
        if (!(discArea < kLargestDisc * area)) continue;
        if (!isOn(seen.plane, queries.radius[i], point, normal)) seen.edge = DiscEdge::Unknown;
        seen.plane = planeOf(bounce, i);
        seen.lookup = PixelLookup::Disc;
        if (!((bounce.diffuse >> i) & 1u) && bounce.bsdfs[i].scattersThrough()) continue;
        setCorner(tile, pixel, i, pixels);
        setLane(planes.normal, i, seen.plane.normal);
        planes.offset[i] = seen.plane.offset;
        seesPlane |= 1u << i;
    }
    if (!seesPlane) return;
    FootprintLanes footprints;
    projection.footprints(pixels, planes, footprints);
    for (const int i : lanesIn(seesPlane))
        if (!(footprints.radius[i] > 0.0f)) seesPlane &= ~(1u << i);
    for (const int i : lanesIn(seenAlone(tile, block, planes, footprints.radius, seesPlane)))
        known[block.flagsOf(i).pixel()].lookup = PixelLookup::Compared;
}

/// Returns how many photons a pixel has in its footprint, judged by those in its disc.
float expectedPhotons(Tile& tile, const PhotonQuery& disc)
{
    std::vector<uint32_t>& found = tile.gatherScratch.found;
    found.clear();
    tile.context.photons->find(disc, found);
    const PixelProjection& projection = *tile.context.projection;
    const float area =
        projection.pixelArea(disc.position, projection.place(disc.position).s, disc.normal);
    return static_cast<float>(found.size()) * area / (kPi * disc.radius * disc.radius);
}

} // namespace

void gatherFootprints(Tile& tile, const PathBlock& block, const Bounce& bounce,
                      const PhotonQueryLanes& discs, FootprintSums& sums)
{
    sums.chosen = sums.compared = 0;
    GatheredPhotons& gathered = *tile.result.photons.gathered;
    if (!gathered.planes || bounce.number > 0 || bounce.below) return;
    PixelLanes pixels;
    PlaneLanes planes;
    LaneMask chosen = 0, compares = 0;
    for (const int i : lanesIn(discs.lanes & ~bounce.collided)) // pixels see their surfaces
    {
        const uint32_t pixel = block.flagsOf(i).pixel();
        const SeenPlane& known = gathered.planes[pixel];
        if (known.lookup == PixelLookup::Footprint || gathered.isSmall(known))
            chosen |= 1u << i;
        else if (known.lookup == PixelLookup::Compared &&
                 (gathered.choosesPlanes || gathered.balances))
            compares |= 1u << i;
        else
            continue;
        setCorner(tile, pixel, i, pixels);
    }
    LaneMask lanes = chosen | compares;
    if (!lanes) return;
    planes.normal = bounce.surface.geometricNormal;
    dotLanes(planes.normal, trianglePoints(bounce.surface), planes.offset);
    FootprintLanes footprints;
    tile.context.projection->footprints(pixels, planes, footprints);
    for (const int i : lanesIn(lanes))
    {
        const uint32_t pixel = block.flagsOf(i).pixel();
        SeenPlane& known = gathered.planes[pixel];
        if (!(footprints.radius[i] > 0.0f) ||
            !isOn(known.plane, footprints.radius[i], laneOf(discs.position, i),
                  laneOf(discs.normal, i)))
        {
            // The pixel sees more than one plane.
            if (gathered.choosesPlanes) known.lookup = PixelLookup::Disc;
            lanes &= ~(1u << i);
            continue;
        }
        if (gathered.choosesPlanes && ((compares >> i) & 1u))
        {
            const float radius = gathered.radius[pixel];
            known.discPixels = kPi * radius * radius /
                               (footprints.area[i] * gathered.shrink2Of(known)); // 0: no radius yet
        }
    }
    sums.chosen = lanes & chosen;
    sums.compared = lanes & compares;
    if (!lanes) return;
    const PhotonQueryLanes queries{footprints.centre, discs.normal,    discs.shadingNormal,
                                   footprints.radius, discs.mostEdges, lanes};
    addFound(tile, block, bounce, queries, pixels, sums);
}

void chooseFootprints(Tile& tile, const PathBlock& block, const Bounce& bounce,
                      const PhotonQueryLanes& queries, const Vec3Lanes& discRadiance,
                      const FootprintSums& footprints)
{
    SeenPlane* planes = tile.result.photons.gathered->planes;
    if (!planes || !tile.result.photons.gathered->choosesPlanes || bounce.number > 0 ||
        bounce.below)
        return;
    const bool caustics = tile.context.photonUse == PhotonUse::Caustics;
    const float significance = caustics ? kCausticSignificance : kIndirectSignificance;
    const float expected = caustics ? kCausticExpected : kIndirectExpected;
    LaneMask undecided = 0;
    for (const int i : lanesIn(queries.lanes & ~bounce.collided))
        if (planes[block.flagsOf(i).pixel()].lookup == PixelLookup::Undecided) undecided |= 1u << i;
    if (undecided) choosePlanes(tile, block, bounce, queries, undecided);
    for (const int i : lanesIn(footprints.compared))
    {
        SeenPlane& known = planes[block.flagsOf(i).pixel()];
        const float difference =
            luminance(laneOf(discRadiance, i)) - luminance(laneOf(footprints.radiance, i));
        if (!std::isfinite(difference * difference)) continue;
        ++known.compared;
        known.difference += difference;
        known.squares += difference * difference;
        if (!(known.difference * known.difference > significance * significance * known.squares))
            continue;
        const auto passes = static_cast<float>(known.compared);
        if (known.difference < 0.0f ||
            passes * expectedPhotons(tile, laneOf(queries, i)) >= expected)
            known.lookup = PixelLookup::Footprint;
    }
}

} // namespace osgRayTrace::engine
