// KeptSamples.cpp - limits of kept samples, tile by tile. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/KeptSamples.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/history/ChangedSight.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kShareScale = 8.0f; ///< see limitKept
/// A box counts for a tile as a whole if its distance is this many times the tile's radius.
constexpr float kFar = 4.0f;
constexpr float kWideLobe = 1.0f; ///< wider lobes are as good as diffuse [radians]

float limitOf(float share)
{
    const float limit = 1.0f / (kShareScale * share * share);
    return limit >= 1.0f ? limit : 0.0f;
}

/// Holds a surface that lies in the middle of a pixel.
struct Spot
{
    std::size_t pixel = 0;
    Vec3 start, direction; ///< ray of the pixel
    float along = 0.0f;
    Vec3 point;          ///< if something is hit
    Vec3 mirrored{0.0f}; ///< unit mirror direction, if the surface has a lobe around it
    bool hit = false;
};

/// Holds what concerns the pixels of one tile, or of one block of a tile.
struct TileSight
{
    std::vector<Spot> spots;
    Vec3 centre{0.0f};
    float radius = 0.0f;
    Vec3 mirrored{0.0f};  ///< mean of the mirror directions
    float spread = -1.0f; ///< chord from the mean to the farthest edge of a lobe; < 0: no lobes
    std::vector<const SeenBox*> direct, near, reflected;
    std::vector<std::pair<const ShadowLight*, const SeenBox*>> shadows;
    float farShare = 0.0f;

    std::size_t looks() const
    {
        return direct.size() + near.size() + reflected.size() + shadows.size();
    }
};

/// A square of pixels, which may reach over the image's right and upper border.
struct PixelBlock
{
    int left, bottom, size;
};

struct Limiter
{
    const SurfaceMap& map;
    const ChangedSight& sight;
    std::vector<uint8_t> changedObject; ///< by object of the map

    TileSight everything() const;
    void limitBlock(const TileSight& around, PixelBlock block, std::size_t& spare,
                    float* limits) const;
    void findSpots(PixelBlock block, TileSight& tile) const;
    void findBoxes(const TileSight& around, PixelBlock block, TileSight& tile) const;
    float limit(const TileSight& tile, const Spot& spot) const;
    float share(const TileSight& tile, const Spot& spot) const;
    Vec3 normalOf(const Spot& spot) const
    {
        return {map.normalX[spot.pixel], map.normalY[spot.pixel], map.normalZ[spot.pixel]};
    }
    void findLobes(TileSight& tile) const;
    bool isReflected(const TileSight& tile, const SeenBox& box) const;
    float lobeShare(const TileSight& tile, const Spot& spot, float lobe) const;
};

/// Returns what may concern any pixel.
TileSight Limiter::everything() const
{
    TileSight all;
    for (const SeenBox& box : sight.boxes)
    {
        all.direct.push_back(&box);
        for (const ShadowLight& light : sight.lights)
            all.shadows.emplace_back(&light, &box);
    }
    all.near = all.reflected = all.direct;
    return all;
}

void Limiter::findSpots(PixelBlock block, TileSight& tile) const
{
    const CameraRays& c = map.rays.rays;
    const int right = std::min(block.left + block.size, map.view.width);
    const int top = std::min(block.bottom + block.size, map.view.height);
    Vec3 low(kInfinity), high(-kInfinity);
    for (int y = block.bottom; y < top; ++y)
        for (int x = block.left; x < right; ++x)
        {
            const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
            Spot spot;
            spot.pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(map.view.width) +
                         static_cast<std::size_t>(x);
            spot.start = c.origin + px * c.originDx + py * c.originDy;
            spot.direction = c.direction + px * c.directionDx + py * c.directionDy;
            spot.along = map.along[spot.pixel];
            spot.hit = map.object[spot.pixel] != 0 && std::isfinite(spot.along);
            if (spot.hit)
            {
                spot.point = spot.start + spot.along * spot.direction;
                low = glm::min(low, spot.point);
                high = glm::max(high, spot.point);
            }
            tile.spots.push_back(spot);
        }
    if (!(low.x <= high.x)) return;
    tile.centre = 0.5f * (low + high);
    tile.radius = 0.5f * glm::length(high - low);
    findLobes(tile);
}

void Limiter::findLobes(TileSight& tile) const
{
    const auto lobeOf = [&](const Spot& spot)
    { return spot.hit ? map.lobe[spot.pixel] : kInfinity; };
    for (Spot& spot : tile.spots)
    {
        if (!(lobeOf(spot) < kWideLobe)) continue;
        const Vec3 in = glm::normalize(spot.direction), normal = normalOf(spot);
        spot.mirrored = in - 2.0f * glm::dot(in, normal) * normal;
        tile.mirrored += spot.mirrored;
    }
    const float length = glm::length(tile.mirrored);
    if (length > 0.0f) tile.mirrored /= length;
    for (const Spot& spot : tile.spots)
        if (lobeOf(spot) < kWideLobe)
            tile.spread =
                std::max(tile.spread, lobeOf(spot) + glm::length(spot.mirrored - tile.mirrored));
}

/// Returns false if no lobe of the tile reaches the box.
bool Limiter::isReflected(const TileSight& tile, const SeenBox& box) const
{
    if (tile.spread < 0.0f) return false;
    const Vec3 to = box.centre - tile.centre;
    const float distance = glm::length(to), radius = box.radius + tile.radius;
    if (!(distance > 2.0f * radius)) return true;
    // Seen from anywhere in the tile, the box lies within this chord of its direction.
    const float size = 1.2f * radius / distance;
    return glm::length(to / distance - tile.mirrored) <= tile.spread + size;
}

/// Finds what concerns the block among what concerns the larger block around it.
void Limiter::findBoxes(const TileSight& around, PixelBlock block, TileSight& tile) const
{
    for (const SeenBox* box : around.direct)
        if (box->left < block.left + block.size && box->right > block.left &&
            box->bottom < block.bottom + block.size && box->top > block.bottom)
            tile.direct.push_back(box);
    const bool anyHit = std::any_of(tile.spots.begin(), tile.spots.end(),
                                    [](const Spot& spot) { return spot.hit; });
    if (!anyHit) return;
    tile.farShare = around.farShare;
    for (const SeenBox* box : around.near)
    {
        const float distance = glm::length(box->centre - tile.centre);
        if (distance > kFar * (tile.radius + box->radius))
            tile.farShare += box->area / (kPi * distance * distance);
        else
            tile.near.push_back(box);
    }
    for (const SeenBox* box : around.reflected)
        if (isReflected(tile, *box)) tile.reflected.push_back(box);
    for (const auto& [light, box] : around.shadows)
        if (mayShade(*light, *box, tile.centre, tile.radius)) tile.shadows.emplace_back(light, box);
}

/// Returns the share of a lobe's width that changed boxes take. The angle between two directions is
/// compared by the chord.
float Limiter::lobeShare(const TileSight& tile, const Spot& spot, float lobe) const
{
    float sum = 0.0f;
    for (const SeenBox* box : tile.reflected)
    {
        const Vec3 to = box->centre - spot.point;
        const float distance = glm::length(to);
        if (!(distance > box->radius)) return 1.0f;
        const float size = box->radius / distance;
        const float chord = glm::length(to / distance - spot.mirrored);
        if (chord > lobe + size) continue;
        sum += size >= lobe ? 1.0f : size * size / (lobe * lobe);
    }
    return sum;
}

float Limiter::share(const TileSight& tile, const Spot& spot) const
{
    const Vec3 normal = normalOf(spot);
    float sum = tile.farShare;
    for (const SeenBox* box : tile.near)
    {
        const Vec3 to = box->centre - spot.point;
        const float squared = glm::dot(to, to), distance = std::sqrt(squared);
        const float height = glm::dot(to, normal);
        if (height < -box->radius) continue; // the whole box is below the surface
        const float cosine = std::min(1.0f, (height + box->radius) / std::max(distance, 1e-30f));
        sum += std::min(1.0f, cosine * box->area / (kPi * squared));
    }
    for (const auto& [light, box] : tile.shadows)
        sum += shadeOf(*light, *box, spot.point);
    const float lobe = map.lobe[spot.pixel];
    return lobe < kWideLobe ? sum + lobeShare(tile, spot, lobe) : sum;
}

float Limiter::limit(const TileSight& tile, const Spot& spot) const
{
    const uint32_t object = map.object[spot.pixel];
    if (object < changedObject.size() && changedObject[object]) return 0.0f;
    const bool smooth = spot.hit && !(map.lobe[spot.pixel] > 0.0f);
    const float end = spot.hit && !smooth ? 1.001f * spot.along : kInfinity;
    for (const SeenBox* box : tile.direct)
        if (crosses(*box, 0.0f, spot.start, spot.direction, end)) return 0.0f;
    if (!spot.hit) return kInfinity;
    return std::min(limitOf(share(tile, spot)), smooth ? kSmoothKept : kInfinity);
}

/// Limits the pixels of a block: by its quarters if too many looks concern the block, and if the
/// looks that are spare suffice for the quarters.
void Limiter::limitBlock(const TileSight& around, PixelBlock block, std::size_t& spare,
                         float* limits) const
{
    if (block.left >= map.view.width || block.bottom >= map.view.height) return;
    TileSight tile;
    tile.spots.reserve(static_cast<std::size_t>(block.size * block.size));
    findSpots(block, tile);
    findBoxes(around, block, tile);
    const std::size_t looks = tile.looks();
    if (looks > kMostTileLooks && block.size > 1 && 4 * looks <= spare)
    {
        spare -= 4 * looks;
        const int half = block.size / 2;
        for (const int up : {0, half})
            for (const int right : {0, half})
                limitBlock(tile, {block.left + right, block.bottom + up, half}, spare, limits);
        return;
    }
    for (const Spot& spot : tile.spots)
        limits[spot.pixel] = looks > kMostTileLooks ? 0.0f : limit(tile, spot);
}

/// Sets each value of a row to the least of itself and its neighbours', in the three rows given.
void leastAround(const float* below, const float* row, const float* above, std::size_t width,
                 std::vector<float>& columns, float* count)
{
    columns.resize(width + 2);
    for (std::size_t x = 0; x < width; ++x)
        columns[x + 1] = std::min(row[x], std::min(below[x], above[x]));
    columns[0] = columns[1];
    columns[width + 1] = columns[width];
    for (std::size_t x = 0; x < width; ++x)
        count[x] =
            std::min(count[x], std::min(columns[x + 1], std::min(columns[x], columns[x + 2])));
}

} // namespace

void limitKept(const SurfaceMap& map, const Scene& scene, const std::vector<Light>& lights,
               const SceneChange& change, const Workers& workers, std::vector<float>& count)
{
    if (change.boxes.empty()) return;
    const ChangedSight sight = changedSight(map, scene, lights, change);
    if (sight.lights.size() > kMostShadowLights ||
        sight.boxes.size() * (1 + sight.lights.size()) > kMostLooks)
    {
        std::fill(count.begin(), count.end(), 0.0f);
        return;
    }
    Limiter limiter{map, sight, {}};
    limiter.changedObject.resize(change.instances.empty() ? 0 : change.instances.back() + 2u);
    for (const uint32_t instance : change.instances)
        limiter.changedObject[instance + 1u] = 1;
    const TileSight everything = limiter.everything();
    std::vector<float> limits(count.size());
    const int across = tilesAlong(map.view.width), down = tilesAlong(map.view.height);
    workers.forEach(
        static_cast<std::size_t>(across) * static_cast<std::size_t>(down),
        [&](std::size_t index)
        {
            const int tile = static_cast<int>(index);
            std::size_t spare = kMostTileLooks * kTilePixels;
            const PixelBlock block{tile % across * kTileSize, tile / across * kTileSize, kTileSize};
            limiter.limitBlock(everything, block, spare, limits.data());
        });
    const auto width = static_cast<std::size_t>(map.view.width);
    const auto height = static_cast<std::size_t>(map.view.height);
    forEachRows(workers, map.view.height,
                [&](std::size_t first, std::size_t end)
                {
                    std::vector<float> columns;
                    for (std::size_t y = first; y < end; ++y)
                    {
                        const float* row = &limits[y * width];
                        leastAround(y > 0 ? row - width : row, row,
                                    y + 1 < height ? row + width : row, width, columns,
                                    &count[y * width]);
                    }
                });
}

} // namespace osgRayTrace::engine
