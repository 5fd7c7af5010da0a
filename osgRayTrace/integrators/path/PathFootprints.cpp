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
constexpr float kLeastExpected = 3.0f;

/// Footprints that are longer than this many roots of their area are left to discs.
constexpr float kLongestFootprint = 4.0f;

/// The corner of a pixel: its place in the image.
struct PixelCorner
{
    float x, y;
};

PixelCorner cornerOf(const Tile& tile, uint32_t pixel)
{
    const int block = static_cast<int>(pixel) / kLanes, lane = static_cast<int>(pixel) % kLanes;
    return {static_cast<float>(tile.left + laneX(block, lane)),
            static_cast<float>(tile.bottom + laneY(block, lane))};
}

/// Holds the part of a plane that a pixel sees, within a disc.
struct Footprint
{
    Vec3 centre{0.0f};
    float radius = 0.0f; ///< 0: the plane is seen too obliquely
    float area = 0.0f;
};

Footprint footprintOf(const PixelProjection& projection, PixelCorner pixel, const Plane& plane)
{
    const std::optional<Vec3> centre = projection.onPlane(pixel.x + 0.5f, pixel.y + 0.5f, plane);
    if (!centre) return {};
    float radius = 0.0f;
    for (int corner = 0; corner < 4; ++corner)
    {
        const std::optional<Vec3> at =
            projection.onPlane(pixel.x + static_cast<float>(corner & 1),
                               pixel.y + static_cast<float>(corner >> 1), plane);
        if (!at) return {};
        radius = std::max(radius, glm::length(*at - *centre));
    }
    const PixelProjection::Place place = projection.place(*centre);
    const float area = projection.pixelArea(*centre, place.s, plane.normal);
    if (!(radius * radius < kLongestFootprint * kLongestFootprint * area)) return {};
    return {*centre, radius * (1.0f + 0x1p-10f), area};
}

Plane planeOf(const Bounce& bounce, int i)
{
    const Vec3 normal = laneOf(bounce.surface.geometricNormal, i);
    return {normal, glm::dot(normal, laneOf(trianglePoints(bounce.surface), i))};
}

/// Returns whether a surface is on a plane as photons have to be that a look-up with this radius
/// finds.
bool isOn(const Plane& plane, float radius, Vec3 point, Vec3 normal)
{
    return std::fabs(glm::dot(plane.normal, point) - plane.offset) <= kPlaneShare * radius &&
           glm::dot(plane.normal, normal) >= kLeastNormalCosine;
}

} // namespace

bool cornersAreOn(Tile& tile, uint32_t index, const Plane& plane, float radius)
{
    const PixelCorner pixel = cornerOf(tile, index);
    constexpr LaneMask kCorners = 0xf;
    const PixelProjection& projection = *tile.context.projection;
    const TracedScene& traced = *tile.context.traced;
    RayHitBlock rays = {};
    for (int i = 0; i < kLanes; ++i)
    {
        const float x = pixel.x + static_cast<float>(i & 1),
                    y = pixel.y + static_cast<float>((i >> 1) & 1);
        const Vec3 direction = projection.direction(x, y);
        const float length = glm::length(direction);
        setRay(rays.ray, i, plainOf(projection.origin(x, y)), plainOf(direction / length),
               projection.nearS() * length, kInfinity);
    }
    traced.intersector().closestHits(rays, kCorners, Coherence::Coherent, kCameraRays);
    tile.counts.secondaryRays += 4;
    SurfaceLanes surface;
    surfacesOf(traced.surfaces(), rays, kCorners, surface);
    if ((surface.hits & kCorners) != kCorners) return false;
    for (const int i : lanesIn(kCorners))
        if (!isOn(plane, radius, laneOf(surface.position, i), laneOf(surface.geometricNormal, i)))
            return false;
    return true;
}

namespace
{

/// Sums up the photons that the queries find in the pixels of their lanes.
void addFound(Tile& tile, const PathBlock& block, const Bounce& bounce,
              const PhotonQueryLanes& queries, const PixelCorner* pixels, FootprintSums& sums)
{
    GatheredPhotons& gathered = *tile.result.photons.gathered;
    const PhotonMap& map = *tile.context.photons;
    const PixelProjection& projection = *tile.context.projection;
    GatherLanes points{queries, {}, bounce.bsdfs, bounce.gathering & ~bounce.rough};
    for (int i = 0; i < kLanes; ++i)
    {
        setLane(points.wo, i, -directionOf(block.rays.ray, i));
        setLane(sums.radiance, i, Vec3(0.0f));
    }
    std::vector<FoundPhoton>& found = tile.gatherScratch.foundLanes;
    found.clear();
    map.find(queries, found);
    for (const FoundPhoton& f : found)
    {
        const Photon photon = map.photon(f.photon);
        const PixelProjection::Place place = projection.place(photon.position);
        for (const int i : lanesIn(photon.direct ? f.lanes : f.lanes & ~points.directOnly))
        {
            if (std::floor(place.x) != pixels[i].x || std::floor(place.y) != pixels[i].y) continue;
            const uint32_t pixel = block.flagsOf(i).pixel();
            const float area =
                projection.pixelArea(photon.position, place.s, laneOf(queries.normal, i));
            const Vec3 radiance = laneOf(block.throughput, i) *
                                  scatterPhoton(points, bounce.albedo, bounce.diffuse, i, photon) *
                                  photon.power / area;
            setLane(sums.radiance, i, laneOf(sums.radiance, i) + radiance);
            if (gathered.seenStride && photon.bin != kInvalid && ((sums.chosen >> i) & 1u) &&
                (pixel + gathered.seenFirst) % gathered.seenStride == 0)
                gathered.seen.push_back({photon.bin, luminance(radiance)});
        }
    }
}

/// Returns the plane that the pixel compares its disc on, if the disc is small enough and the pixel
/// sees nothing but that plane.
SeenPlane planeToCompare(Tile& tile, uint32_t index, const Bounce& bounce,
                         const PhotonQueryLanes& queries, int i)
{
    const PixelCorner pixel = cornerOf(tile, index);
    const PixelProjection& projection = *tile.context.projection;
    const Vec3 point = laneOf(queries.position, i), normal = laneOf(queries.normal, i);
    const float discArea = kPi * queries.radius[i] * queries.radius[i];
    const float area = projection.pixelArea(point, projection.place(point).s, normal);
    SeenPlane result = tile.result.photons.gathered->planes[index];
    if (!(discArea < kLargestDisc * area)) return result;
    result.plane = planeOf(bounce, i);
    result.lookup = PixelLookup::Disc;
    if (!((bounce.diffuse >> i) & 1u) && bounce.bsdfs[i].scattersThrough()) return result;
    const Footprint footprint = footprintOf(projection, pixel, result.plane);
    if (footprint.radius > 0.0f && cornersAreOn(tile, index, result.plane, footprint.radius))
        result.lookup = PixelLookup::Compared;
    return result;
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
                      PhotonQueryLanes queries, FootprintSums& sums)
{
    sums.chosen = sums.compared = 0;
    GatheredPhotons& gathered = *tile.result.photons.gathered;
    if (!gathered.planes || bounce.number > 0 || bounce.below) return;
    queries.lanes &= ~bounce.collided; // the pixel does not see their surfaces
    PixelCorner pixels[kLanes];
    for (const int i : lanesIn(queries.lanes))
    {
        const uint32_t pixel = block.flagsOf(i).pixel();
        SeenPlane& known = gathered.planes[pixel];
        const bool isSmall = gathered.isSmall(known);
        const bool compares = known.lookup == PixelLookup::Compared && !isSmall &&
                              (gathered.choosesPlanes || gathered.balances);
        if (known.lookup != PixelLookup::Footprint && !isSmall && !compares) continue;
        pixels[i] = cornerOf(tile, pixel);
        const Footprint footprint =
            footprintOf(*tile.context.projection, pixels[i], planeOf(bounce, i));
        if (!(footprint.radius > 0.0f) ||
            !isOn(known.plane, footprint.radius, laneOf(queries.position, i),
                  laneOf(queries.normal, i)))
        {
            // The pixel sees more than one plane.
            if (gathered.choosesPlanes) known.lookup = PixelLookup::Disc;
            continue;
        }
        if (gathered.choosesPlanes && compares)
        {
            const float radius = gathered.radius[pixel];
            known.discPixels =
                kPi * radius * radius / (footprint.area * gathered.shrink2); // 0: no radius yet
        }
        setLane(queries.position, i, footprint.centre);
        queries.radius[i] = footprint.radius;
        (compares ? sums.compared : sums.chosen) |= 1u << i;
    }
    queries.lanes = sums.chosen | sums.compared;
    if (queries.lanes) addFound(tile, block, bounce, queries, pixels, sums);
}

void chooseFootprints(Tile& tile, const PathBlock& block, const Bounce& bounce,
                      const PhotonQueryLanes& queries, const Vec3Lanes& discRadiance,
                      const FootprintSums& footprints)
{
    SeenPlane* planes = tile.result.photons.gathered->planes;
    if (!planes || !tile.result.photons.gathered->choosesPlanes || bounce.number > 0 ||
        bounce.below)
        return;
    const float significance = tile.context.photonUse == PhotonUse::Caustics
                                   ? kCausticSignificance
                                   : kIndirectSignificance;
    for (const int i : lanesIn(queries.lanes & ~bounce.collided))
    {
        const uint32_t pixel = block.flagsOf(i).pixel();
        SeenPlane& known = planes[pixel];
        if (known.lookup == PixelLookup::Undecided)
        {
            known = planeToCompare(tile, pixel, bounce, queries, i);
            ++known.undecided;
        }
        if (!((footprints.compared >> i) & 1u)) continue;
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
            passes * expectedPhotons(tile, laneOf(queries, i)) >= kLeastExpected)
            known.lookup = PixelLookup::Footprint;
    }
}

} // namespace osgRayTrace::engine
