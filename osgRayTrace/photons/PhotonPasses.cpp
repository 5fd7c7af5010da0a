// PhotonPasses.cpp - photon maps by pass, traced once for all views. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonPasses.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/sampling/Hash.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

// "Unguided emission stays in the mix": what is not aimed.
constexpr float kAimedCaustics = 0.9f;
constexpr float kAimedIndirect = 0.25f;

/// Lights in eye space move with the view; the others belong to the scene.
bool samePlaces(const std::vector<Light>& a, const std::vector<Light>& b)
{
    if (&a == &b) return true;
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].position != b[i].position || a[i].direction != b[i].direction) return false;
    return true;
}

float densityRadius(const std::vector<Photon>& photons, const Workers& workers)
{
    if (photons.size() < 2) return 0.0f;
    constexpr std::size_t kSamples = 128;
    const std::size_t neighbours = std::min<std::size_t>(kDensityPhotons, photons.size() - 1);
    std::vector<float> radii(kSamples);
    workers.forEach(
        kSamples,
        [&](std::size_t s)
        {
            const std::size_t chosen = hash(static_cast<uint32_t>(s)) % photons.size();
            const Vec3 centre = photons[chosen].position;
            std::vector<float> distances(photons.size());
            for (std::size_t k = 0; k < photons.size(); ++k)
            {
                const Vec3 d = photons[k].position - centre;
                distances[k] = glm::dot(d, d);
            }
            const auto nth = distances.begin() + static_cast<std::ptrdiff_t>(neighbours);
            std::nth_element(distances.begin(), nth, distances.end());
            radii[s] = std::sqrt(*nth);
        });
    std::nth_element(radii.begin(), radii.begin() + kSamples / 2, radii.end());
    return radii[kSamples / 2];
}

} // namespace

bool PhotonPasses::isCurrent(const std::shared_ptr<const TracedScene>& traced,
                             const std::vector<Light>& lights, const PhotonPassOptions& options) const
{
    return traced == _traced && options.use == _options.use && options.photons == _options.photons &&
           options.maxBounces == _options.maxBounces && options.seed == _options.seed &&
           samePlaces(lights, *_lights);
}

void PhotonPasses::begin(const std::shared_ptr<const TracedScene>& traced, const std::vector<Light>& lights,
                         const PhotonPassOptions& options)
{
    if (_emitter && isCurrent(traced, lights, options)) return;
    _emitter.reset();
    _first.reset();
    _density.reset();
    _kept.clear();
    _traced = traced;
    // Those of the scene stay where they are while it is held; there may be millions.
    const bool sceneOwns = &lights == &traced->scene().lights;
    _placed = sceneOwns ? std::vector<Light>() : lights;
    _lights = sceneOwns ? &traced->scene().lights : &_placed;
    _options = options;
    _emitter = std::make_unique<PhotonEmitter>(
        *traced, *_lights, options.use == PhotonUse::Caustics ? kAimedCaustics : kAimedIndirect);
}

PhotonDensity PhotonPasses::density(const std::shared_ptr<const TracedScene>& traced,
                                    const std::vector<Light>& lights, const PhotonPassOptions& options,
                                    const Workers& workers)
{
    std::lock_guard<std::mutex> lock(_mutex);
    begin(traced, lights, options);
    if (_density) return *_density;
    _first = std::make_unique<TracedPhotons>(tracePhotons(*traced, *_lights, *_emitter, options, 0, workers));
    _tracedRays += _first->rays;
    _density = std::make_unique<PhotonDensity>();
    _density->radius = densityRadius(_first->photons, workers);
    const PhotonEmitter::Sphere& scene = _emitter->scene();
    _density->sceneRadius = scene.radius;
    _density->emits = _emitter->emits();
    _density->caustics = _emitter->emits() && _emitter->hasTargets();
    _density->largestCoordinate =
        std::max({std::fabs(scene.centre.x), std::fabs(scene.centre.y), std::fabs(scene.centre.z)}) +
        scene.radius;
    return *_density;
}

std::shared_ptr<const PhotonPass> PhotonPasses::pass(const std::shared_ptr<const TracedScene>& traced,
                                                     const std::vector<Light>& lights,
                                                     const PhotonPassOptions& options, int index,
                                                     float cellSize, const Workers& workers)
{
    std::lock_guard<std::mutex> lock(_mutex);
    begin(traced, lights, options);
    for (const Entry& entry : _kept)
        if (entry.index == index && cellSize <= 2.0f * entry.cellSize && entry.cellSize <= 2.0f * cellSize)
            return entry.pass;

    const auto start = std::chrono::steady_clock::now();
    TracedPhotons photons;
    if (index == 0 && _first)
        photons = std::move(*_first);
    else
    {
        photons = tracePhotons(*traced, *_lights, *_emitter, options, index, workers);
        _tracedRays += photons.rays;
    }
    _first.reset();
    auto pass = std::make_shared<PhotonPass>();
    pass->map = PhotonMap(photons.photons, cellSize, workers);
    pass->rays = photons.rays;
    pass->dropped = photons.dropped;
    pass->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    keep({index, cellSize, pass});
    return pass;
}

/// Makes room: at first among the last passes, then for the sake of memory among all of them.
void PhotonPasses::keep(Entry entry)
{
    const auto replaced = std::find_if(_kept.begin(), _kept.end(),
                                       [&](const Entry& e) { return e.index == entry.index; });
    if (replaced != _kept.end()) _kept.erase(replaced);
    const auto isLast = [](const Entry& e) { return e.index >= kFirst; };
    if (std::count_if(_kept.begin(), _kept.end(), isLast) >= kLast)
        _kept.erase(std::find_if(_kept.begin(), _kept.end(), isLast));
    _kept.push_back(std::move(entry));
    while (_kept.size() > 1 && keptBytes() > kMostBytes)
        _kept.erase(_kept.begin());
}

std::size_t PhotonPasses::keptBytes() const
{
    std::size_t sum = 0;
    for (const Entry& entry : _kept)
        sum += entry.pass->map.bytes();
    return sum;
}

std::size_t PhotonPasses::bytes() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return keptBytes();
}

uint64_t PhotonPasses::tracedRays() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return _tracedRays;
}

} // namespace osgRayTrace::engine
