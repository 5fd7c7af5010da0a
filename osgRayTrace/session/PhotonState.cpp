// PhotonState.cpp - photon mapping's state that a view keeps from pass to pass. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/PhotonState.h"
#include "osgRayTrace/integrators/IntegratorFactory.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/base/Cpu.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the width of a pixel on the surfaces that the view shows, in the median over a grid of
/// its pixels [length]; 0 if the view shows no surface.
float pixelWidth(const PassContext& context, int width, int height)
{
    constexpr int kSide = 9;
    std::vector<float> widths;
    const CameraRays& c = context.camera;
    for (int k = 0; k < kSide * kSide; ++k)
    {
        const float x = (static_cast<float>(k % kSide) + 0.5f) / kSide * static_cast<float>(width);
        const float y = (static_cast<float>(k / kSide) + 0.5f) / kSide * static_cast<float>(height);
        const Vec3 direction = c.direction + x * c.directionDx + y * c.directionDy;
        const Vec3 origin = c.origin + x * c.originDx + y * c.originDy;
        const float length = glm::length(direction);
        const auto hit = context.traced->intersector().closestHit(origin, direction / length,
                                                                  c.nearS * length, kInfinity);
        if (!hit) continue;
        const float across = std::max(glm::length(c.directionDx), glm::length(c.directionDy));
        const float shift = std::max(glm::length(c.originDx), glm::length(c.originDy));
        widths.push_back(c.orthographic ? shift : across * hit->t / length);
    }
    if (widths.empty()) return 0.0f;
    std::nth_element(widths.begin(),
                     widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2), widths.end());
    return widths[widths.size() / 2];
}

/// Asks for what the pixels of a tile know, which a pass reads pixel by pixel.
void fetchAhead(const TileLookups& lookups)
{
    constexpr std::size_t kLine = 64; // of the cache [bytes]
    for (std::size_t byte = 0; byte < sizeof lookups.planes; byte += kLine)
        prefetch(reinterpret_cast<const char*>(lookups.planes) + byte);
}

/// Approximate number of pixels of a pass from which the guide learns.
constexpr std::size_t kRecordedPixels = 16384;
constexpr std::size_t kMostRecordedStride = 16; ///< at least one of so many pixels is recorded

/// Returns the sums by bin of the squares of the contributions of single photons, relative to the
/// radiance of the tile as in ErrorEstimate::relative: dim places matter, too. A bin may have
/// thousands of photons.
std::vector<SeenSquares> squaresOf(const std::vector<SeenPhoton>& seen, const RgbaLanes* rgba)
{
    float sum = 0.0f;
    for (int b = 0; b < kTileBlocks; ++b)
        for (int i = 0; i < kLanes; ++i)
            sum += luminance(Vec3(rgba[b].r[i], rgba[b].g[i], rgba[b].b[i]));
    const float mean = sum / kTilePixels;

    std::vector<SeenPhoton> byBin = seen;
    std::stable_sort(byBin.begin(), byBin.end(),
                     [](const SeenPhoton& a, const SeenPhoton& b) { return a.bin < b.bin; });
    std::vector<SeenSquares> result;
    for (const SeenPhoton& photon : byBin)
    {
        if (result.empty() || result.back().bin != photon.bin) result.push_back({photon.bin, 0.0});
        result.back().squares +=
            static_cast<double>(photon.radiance * (photon.radiance / (mean * mean + 0.01f)));
    }
    return result;
}

/// Photons of glossy surfaces end if the mean over tiles of the squared share of the light that
/// they carry is below this. A path meets such light with a probability of a thousandth or more, so
/// it has a relative variance of 0.01 at most then, where those of whole pictures are 0.05 and
/// more.
constexpr double kLeastCarried = 1e-5;

/// Returns the square of the share of a tile's light that photons carry, relative as in
/// ErrorEstimate::relative.
double carriedSquare(const GatheredPhotons& gathered, const RgbaLanes* rgba)
{
    double sum = 0.0;
    for (int b = 0; b < kTileBlocks; ++b)
        for (int i = 0; i < kLanes; ++i)
            sum += static_cast<double>(luminance(Vec3(rgba[b].r[i], rgba[b].g[i], rgba[b].b[i])));
    const double mean = sum / kTilePixels,
                 carried = static_cast<double>(gathered.carried) / kTilePixels;
    return carried * carried / (mean * mean + 0.01);
}

PhotonPassOptions passOptions(const RenderOptions& options)
{
    PhotonPassOptions result;
    result.use = photonUse(options.integrator);
    result.photons = static_cast<uint32_t>(std::max(0, options.photons));
    result.maxBounces = options.maxBounces;
    result.seed = options.seed;
    result.photonGuiding = options.photonGuiding;
    result.beams = static_cast<uint32_t>(std::max(1, options.photonBeams));
    return result;
}

/// traced is the scene of the context.
PhotonScene photonScene(const std::shared_ptr<const TracedScene>& traced,
                        const PassContext& context)
{
    return {traced, context.lights, passOptions(context.options)};
}

} // namespace

void PhotonState::reset(int tileCount)
{
    _pass.reset();
    _least = _largest = 0.0f;
    _shrink = 1.0f;
    _dark = _limited = _stored = _guides = _ended = false;
    _preparedPass = -1;
    _pixels = static_cast<std::size_t>(tileCount) * kTilePixels;
    std::vector<float>().swap(_firstRadii);
    std::vector<LocalStatistics>().swap(_statistics);
    std::vector<HitPoints>().swap(_hitPoints);
    _lookups.reset(0);
    std::vector<DiscDifferences>().swap(_differences);
    std::vector<std::vector<SeenSquares>>().swap(_seen);
    std::vector<double>().swap(_seenSquares);
    std::vector<double>().swap(_carried);
    std::vector<std::vector<SeenPoint>>().swap(_points);
    _opened = false;
    _before.reset(0);
    _passes->forgetSeen(_view);
}

void PhotonState::chooseRadii(const PhotonScene& scene, const PassContext& context,
                              const Workers& workers)
{
    const PhotonPassOptions& options = scene.options;
    const PhotonDensity density = _passes->density(scene, workers);
    _idle = options.use == PhotonUse::Caustics && (!density.caustics || options.photons == 0);
    _floor = 8.0f * 0x1p-23f * density.largestCoordinate;
    const float ceiling = std::max(density.sceneRadius, _floor);
    const auto wanted =
        static_cast<float>(context.options.photonRadius / context.traced->scene().unit);
    if (wanted > 0.0f)
        _least = _largest = wanted;
    else
    {
        _least = pixelWidth(context, context.width, context.height);
        if (!(_least > 0.0f)) _least = density.radius;
        _largest = std::max(_least, density.radius);
    }
    for (float* radius : {&_least, &_largest})
        *radius = std::clamp(*radius, _floor, ceiling);
    // Other cells round sums differently, and the sums of all views should be the same: the first
    // cells are those of the photons' density. Cells a few times too small cost little.
    _cellRadius =
        wanted > 0.0f || !(density.radius > 0.0f) ? _largest : std::max(density.radius, _floor);
    while (2.0f * _cellRadius < _largest)
        _cellRadius *= 4.0f;
    if (_optional) _carried.assign(_pixels / kTilePixels, 0.0);
    if (options.photonGuiding && options.photons > 0 && density.guideBins > 0)
    {
        _seen.resize(_pixels / kTilePixels);
        _seenSquares.assign(density.guideBins, 0.0);
    }
    if (options.photonGuiding && options.photons > 0 && options.use == PhotonUse::Indirect &&
        density.emits && !context.traced->traits().media)
        _points.resize(_pixels / kTilePixels);
    _dark = options.photons > 0 && !density.emits;
    _limited = wanted > 0.0f && _largest != wanted;
    const float width = pixelWidth(context, context.width, context.height);
    const auto first = [&](float radius)
    { return std::clamp(wanted > 0.0f ? wanted : std::max(radius, width), _floor, ceiling); };
    _beamRadius = first(density.beamRadius);
    _pointRadius = first(density.pointRadius);
    if (context.traced->traits().volumes)
        for (float* radius : {&_beamRadius, &_pointRadius})
            *radius = std::max(_floor, std::min(*radius, kWidestKernel * density.sceneRadius));
}

void PhotonState::choose(const std::shared_ptr<const TracedScene>& traced,
                         const PassContext& context, const Workers& workers)
{
    const PhotonScene scene = photonScene(traced, context);
    if (scene.options.use == PhotonUse::None || _largest > 0.0f) return;
    chooseRadii(scene, context, workers);
    _causticsAlone = scene.options.use == PhotonUse::Caustics;
    _local = context.options.radiusSchedule == RadiusSchedule::Local &&
             scene.options.use == PhotonUse::Indirect;
    if (_local)
        _statistics.assign(2 * _pixels, LocalStatistics());
    else
        _firstRadii.assign(_pixels, 0.0f);
    // Whoever sets a radius wants discs of that radius, and a pixel has a footprint if all its
    // passes come from one eye to one scene.
    const bool hasFootprints = !context.options.moving && !context.camera.hasLens();
    if (!_local && hasFootprints && !(context.options.photonRadius > 0.0f))
        _lookups.reset(_pixels / kTilePixels);
    static_assert(FirstPasses::kCount == PhotonPasses::kFirst);
    if (!_lookups.empty() && !_points.empty()) _before.reset(_pixels / kTilePixels);
    _projection = PixelProjection(context.camera);
    // What media scatter towards a ray, and where walks below surfaces leave them, is sampled anew
    // in each pass.
    const SceneTraits& traits = traced->traits();
    if (context.options.integrator == IntegratorKind::Ppm && !traits.media && !traits.subsurface)
        _hitPoints.resize(2 * _pixels / kTilePixels);
}

int PhotonState::sharedPasses() const
{
    if (_idle || !(_largest > 0.0f)) return 0;
    if (_ended) return PhotonPasses::kFirst;
    if (!_lookups.empty()) return kChoosingPasses;
    if (!_carried.empty()) return PhotonPasses::kFirst; // they decide whether photons end
    return _guides || !_seenSquares.empty() ? PhotonPasses::kFirst + 1 : 1;
}

void PhotonState::prepare(const std::shared_ptr<const TracedScene>& traced, PassContext& context,
                          int pass, const Workers& workers)
{
    const PhotonScene scene = photonScene(traced, context);
    const PhotonPassOptions& options = scene.options;
    context.photonUse = options.use;
    if (options.use == PhotonUse::None) return;
    choose(traced, context, workers);
    if (_idle || (_ended && pass >= PhotonPasses::kFirst))
    {
        context.photonUse = PhotonUse::None;
        return;
    }
    _differences.resize(_pixels / kTilePixels);
    _alpha = context.options.photonAlpha;
    const auto shrinkOf = [&](int delay)
    {
        return static_cast<float>(
            std::sqrt(globalRadiusSquared(pass, static_cast<double>(_alpha), delay)));
    };
    _shrink = shrinkOf(0);
    context.leastPhotonRadius = std::max(_floor, _least * _shrink);
    context.largestPhotonRadius = std::max(_floor, _largest * _shrink);
    // Where some discs shrink late, most do.
    _smoothShrink = _lookups.empty() || _causticsAlone ? _shrink : shrinkOf(kLatePasses);
    const float cell = 2.0f * std::max(_floor, _cellRadius * _smoothShrink);
    _cellSize = cell;
    if (pass != _preparedPass || !_pass) // otherwise the pass keeps the photons that it began with
        _pass = _passes->pass(scene, pass, cell, workers);
    context.photons = &_pass->map;
    context.volumePhotons = _pass->volume.isEmpty() ? nullptr : &_pass->volume;
    const auto beamScale = static_cast<float>(beamRadiusScale(pass));
    context.beamRadius = std::max(_floor, _beamRadius * beamScale);
    context.leastSine = 1e-3f * beamScale;
    context.pointRadius =
        std::max(_floor, _pointRadius * static_cast<float>(pointRadiusScale(pass)));
    context.projection = &_projection;
    _opened = _pass->hasOpenings;
    if (pass >= PhotonPasses::kFirst && (!_opened || pass >= 2 * FirstPasses::kCount))
        _before.reset(0);
    _stored |= _pass->map.size() > 0 || !_pass->volume.isEmpty();
    _preparedPass = pass;
}

void PhotonState::finish(const std::shared_ptr<const TracedScene>& traced,
                         const PassContext& context, int pass)
{
    if (_idle || _ended) return;
    if (!_points.empty())
    {
        std::vector<SeenPoint> points;
        for (const std::vector<SeenPoint>& tile : _points)
            points.insert(points.end(), tile.begin(), tile.end());
        _passes->recordPoints(photonScene(traced, context), _view, std::move(points));
        std::vector<std::vector<SeenPoint>>().swap(_points);
    }
    if (pass + 1 == PhotonPasses::kFirst) endIfUnneeded();
    sumUpSeen();
    if (pass + 1 < PhotonPasses::kFirst || _seenSquares.empty()) return;
    _passes->recordSeen(photonScene(traced, context), _view, std::move(_seenSquares));
    _guides = true;
    std::vector<std::vector<SeenSquares>>().swap(_seen);
    _seenSquares.clear();
}

double PhotonState::secondsOf(int pass) const
{
    if (!_pass || pass == _preparedPass || _passes->keeps(pass)) return 0.0;
    return _pass->seconds;
}

FootprintBiases PhotonState::footprintBiases(int passes, const Workers& workers) const
{
    const std::size_t count = _lookups.size();
    FootprintBiases biases{std::vector<FootprintBias>(count), std::vector<FootprintBias>(count)};
    const auto addTile = [&](std::size_t tile)
    {
        FootprintBias compared, discs; // neighbours of the lists share cache lines
        if (_lookups[tile]) _lookups[tile]->addBiases(passes, compared, discs);
        biases.compared[tile] = compared;
        biases.later[tile] = discs;
    };
    workers.forEach(count, addTile);
    return biases;
}

/// Leaves all light to paths from the next pass on if photons have carried next to nothing. Passes
/// decide alike wherever they are made, as all of them depend on the first ones: sharedPasses.
void PhotonState::endIfUnneeded()
{
    if (_carried.empty()) return;
    const double sum = std::accumulate(_carried.begin(), _carried.end(), 0.0) /
                       static_cast<double>(_carried.size());
    _ended = sum < PhotonPasses::kFirst * kLeastCarried;
    if (_ended) _pass.reset();
    std::vector<double>().swap(_carried);
}

/// Sums up the contributions that a whole pass saw, in the order of the tiles. The sums therefore
/// depend neither on the order of threads nor on how often the pass was interrupted.
void PhotonState::sumUpSeen()
{
    for (std::vector<SeenSquares>& tile : _seen)
    {
        for (const SeenSquares& bin : tile)
            _seenSquares[bin.bin] += bin.squares;
        tile.clear();
    }
}

PhotonNote PhotonState::note() const
{
    if (_dark) return PhotonNote::NoPower;
    if (_ended) return PhotonNote::Ended;
    if (!_pass) return PhotonNote::None;
    if (_pass->rays > 0 && !_stored) return PhotonNote::NoneStored;
    return _limited ? PhotonNote::RadiusLimited : PhotonNote::None;
}

HitPoints* PhotonState::hitPoints(int tile, int pass)
{
    if (_hitPoints.empty()) return nullptr;
    const std::size_t half = (pass & 1) ? _hitPoints.size() / 2 : 0;
    return &_hitPoints[half + static_cast<std::size_t>(tile)];
}

std::size_t PhotonState::viewBytes() const
{
    std::size_t bytes = _firstRadii.size() * sizeof(float) +
                        _statistics.size() * sizeof(LocalStatistics) + _lookups.bytes() +
                        _differences.size() * sizeof(DiscDifferences);
    bytes += _before.bytes();
    for (const HitPoints& hits : _hitPoints)
        bytes += sizeof(HitPoints) + hits.bytes();
    return bytes;
}

void PhotonState::begin(int tile, int pass, GatheredPhotons& gathered)
{
    const std::size_t first = static_cast<std::size_t>(tile) * kTilePixels;
    if (!_seen.empty())
    {
        gathered.seenFirst = static_cast<uint32_t>(pass);
        gathered.seenStride = static_cast<uint32_t>(
            std::clamp<std::size_t>(_pixels / kRecordedPixels, 1, kMostRecordedStride));
    }
    if (!_points.empty())
        gathered.pointStride = static_cast<uint32_t>(
            std::clamp<std::size_t>(_pixels / kRecordedPixels, 1, kMostRecordedStride));
    gathered.separate = _local;
    gathered.shrink2 = gathered.smoothShrink2 = _shrink * _shrink;
    if (!_lookups.empty())
    {
        TileLookups* lookups = _lookups[static_cast<std::size_t>(tile)];
        if (!lookups) lookups = _lookups.begin(static_cast<std::size_t>(tile), _causticsAlone);
        fetchAhead(*lookups);
        const bool isReplaced = _opened && _before.areComplete(static_cast<std::size_t>(tile));
        if (isReplaced && pass == FirstPasses::kCount) lookups->restart();
        gathered.planes = lookups->planes;
        gathered.wantsFirstHits = TileLookups::repays(pass);
        gathered.balances = lookups->balances(pass);
        if (lookups->shrinksLate(pass)) gathered.smoothShrink2 = _smoothShrink * _smoothShrink;
        gathered.smallDisc = lookups->smallDisc(pass);
        // Discs of half the least radius would lose photons to rounding.
        if (_least * _shrink > 2.0f * _floor) lookups->beginBlur(pass, gathered);
    }
    gathered.choosesPlanes = pass < kChoosingPasses;
    gathered.comparedBlock = comparedBlock(tile, pass);
    for (std::size_t p = 0; p < kTilePixels; ++p)
    {
        const std::size_t half = (pass & 1) ? _pixels : 0;
        const float shrink2 =
            gathered.planes ? gathered.shrink2Of(gathered.planes[p]) : gathered.shrink2;
        const float radius = _local ? std::sqrt(_statistics[half + first + p].radius2)
                                    : _firstRadii[first + p] * std::sqrt(shrink2);
        gathered.radius[p] = radius > 0.0f && !choosesAgain(pass) ? std::max(radius, _floor) : 0.0f;
    }
}

void PhotonState::end(int tile, int pass, const GatheredPhotons& gathered, float alpha,
                      RgbaLanes* rgba)
{
    const std::size_t first = static_cast<std::size_t>(tile) * kTilePixels;
    _differences[static_cast<std::size_t>(tile)].add(pass, gathered.differences);
    const int counted = _opened ? _before.replace(static_cast<std::size_t>(tile), pass, rgba) : 1;
    if (!_lookups.empty())
        _lookups[static_cast<std::size_t>(tile)]->finish(pass, counted, alpha, gathered, rgba);
    if (!_carried.empty())
        _carried[static_cast<std::size_t>(tile)] += carriedSquare(gathered, rgba);
    if (gathered.pointStride) _points[static_cast<std::size_t>(tile)] = gathered.points;
    if (gathered.seenStride) _seen[static_cast<std::size_t>(tile)] = squaresOf(gathered.seen, rgba);
    if (!_before.empty() && pass < FirstPasses::kCount)
        _before.add(static_cast<std::size_t>(tile), pass, rgba);
    // The limit is by tile, so that the order of threads does not decide which hit points are kept.
    if (HitPoints* hits = hitPoints(tile, pass);
        hits && hits->bytes() > kMostHitPointBytes / _hitPoints.size())
        *hits = HitPoints();
    if (!_local)
    {
        const int shared = sharedPasses();
        for (std::size_t p = 0; p < kTilePixels && pass < shared; ++p)
        {
            float& radius = _firstRadii[first + p];
            const float chosen = gathered.radius[p] / _shrink;
            if (radius == 0.0f || (choosesAgain(pass) && chosen > 0.0f && chosen < radius))
                radius = chosen;
        }
        if (pass + 1 == shared) fillRadii(first);
        return;
    }
    for (std::size_t p = 0; p < kTilePixels; ++p)
    {
        LocalStatistics& s = _statistics[((pass & 1) ? _pixels : 0) + first + p];
        if (s.radius2 == 0.0f) s.radius2 = gathered.radius[p] * gathered.radius[p];
        // The film averages passes: the code adds the difference that makes the average the new
        // estimate.
        const Vec3d before = Vec3d(localRadiance(s)) * static_cast<double>(s.passes);
        const bool finite = isFinite(gathered.flux[p]);
        addPhotons(s, finite ? gathered.count[p] : 0, gathered.flux[p], alpha);
        const Vec3 added(Vec3d(localRadiance(s)) * static_cast<double>(s.passes) - before);
        RgbaLanes& block = rgba[p / kLanes];
        block.r[p % kLanes] += added.x;
        block.g[p % kLanes] += added.y;
        block.b[p % kLanes] += added.z;
    }
}

/// Gives the pixels of a tile that have no radius the mean of the others, or the largest one.
void PhotonState::fillRadii(std::size_t firstPixel)
{
    float sum = 0.0f;
    int known = 0;
    for (std::size_t p = firstPixel; p < firstPixel + kTilePixels; ++p)
    {
        sum += _firstRadii[p];
        known += _firstRadii[p] > 0.0f;
    }
    const float mean = known > 0 ? sum / static_cast<float>(known) : _largest;
    for (std::size_t p = firstPixel; p < firstPixel + kTilePixels; ++p)
        if (_firstRadii[p] == 0.0f) _firstRadii[p] = mean;
}

} // namespace osgRayTrace::engine
