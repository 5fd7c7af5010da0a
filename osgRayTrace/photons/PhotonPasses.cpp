// PhotonPasses.cpp - photon maps by pass, traced once for all views. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonPasses.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/photons/OpeningFinder.h"
#include "osgRayTrace/sampling/Hash.h"
#include "osgRayTrace/sampling/Warp.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

namespace osgRayTrace::engine
{

namespace
{

// Share of the photons that are guided; the rest keeps all light within the mixture.
constexpr float kGuidedCaustics = 0.9f;
constexpr float kGuidedIndirect = 0.25f;

/// Most photons from which openings are learnt.
constexpr uint32_t kMostPilots = 1u << 17;

/// Nothing is learnt about openings if views see more than this share of the places at which
/// photons end: then no small opening is between the lights and what views see.
constexpr double kMostSeenShare = 0.2;

/// Returns whether lights are at the same places. Only lights in eye space move without a new
/// scene: with the view.
bool samePlaces(const std::vector<Light>& a, const std::vector<Light>& b)
{
    if (&a == &b) return true;
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].position != b[i].position || a[i].direction != b[i].direction) return false;
    return true;
}

/// Positions of photons, apart from all else that photons hold: a search through all of them then
/// reads a fifth of the memory.
struct Positions
{
    template <class T> explicit Positions(const std::vector<T>& photons) { add(photons); }
    explicit Positions(const PhotonBlocks& photons)
    {
        for (const PhotonSpan& span : photons.spans())
            add(span);
    }
    template <class List> void add(const List& photons)
    {
        for (const auto& photon : photons)
        {
            x.push_back(photon.position.x);
            y.push_back(photon.position.y);
            z.push_back(photon.position.z);
        }
    }
    std::vector<float> x, y, z;
};

/// Returns the square of the distance from a photon to the last of its nearest neighbours.
float distance2ToNeighbour(const Positions& p, std::size_t chosen, std::size_t neighbours)
{
    constexpr std::size_t kBlock = 64;
    float distances[kBlock];
    const float x = p.x[chosen], y = p.y[chosen], z = p.z[chosen];
    // A heap, the farthest first; one more, as the photon finds itself.
    std::vector<float> nearest(neighbours + 1, kInfinity);
    for (std::size_t begin = 0; begin < p.x.size(); begin += kBlock)
    {
        const std::size_t count = std::min(kBlock, p.x.size() - begin);
        float least = kInfinity;
        for (std::size_t i = 0; i < count; ++i)
        {
            const float dx = p.x[begin + i] - x, dy = p.y[begin + i] - y, dz = p.z[begin + i] - z;
            distances[i] = dx * dx + dy * dy + dz * dz;
            least = distances[i] < least ? distances[i] : least;
        }
        if (!(least < nearest.front())) continue;
        for (std::size_t i = 0; i < count; ++i)
        {
            if (!(distances[i] < nearest.front())) continue;
            std::pop_heap(nearest.begin(), nearest.end());
            nearest.back() = distances[i];
            std::push_heap(nearest.begin(), nearest.end());
        }
    }
    return nearest.front();
}

template <class List> float densityRadius(const List& photons, const Workers& workers)
{
    if (photons.size() < 2) return 0.0f;
    constexpr std::size_t kSamples = 128;
    const std::size_t neighbours = std::min<std::size_t>(kDensityPhotons, photons.size() - 1);
    const Positions positions(photons);
    std::vector<float> radii(kSamples);
    workers.forEach(kSamples,
                    [&](std::size_t s)
                    {
                        const std::size_t chosen = hash(static_cast<uint32_t>(s)) % photons.size();
                        radii[s] = std::sqrt(distance2ToNeighbour(positions, chosen, neighbours));
                    });
    std::nth_element(radii.begin(), radii.begin() + kSamples / 2, radii.end());
    return radii[kSamples / 2];
}

/// Returns the radius around lines that cross beams in random directions which holds
/// kDensityPhotons other beams, in the median.
float densityRadius(const std::vector<PhotonBeam>& beams, float most, const Workers& workers)
{
    constexpr std::size_t kLines = 96;
    if (beams.empty()) return most;
    std::vector<float> radii(kLines);
    workers.forEach(kLines,
                    [&](std::size_t s)
                    {
                        const uint32_t key = hash(static_cast<uint32_t>(s), 0x6265616du);
                        const PhotonBeam& beam = beams[key % beams.size()];
                        const float along =
                            beam.begin + unitFloat(hash(key + 1)) * (beam.length - beam.begin);
                        const Vec3 direction = squareToCone(
                            Vec2(unitFloat(hash(key + 2)), unitFloat(hash(key + 3))), 2.0f);
                        radii[s] = distanceToBeams(beams, beam.origin + beam.direction * along,
                                                   direction, kDensityPhotons + 1);
                    });
    std::nth_element(radii.begin(), radii.begin() + kLines / 2, radii.end());
    return std::min(radii[kLines / 2], most);
}

/// The largest length of the pieces into which beams are cut, over the radius of the scene.
constexpr float kBeamPiece = 0.15f;

} // namespace

bool samePhotons(const PhotonScene& a, const PhotonScene& b)
{
    return a.traced == b.traced && a.options == b.options && samePlaces(*a.lights, *b.lights);
}

void PhotonPasses::begin(const PhotonScene& scene)
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    if (_emitter && samePhotons(scene, _scene)) return;
    _emitter.reset();
    _first.reset();
    _density.reset();
    _kept.clear();
    _emitted = {};
    _seen.clear();
    _photonGuide.reset();
    _points.clear();
    _fewFlights.clear();
    _flights.clear();
    _openings.reset();
    _lookedForOpenings = false;
    // The scene's own lights stay where they are while the scene is held; there may be millions.
    const bool sceneOwns = scene.lights == &scene.traced->scene().lights;
    _placed = sceneOwns ? std::vector<Light>() : *scene.lights;
    _scene = scene;
    if (!sceneOwns) _scene.lights = &_placed;
    _emitter = std::make_unique<PhotonEmitter>(
        *_scene.traced, *_scene.lights,
        _scene.options.use == PhotonUse::Caustics ? kGuidedCaustics : kGuidedIndirect,
        _scene.options.use);
}

PhotonDensity PhotonPasses::density(const PhotonScene& scene, const Workers& workers)
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    begin(scene);
    if (_density) return *_density;
    _first = std::make_unique<TracedPhotons>(trace(0, nullptr, nullptr, workers));
    _density = std::make_unique<PhotonDensity>();
    _density->radius = densityRadius(_first->photons, workers);
    const Sphere& sphere = _emitter->scene();
    const float widest = kWidestKernel * sphere.radius;
    const float apart = densityRadius(_first->points, workers);
    _density->pointRadius = apart > 0.0f ? std::min(apart, widest) : widest;
    _density->beamRadius = densityRadius(_first->beams, widest, workers);
    _density->sceneRadius = sphere.radius;
    _density->emits = _emitter->emits();
    _density->caustics = _emitter->emits() && _emitter->hasTargets();
    _density->guideBins = _emitter->guideBins();
    _density->largestCoordinate = std::max({std::fabs(sphere.centre.x), std::fabs(sphere.centre.y),
                                            std::fabs(sphere.centre.z)}) +
                                  sphere.radius;
    return *_density;
}

std::shared_ptr<const PhotonPass> PhotonPasses::pass(const PhotonScene& scene, int index,
                                                     float cellSize, const Workers& workers)
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    begin(scene);
    const std::shared_ptr<const PhotonGuide> photonGuide = guideOf(index);
    const std::shared_ptr<const PhotonOpenings> openings = openingsOf(index, workers);
    for (const Entry& entry : _kept)
        if (entry.index == index && entry.cellSize == cellSize &&
            entry.photonGuide == photonGuide && entry.openings == openings)
            return entry.pass;

    const auto start = std::chrono::steady_clock::now();
    TracedPhotons photons;
    if (index == 0 && _first)
        photons = std::move(*_first);
    else
        photons = trace(index, photonGuide.get(), openings.get(), workers);
    _first.reset();
    const auto giveBack = [memory = _mapMemory](PhotonPass* gone)
    {
        memory->giveBack(std::move(gone->map));
        delete gone;
    };
    const std::shared_ptr<PhotonPass> pass(new PhotonPass, giveBack);
    pass->map = PhotonMap(photons.photons.spans(), cellSize, workers,
                          scene.options.photonGuiding && index < kFirst, _mapMemory->take());
    pass->volume.beams = BeamMap(photons.beams, kBeamPiece * _emitter->scene().radius);
    pass->volume.points = PointMap(photons.points);
    pass->cutWalks = photons.cutWalks;
    pass->openWalks = photons.openWalks;
    pass->hasOpenings = openings != nullptr;
    pass->rays = photons.rays;
    pass->dropped = photons.dropped;
    pass->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    keep({index, cellSize, photonGuide, openings, pass});
    return pass;
}

TracedPhotons PhotonPasses::trace(int index, const PhotonGuide* photonGuide,
                                  const PhotonOpenings* openings, const Workers& workers)
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    TracedPhotons photons = tracePhotons(*_scene.traced, *_scene.lights, *_emitter, _scene.options,
                                         index, workers, _memory, photonGuide, openings);
    _tracedRays += photons.rays;
    if (index < kFirst) _emitted[static_cast<std::size_t>(index)] = photons.emitted;
    return photons;
}

/// Returns the guide of a pass; null: the pass is guided by the scene alone.
std::shared_ptr<const PhotonGuide> PhotonPasses::guideOf(int index)
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    if (index < kFirst || !_scene.options.photonGuiding || _seen.empty()) return nullptr;
    if (_photonGuide) return _photonGuide;
    std::vector<uint32_t> emitted(_emitter->guideBins());
    for (const std::vector<uint32_t>& pass : _emitted)
        for (std::size_t b = 0; b < pass.size(); ++b)
            emitted[b] += pass[b];
    std::vector<double> squares(emitted.size());
    for (const Seen& seen : _seen)
        for (std::size_t b = 0; b < squares.size(); ++b)
            squares[b] += seen.squares[b];
    return _photonGuide = _emitter->learn(emitted, squares);
}

/// Returns the openings that photons of a pass are sent through; null: none.
std::shared_ptr<const PhotonOpenings> PhotonPasses::openingsOf(int index, const Workers& workers)
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    if (index < kFirst || _points.empty() || _scene.traced->traits().media) return nullptr;
    if (_lookedForOpenings) return _openings;
    std::vector<SeenPoint> seen;
    for (const SeenPoints& points : _points)
        seen.insert(seen.end(), points.points.begin(), points.points.end());
    const Sphere& sphere = _emitter->scene();
    // No pass has the random numbers of these photons, so all passes stay independent of them.
    PhotonPassOptions options = _scene.options;
    const auto traceFlights = [&](uint32_t photons, int number, const PhotonOpenings* openings)
    {
        options.photons = photons;
        return tracePhotons(*_scene.traced, *_scene.lights, *_emitter, options, -number, workers,
                            _memory, nullptr, openings, true)
            .flights;
    };
    const uint32_t many = std::min(2 * _scene.options.photons, kMostPilots);
    if (_fewFlights.empty()) _fewFlights = traceFlights(std::max(many / 64, 1u), 1, nullptr);
    std::shared_ptr<const PhotonOpenings> openings;
    if (seenShare(sphere, _fewFlights, seen) <= kMostSeenShare)
    {
        if (_flights.empty()) _flights = traceFlights(many, 2, nullptr);
        openings = findOpenings(sphere, _flights, seen, many);
        if (openings)
            openings =
                refineOpenings(sphere, traceFlights(many, 3, openings.get()), seen, many, openings);
        else
            std::vector<PhotonFlight>().swap(_flights); // they are some megabytes
    }
    // An exception above leaves all as it was, so that the next pass looks again.
    _openings = std::move(openings);
    _lookedForOpenings = true;
    return _openings;
}

ViewId PhotonPasses::newView()
{
    return static_cast<ViewId>(++_views);
}

void PhotonPasses::recordSeen(const PhotonScene& scene, ViewId view, std::vector<double> squares)
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    if (!_emitter || !samePhotons(scene, _scene) || squares.size() != _emitter->guideBins()) return;
    _seen.push_back({view, std::move(squares)});
    _photonGuide.reset();
}

void PhotonPasses::recordPoints(const PhotonScene& scene, ViewId view,
                                std::vector<SeenPoint> points)
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    if (!_emitter || !samePhotons(scene, _scene) || points.empty()) return;
    _points.push_back({view, std::move(points)});
    _openings.reset();
    _lookedForOpenings = false;
}

void PhotonPasses::forgetSeen(ViewId view)
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    const auto left = std::remove_if(_points.begin(), _points.end(),
                                     [&](const SeenPoints& s) { return s.view == view; });
    if (left != _points.end())
    {
        _points.erase(left, _points.end());
        _openings.reset();
        _lookedForOpenings = false;
    }
    const auto gone =
        std::remove_if(_seen.begin(), _seen.end(), [&](const Seen& s) { return s.view == view; });
    if (gone == _seen.end()) return;
    _seen.erase(gone, _seen.end());
    _photonGuide.reset();
}

/// Keeps a pass. Makes room for it: at first among the last passes, then, if memory is short, among
/// all of them.
void PhotonPasses::keep(Entry entry)
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    const auto replaced = std::find_if(
        _kept.begin(), _kept.end(),
        [&](const Entry& e) { return e.index == entry.index && e.cellSize == entry.cellSize; });
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
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    std::size_t sum = 0;
    for (const Entry& entry : _kept)
        sum += entry.pass->map.bytes() + entry.pass->volume.bytes();
    return sum;
}

std::size_t PhotonPasses::bytes() const
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    const std::size_t flights = _fewFlights.capacity() + _flights.capacity();
    return keptBytes() + _memory.bytes() + _mapMemory->bytes() + flights * sizeof(PhotonFlight);
}

bool PhotonPasses::keeps(int index) const
{
    const std::unique_lock<CheckedMutex> lock(_mutex, std::try_to_lock);
    return lock && std::any_of(_kept.begin(), _kept.end(),
                               [&](const Entry& e) { return e.index == index; });
}

uint64_t PhotonPasses::tracedRays() const
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    return _tracedRays;
}

} // namespace osgRayTrace::engine
