// ViewHistory.cpp - samples of earlier views that still count in an image. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/ViewHistory.h"

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/film/Resolve.h"
#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/history/FreshSamples.h"
#include "osgRayTrace/session/history/KeptSamples.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin)
{
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

bool followsEye(const TextureMapping& mapping)
{
    return mapping.coordinates == TextureCoordinates::SphereMap ||
           mapping.coordinates == TextureCoordinates::ReflectionMap ||
           mapping.coordinates == TextureCoordinates::NormalMap;
}

/// Returns the angle between the axes that two views look along [radians].
float turnOf(const View& a, const View& b)
{
    const auto axis = [](const View& view)
    { return glm::normalize(Vec3d(glm::transpose(view.viewFromWorld)[2])); };
    const double cosine = glm::dot(axis(a), axis(b));
    return static_cast<float>(std::acos(std::min(1.0, std::max(-1.0, cosine))));
}

/// Returns the number of samples that the history still counts as.
OSGRAYTRACE_INLINE float fadedCount(float count, float passes)
{
    const float faded = count - 0.5f * (passes > 1.0f ? passes - 1.0f : 0.0f);
    return faded > 0.0f ? faded : 0.0f;
}

/// Sets radiance = (h history + n radiance) / (h + n).
OSGRAYTRACE_KERNEL
void blendPixels(const float* __restrict history, const float* __restrict count, float passes,
                 std::size_t pixels, float* __restrict radiance)
{
    for (std::size_t i = 0; i < pixels; ++i)
    {
        const float h = fadedCount(count[i], passes), sum = h + passes;
        const float share = sum > 0.0f ? h / sum : 0.0f;
        for (std::size_t c = 4 * i; c < 4 * i + 4; ++c)
            radiance[c] += share * (history[c] - radiance[c]);
    }
}

OSGRAYTRACE_KERNEL
void addFaded(const float* __restrict history, float passes, std::size_t pixels,
              float* __restrict count)
{
    OSGRAYTRACE_SIMD
    for (std::size_t i = 0; i < pixels; ++i)
        count[i] += fadedCount(history[i], passes);
}

/// Scales the errors to those of the mean of all samples, which vary like the film's samples: e
/// sqrt(n / (h + n)).
void scaleErrors(const float* count, float passes, std::size_t pixels, float* error)
{
    for (std::size_t i = 0; i < pixels; ++i)
    {
        const float scale = std::sqrt(passes / (passes + fadedCount(count[i], passes)));
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
            error[c] *= scale;
    }
}

/// Estimates errors from two independent means a of h and b of n samples. The means differ by (a -
/// b)^2 = v (1/h + 1/n), v being the variance of one sample. The variance of the mean of all
/// samples is v / (h + n), and its root is |a - b| sqrt(h n) / (h + n). For h = n this is the
/// estimate of [Rousselle12, sect. 3].
void estimateErrors(const float* history, const float* count, float passes, const float* radiance,
                    std::size_t pixels, float* error)
{
    for (std::size_t i = 0; i < pixels; ++i)
    {
        const float h = fadedCount(count[i], passes);
        const float scale = std::sqrt(h * passes) / (h + passes);
        for (std::size_t c = 0; c < 3; ++c)
        {
            const float film = radiance[4 * i + c], old = history[4 * i + c];
            const float known = passes > 0.0f ? scale * std::fabs(old - film) : old / std::sqrt(h);
            error[3 * i + c] = h > 0.0f ? known : film;
        }
    }
}

} // namespace

ViewDependence viewDependence(const Scene& scene)
{
    ViewDependence result;
    result.everywhere = hasGround(scene.ground); // its shadows belong to no surface
    for (const Light& light : scene.lights)
        result.everywhere = result.everywhere || light.eyeSpace;
    for (const Material& material : scene.materials)
    {
        if (followsEye(material.mapping) || followsEye(material.second.mapping))
            result.everywhere = true;
        const bool shines = material.specular != Vec3(0.0f) ||
                            (material.hasBack && material.back.specular != Vec3(0.0f));
        if (material.model == MaterialModel::FixedFunction && shines && !material.localViewer)
            result.axes = true;
    }
    return result;
}

namespace
{

/// Returns the passes of all tiles of the session's image together.
int64_t allPasses(const RenderSession& session)
{
    int64_t sum = 0;
    const int tiles = tilesAlong(session.width()) * tilesAlong(session.height());
    for (int tile = 0; tile < tiles; ++tile)
        sum += session.tilePasses(tile);
    return sum;
}

/// Calls body(first pixel, pixels, passes) for the parts of rows of the image whose tiles have the
/// same number of passes.
template <class Body>
void forEachPart(const RenderSession& session, std::size_t firstRow, std::size_t endRow,
                 const Body& body)
{
    const auto width = static_cast<std::size_t>(session.width());
    const int across = tilesAlong(session.width());
    for (std::size_t y = firstRow; y < endRow; ++y)
    {
        const int row = static_cast<int>(y) / kTileSize * across;
        for (int begin = 0, end = 1; begin < across; begin = end++)
        {
            const int passes = session.tilePasses(row + begin);
            while (end < across && session.tilePasses(row + end) == passes)
                ++end;
            const std::size_t left = static_cast<std::size_t>(begin) * kTileSize;
            const std::size_t right = std::min(width, static_cast<std::size_t>(end) * kTileSize);
            body(y * width + left, right - left, static_cast<float>(passes));
        }
    }
}

} // namespace

/// Blends film and history to _blended, and to the display if there is one.
void ViewHistory::blendRows(const RenderSession& session, const ToneMap* toneMap, uint8_t* rgba,
                            float* depth)
{
    const auto width = static_cast<std::size_t>(session.width());
    const bool blends = counts(session.progress().passes);
    _blended.resize(4 * width * static_cast<std::size_t>(session.height()));
    session.resolveRows(_blended.data(), depth,
                        [&](std::size_t first, std::size_t end)
                        {
                            const std::size_t pixel = first * width, pixels = (end - first) * width;
                            const auto blendPart = [&](std::size_t i, std::size_t n, float passes) {
                                blendPixels(&_history.radiance[4 * i], &_history.count[i], passes,
                                            n, &_blended[4 * i]);
                            };
                            if (blends) forEachPart(session, first, end, blendPart);
                            if (toneMap)
                                displayPixels(&_blended[4 * pixel], pixels, *toneMap,
                                              rgba + 4 * pixel);
                        });
    _blendedPasses = allPasses(session);
}

/// Takes the samples of the session's image and of the history to _left.
void ViewHistory::takeSamples(const RenderSession& session, const Workers& workers)
{
    if (_blendedPasses == 0 || _blendedPasses != allPasses(session))
        blendRows(session, nullptr, nullptr, nullptr);
    _blendedPasses = 0;
    _left.width = session.width();
    _left.height = session.height();
    _left.radiance.swap(_blended);
    _left.count.resize(_left.radiance.size() / 4);
    const bool blends = counts(session.progress().passes);
    const auto takePart = [&](std::size_t pixel, std::size_t pixels, float passes)
    {
        std::fill_n(&_left.count[pixel], pixels, passes);
        if (blends) addFaded(&_history.count[pixel], passes, pixels, &_left.count[pixel]);
    };
    forEachRows(workers, session.height(),
                [&](std::size_t first, std::size_t end)
                { forEachPart(session, first, end, takePart); });
}

void ViewHistory::leave(RenderSession& session, const View& view, const Workers& workers)
{
    const Clock::time_point begin = Clock::now();
    if (_taken && session.progress().passes == 0)
        return; // the samples of the view before are still on their way
    _taken = false;
    if (!session.surfaces().isOf(view)) return drop();
    takeSamples(session, workers);
    _leftView = view;
    _taken = true;
    _seconds = secondsSince(begin);
}

bool ViewHistory::keep(RenderSession& session, const SceneChange& change, float most,
                       const Workers& workers)
{
    constexpr double kLeastShare = 0.25; // of pixels: fewer are not worth it
    const Clock::time_point begin = Clock::now();
    takeSamples(session, workers);
    const auto width = static_cast<std::size_t>(session.width());
    forEachRows(workers, session.height(),
                [&](std::size_t first, std::size_t end)
                {
                    for (std::size_t i = first * width; i < end * width; ++i)
                        _left.count[i] = std::min(_left.count[i], most);
                });
    const SurfaceMap& surfaces = session.firstSurfaces();
    const Scene& scene = session.imageScene().scene();
    _moved.take(surfaces, scene, session.imageLights(), change, _left, workers);
    limitKept(surfaces, scene, session.imageLights(), change, workers, _left.count);
    const std::size_t lost = findLacking(session, workers);
    const auto pixels = static_cast<double>(_left.count.size());
    const double share = 1.0 - static_cast<double>(lost) / pixels;
    if (share + static_cast<double>(_moved.pixels()) / pixels < kLeastShare)
    {
        drop();
        return false;
    }
    std::swap(_history, _left);
    _taken = false;
    _isKept = true;
    _most = most;
    _share = share;
    _lackingPixels = lost;
    _seconds = secondsSince(begin);
    return true;
}

void ViewHistory::followMoved(RenderSession& session, const Workers& workers)
{
    const Clock::time_point begin = Clock::now();
    const std::size_t followed = _moved.carry(session, workers, _history);
    _share += static_cast<double>(followed) / static_cast<double>(_history.count.size());
    _blendedPasses = 0;
    _seconds += secondsSince(begin);
}

void ViewHistory::refresh(RenderSession& session, const std::function<bool()>& shouldStop,
                          const Workers& workers)
{
    addFreshSamples(session, _most, shouldStop, workers, _history);
    _blendedPasses = 0;
}

/// Finds the tiles in which pixels of _left have no samples. Returns the number of these pixels.
std::size_t ViewHistory::findLacking(const RenderSession& session, const Workers& workers)
{
    const auto width = static_cast<std::size_t>(session.width());
    const auto across = static_cast<std::size_t>(tilesAlong(session.width()));
    const auto down = static_cast<std::size_t>(tilesAlong(session.height()));
    _lacking.assign(across * down, 0);
    std::atomic<std::size_t> lost{0};
    workers.forEach(down,
                    [&](std::size_t row)
                    {
                        const std::size_t first = row * kTileSize * width;
                        const std::size_t end =
                            std::min(_left.count.size(), first + kTileSize * width);
                        std::size_t lostHere = 0;
                        for (std::size_t i = first; i < end; ++i)
                        {
                            if (_left.count[i] != 0.0f) continue;
                            ++lostHere;
                            _lacking[row * across + i % width / kTileSize] = 1;
                        }
                        lost += lostHere;
                    });
    return lost;
}

bool ViewHistory::isWhole(const RenderSession& session) const
{
    if (!_isKept) return false;
    for (std::size_t tile = 0; tile < _lacking.size(); ++tile)
        if (_lacking[tile] && session.tilePasses(static_cast<int>(tile)) == 0) return false;
    return true;
}

void ViewHistory::enter(RenderSession& session, const View& view, const ViewDependence& dependence,
                        const Workers& workers)
{
    const Clock::time_point begin = Clock::now();
    if (!_taken) return drop();
    _taken = false;
    if (view == _leftView) return; // another view came and could not be traced
    _blendedPasses = 0;
    const SurfaceMap &from = session.lastSurfaces(), &to = session.surfaces();
    if (dependence.everywhere || !from.isOf(_leftView) || !to.isOf(view)) return drop();
    ReprojectionLimits limits;
    // One sample of a larger pixel tells less about each of the smaller pixels within it.
    const double sizes =
        static_cast<double>(_left.count.size()) / static_cast<double>(to.along.size());
    limits.count = kMostCount * static_cast<float>(std::min(1.0, sizes));
    limits.edgeCount = std::min(limits.edgeCount, limits.count);
    if (dependence.axes) limits.turn = turnOf(from.view, view);
    _isKept = false;
    _most = kMostCount;
    _share = reproject(_left, from, to, limits, workers, _history);
    _seconds += secondsSince(begin);
}

void ViewHistory::drop()
{
    *this = ViewHistory();
}

void ViewHistory::blend(const RenderSession& session, ResolvedImage& image,
                        const Workers& workers) const
{
    if (!counts(session.progress().passes)) return;
    if (image.width != _history.width || image.height != _history.height) return;
    const bool estimated = image.error.empty();
    if (estimated) image.error.resize(3 * _history.count.size());
    const auto blendPart = [&](std::size_t pixel, std::size_t pixels, float passes)
    {
        const float* history = &_history.radiance[4 * pixel];
        const float* count = &_history.count[pixel];
        float* radiance = &image.radiance[4 * pixel];
        float* error = &image.error[3 * pixel];
        if (estimated)
            estimateErrors(history, count, passes, radiance, pixels, error);
        else if (!_isKept)
            scaleErrors(count, passes, pixels, error);
        blendPixels(history, count, passes, pixels, radiance);
    };
    forEachRows(workers, image.height,
                [&](std::size_t first, std::size_t end)
                { forEachPart(session, first, end, blendPart); });
}

void ViewHistory::show(const RenderSession& session, const ToneMap& toneMap, uint8_t* rgba,
                       float* depth)
{
    blendRows(session, &toneMap, rgba, depth);
}

} // namespace osgRayTrace::engine
