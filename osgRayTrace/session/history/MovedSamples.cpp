// MovedSamples.cpp - windows of an image that follow the objects in them. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/MovedSamples.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/history/ChangedSight.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kMargin = 2; ///< pixels around an object that tell where its edges are

bool followsVertices(const TextureMapping& mapping)
{
    return mapping.coordinates == TextureCoordinates::Uv0 ||
           mapping.coordinates == TextureCoordinates::Uv1;
}

bool followsVertices(const Scene& scene, const RigidMove& move)
{
    const uint32_t index = scene.instances[move.instance].material;
    if (index >= scene.materials.size()) return true;
    const Material& material = scene.materials[index];
    return followsVertices(material.mapping) && followsVertices(material.second.mapping);
}

/// Returns the angle by which the object turned [radians]. Small angles a are the root of half the
/// sum of squares of R - I, which is 8 sin^2(a / 2).
float turnOf(const RigidMove& move)
{
    double sum = 0.0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
        {
            const double d = move.afterFromBefore[column][row] - (column == row ? 1.0 : 0.0);
            sum += d * d;
        }
    return static_cast<float>(std::sqrt(0.5 * sum));
}

ReprojectionLimits limitsOf(const RigidMove& move, const std::vector<Vec3>& lamps)
{
    constexpr float kLeastTurn = 1e-6f; // mirrors keep nothing even if they move straight on
    const float step =
        0.5f * glm::length(move.after.low + move.after.high - move.before.low - move.before.high);
    float nearest = kInfinity;
    for (const Vec3 lamp : lamps)
        nearest = std::min(nearest,
                           glm::length(lamp - glm::clamp(lamp, move.after.low, move.after.high)));
    ReprojectionLimits limits;
    limits.turn = std::max(turnOf(move), kLeastTurn);
    limits.count = std::min(kMovedKept, kMovedTurn / (limits.turn + step / nearest));
    // Light on an object that jumps has nothing to do with that on its old place.
    const bool jumps = step > glm::length(move.after.high - move.after.low);
    if (jumps || !(nearest > 0.0f)) limits.count = 0.0f;
    limits.edgeCount = std::min(limits.edgeCount, limits.count);
    return limits;
}

SampledImage cutImage(const SampledImage& image, const PixelWindow& window)
{
    SampledImage result;
    result.width = window.width();
    result.height = window.height();
    result.radiance.reserve(4 * window.area());
    result.count.reserve(window.area());
    for (int y = window.bottom; y < window.top; ++y)
    {
        const auto row = static_cast<std::ptrdiff_t>(y) * image.width;
        result.radiance.insert(result.radiance.end(),
                               image.radiance.begin() + 4 * (row + window.left),
                               image.radiance.begin() + 4 * (row + window.right));
        result.count.insert(result.count.end(), image.count.begin() + row + window.left,
                            image.count.begin() + row + window.right);
    }
    return result;
}

/// Returns whether a pixel is at an edge of the object: the pixel is not smooth, and it or one of
/// the eight around it shows the object.
bool isAtEdge(const SurfaceMap& map, uint32_t object, int x, int y)
{
    const int width = map.view.width;
    const auto at = [width](int column, int row)
    {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(column);
    };
    if (map.smooth[at(x, y)]) return false;
    for (int row = std::max(y - 1, 0); row <= std::min(y + 1, map.view.height - 1); ++row)
        for (int column = std::max(x - 1, 0); column <= std::min(x + 1, width - 1); ++column)
            if (map.object[at(column, row)] == object) return true;
    return false;
}

/// Returns the move of points of world space, the other way round.
Mat4d worldMoveBack(const RigidMove& move, const Scene& scene)
{
    const Mat4d worldFromEngine =
        glm::scale(glm::translate(Mat4d(1.0), scene.origin), Vec3d(scene.unit));
    return worldFromEngine * glm::inverse(move.afterFromBefore) * glm::inverse(worldFromEngine);
}

} // namespace

/// Chooses the objects that may take samples along, and the windows that they were and are seen in.
void MovedSamples::chooseObjects(const SurfaceMap& map, const Scene& scene,
                                 const std::vector<Light>& lights, const SceneChange& change)
{
    SceneChange places; // for each move, the box before and the box after it
    for (const RigidMove& move : change.moves)
        places.boxes.insert(places.boxes.end(), {move.before, move.after});
    const ChangedSight sight = changedSight(map, scene, {}, places);
    const auto windowOf = [&](const SeenBox& box)
    {
        if (box.left >= box.right || box.bottom >= box.top) return PixelWindow(); // off the screen
        return PixelWindow{std::max(box.left - kMargin, 0), std::max(box.bottom - kMargin, 0),
                           std::min(box.right + kMargin, map.view.width),
                           std::min(box.top + kMargin, map.view.height)};
    };
    std::optional<std::vector<Vec3>> lamps; // of the scene, if an object is seen
    std::size_t area = 0;
    for (std::size_t i = 0; i < change.moves.size(); ++i)
    {
        const RigidMove& move = change.moves[i];
        Object object;
        object.object = move.instance + 1u;
        object.oldWindow = windowOf(sight.boxes[2 * i]);
        object.newWindow = windowOf(sight.boxes[2 * i + 1]);
        const bool seen = !object.oldWindow.isEmpty() && !object.newWindow.isEmpty();
        if (!seen || !followsVertices(scene, move)) continue;
        if (!lamps) lamps = _lamps.of(lights, scene);
        object.limits = limitsOf(move, *lamps);
        const std::size_t own = std::max(object.oldWindow.area(), object.newWindow.area());
        if (object.limits.count < 1.0f || area + own > map.object.size()) continue;
        area += own;
        object.beforeFromAfter = worldMoveBack(move, scene);
        _objects.push_back(std::move(object));
    }
}

void MovedSamples::take(const SurfaceMap& map, const Scene& scene, const std::vector<Light>& lights,
                        const SceneChange& change, const SampledImage& image,
                        const Workers& workers)
{
    _objects.clear();
    if (change.moves.empty()) return;
    chooseObjects(map, scene, lights, change);
    const auto takeObject = [&](std::size_t i)
    {
        Object& object = _objects[i];
        object.map = cutMap(map, object.oldWindow, workers);
        object.image = cutImage(image, object.oldWindow);
    };
    workers.forEach(_objects.size(), takeObject);
}

std::size_t MovedSamples::pixels() const
{
    std::size_t sum = 0;
    for (const Object& object : _objects)
    {
        std::size_t own = 0;
        for (std::size_t i = 0; i < object.image.count.size(); ++i)
            own += object.map.object[i] == object.object && object.image.count[i] > 0.0f &&
                   object.map.lobe[i] > 0.0f;
        sum += std::min(own, object.newWindow.area());
    }
    return sum;
}

std::size_t MovedSamples::carryObject(const Object& object, RenderSession& session,
                                      const Workers& workers, SampledImage& image)
{
    const PixelWindow& window = object.newWindow;
    SurfaceMap map = cutMap(session.firstSurfaces(), window, workers);
    moveMap(object.beforeFromAfter, map);
    SampledImage carried;
    reproject(object.image, object.map, map, object.limits, workers, carried);
    const auto width = static_cast<std::size_t>(window.width());
    std::size_t set = 0;
    for (std::size_t i = 0; i < carried.count.size(); ++i)
    {
        if (map.object[i] != object.object || !(carried.count[i] > 0.0f)) continue;
        const int x = window.left + static_cast<int>(i % width);
        const int y = window.bottom + static_cast<int>(i / width);
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
            static_cast<std::size_t>(x);
        const int tile = y / kTileSize * tilesAlong(image.width) + x / kTileSize;
        if (image.count[pixel] > 0.0f || session.tilePasses(tile) == 0) continue;
        std::copy_n(&carried.radiance[4 * i], 4, &image.radiance[4 * pixel]);
        image.count[pixel] = carried.count[i];
        ++set;
    }
    return set;
}

/// Finds what is in the middles of pixels at the objects' edges. The first samples of a pass are
/// anywhere in their pixels, and a pixel at an edge would change sides from frame to frame.
void MovedSamples::findEdges(RenderSession& session, const Workers& workers) const
{
    const SurfaceMap& map = session.firstSurfaces();
    std::vector<std::vector<std::pair<int, int>>> found(_objects.size());
    const auto findBlocks = [&](std::size_t i)
    {
        const PixelWindow& window = _objects[i].newWindow;
        const SurfaceMap part = cutMap(map, window, workers);
        for (int y = window.bottom; y < window.top; ++y)
            for (int x = window.left; x < window.right; ++x)
                if (isAtEdge(part, _objects[i].object, x - window.left, y - window.bottom))
                    found[i].emplace_back(x / kBlockSize * kBlockSize, y / kBlockSize * kBlockSize);
    };
    workers.forEach(_objects.size(), findBlocks);
    std::vector<std::pair<int, int>> blocks;
    for (const auto& places : found)
        blocks.insert(blocks.end(), places.begin(), places.end());
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    session.findMiddles(blocks);
}

std::size_t MovedSamples::carry(RenderSession& session, const Workers& workers, SampledImage& image)
{
    if (_objects.empty()) return 0;
    findEdges(session, workers);
    // Each object has pixels of its own: no two threads write to the same.
    std::atomic<std::size_t> set{0};
    workers.forEach(_objects.size(), [&](std::size_t i)
                    { set += carryObject(_objects[i], session, workers, image); });
    _objects.clear();
    return set;
}

} // namespace osgRayTrace::engine
