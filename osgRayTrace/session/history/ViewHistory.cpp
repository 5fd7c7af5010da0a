// ViewHistory.cpp - samples of earlier views that still count in an image. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/ViewHistory.h"

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Resolve.h"
#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/session/RenderSession.h"

#include <algorithm>
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
    const float faded = count - 0.5f * (passes - 1.0f);
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
            const float film = radiance[4 * i + c];
            error[3 * i + c] = h > 0.0f ? scale * std::fabs(history[4 * i + c] - film) : film;
        }
    }
}

} // namespace

ViewDependence viewDependence(const Scene& scene)
{
    ViewDependence result;
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

/// Blends film and history to _blended, and to the display if there is one.
void ViewHistory::blendRows(const RenderSession& session, const ToneMap* toneMap, uint8_t* rgba,
                            float* depth)
{
    const auto width = static_cast<std::size_t>(session.width());
    const int passes = session.progress().passes;
    const bool blends = counts(passes);
    _blended.resize(4 * width * static_cast<std::size_t>(session.height()));
    session.resolveRows(_blended.data(), depth,
                        [&](std::size_t first, std::size_t end)
                        {
                            const std::size_t pixel = first * width, pixels = (end - first) * width;
                            float* radiance = &_blended[4 * pixel];
                            if (blends)
                                blendPixels(&_history.radiance[4 * pixel], &_history.count[pixel],
                                            static_cast<float>(passes), pixels, radiance);
                            if (toneMap)
                                displayPixels(radiance, pixels, toneMap->exposureEv,
                                              rgba + 4 * pixel);
                        });
    _blendedPasses = passes;
}

void ViewHistory::leave(RenderSession& session, const View& view, const Workers& workers)
{
    const Clock::time_point begin = Clock::now();
    const int passes = session.progress().passes;
    if (_taken && passes == 0) return; // the samples of the view before are still on their way
    _taken = false;
    if (!session.surfaces().isOf(view)) return drop();
    const auto width = static_cast<std::size_t>(view.width);
    const float n = static_cast<float>(passes);
    if (_blendedPasses != passes) blendRows(session, nullptr, nullptr, nullptr);
    _blendedPasses = 0;
    _left.width = view.width;
    _left.height = view.height;
    _left.radiance.swap(_blended);
    _left.count.resize(width * static_cast<std::size_t>(view.height));
    const bool blends = counts(passes);
    forEachRows(workers, view.height,
                [&](std::size_t first, std::size_t end)
                {
                    const std::size_t pixel = first * width, pixels = (end - first) * width;
                    std::fill_n(&_left.count[pixel], pixels, n);
                    if (blends) addFaded(&_history.count[pixel], n, pixels, &_left.count[pixel]);
                });
    _leftView = view;
    _taken = true;
    _seconds = secondsSince(begin);
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
    _share = reproject(_left, from, to, limits, workers, _history);
    _seconds += secondsSince(begin);
}

void ViewHistory::drop()
{
    *this = ViewHistory();
}

void ViewHistory::blend(ResolvedImage& image, int passes, const Workers& workers) const
{
    if (!counts(passes) || image.width != _history.width || image.height != _history.height) return;
    const auto width = static_cast<std::size_t>(image.width);
    const float n = static_cast<float>(passes);
    const bool estimated = image.error.empty();
    if (estimated) image.error.resize(3 * width * static_cast<std::size_t>(image.height));
    forEachRows(workers, image.height,
                [&](std::size_t first, std::size_t end)
                {
                    const std::size_t pixel = first * width, pixels = (end - first) * width;
                    const float* history = &_history.radiance[4 * pixel];
                    const float* count = &_history.count[pixel];
                    float* radiance = &image.radiance[4 * pixel];
                    float* error = &image.error[3 * pixel];
                    if (estimated)
                        estimateErrors(history, count, n, radiance, pixels, error);
                    else
                        scaleErrors(count, n, pixels, error);
                    blendPixels(history, count, n, pixels, radiance);
                });
}

void ViewHistory::show(const RenderSession& session, const ToneMap& toneMap, uint8_t* rgba,
                       float* depth)
{
    blendRows(session, &toneMap, rgba, depth);
}

} // namespace osgRayTrace::engine
