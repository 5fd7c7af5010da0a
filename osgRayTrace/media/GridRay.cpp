// GridRay.cpp - follows rays through the blocks of volumes. Layer: media.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/GridRay.h"

#include "osgRayTrace/media/FreeFlight.h"
#include "osgRayTrace/media/GridPieces.h"
#include "osgRayTrace/media/PhaseFunction.h"
#include "osgRayTrace/media/VolumeSample.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// The brightest colour of a point: more would leave no floats for the light of dense volumes.
constexpr float kBrightest = 1e6f;

} // namespace

void clipToCube(const Affine& cubeFromEngine, Vec3 origin, Vec3 direction, RayPart& part,
                float margin)
{
    const Vec3 o = transformPoint(cubeFromEngine, origin), d = cubeFromEngine.linear * direction;
    const Mat3 rows = glm::transpose(cubeFromEngine.linear);
    for (int k = 0; k < 3; ++k)
    {
        const float wider = margin != 0.0f ? margin * glm::length(rows[k]) : 0.0f;
        const float low = -wider, high = 1.0f + wider;
        const bool isWithin = o[k] >= low && o[k] <= high;
        if (!(low <= high) || (d[k] == 0.0f && !isWithin)) part.end = part.begin;
        if (!(low <= high) || d[k] == 0.0f) continue;
        const float a = (low - o[k]) / d[k], b = (high - o[k]) / d[k];
        part.begin = std::max(part.begin, std::min(a, b));
        part.end = std::min(part.end, std::max(a, b));
    }
}

Vec3 Scatterers::scattered(float cosTheta) const
{
    Vec3 sum(0.0f);
    for (int i = 0; i < count; ++i)
    {
        const auto k = static_cast<std::size_t>(i);
        sum += sigmaS[k] * evalPhase(phases[k], cosTheta);
    }
    return sum;
}

float Scatterers::pdf(float cosTheta) const
{
    float sum = 0.0f, weights = 0.0f;
    for (int i = 0; i < count; ++i)
    {
        const auto k = static_cast<std::size_t>(i);
        const float weight = sigmaS[k].x + sigmaS[k].y + sigmaS[k].z;
        weights += weight;
        sum += weight * evalPhase(phases[k], cosTheta);
    }
    return weights > 0.0f ? sum / weights : 0.0f;
}

Vec3 Scatterers::sample(Vec3 direction, float choice, float u, float v) const
{
    float weights = 0.0f;
    const auto weightOf = [&](int i)
    {
        const Vec3& sigma = sigmaS[static_cast<std::size_t>(i)];
        return sigma.x + sigma.y + sigma.z;
    };
    for (int i = 0; i < count; ++i)
        weights += weightOf(i);
    int chosen = 0;
    float below = weightOf(0);
    while (chosen + 1 < count && choice * weights >= below)
        below += weightOf(++chosen);
    return samplePhase(phases[static_cast<std::size_t>(chosen)], direction, u, v);
}

GridRay::GridRay(const GridTable& table, Vec3 origin, Vec3 direction, float begin, float end,
                 GridKinds kinds)
    : _table(&table), _origin(origin), _direction(direction), _extent{end, begin}
{
    for (std::size_t i = 0; i < table.size(); ++i)
    {
        if (kinds == GridKinds::Densities && table[i].volume->law != VolumeLaw::Density) continue;
        RayPart part{begin, end};
        clipToCube(table[i].tileFromEngine, origin, direction, part);
        clipToCube(table[i].imageFromEngine, origin, direction, part);
        if (part.isEmpty() || !(part.end < kInfinity)) continue;
        const auto k = static_cast<std::size_t>(_count++);
        _spans[k] = {static_cast<uint32_t>(i), part};
        _extinctions[k] = table[i].extinction(direction);
        _extent = {std::min(_extent.begin, part.begin), std::max(_extent.end, part.end)};
    }
}

void GridRay::setAround(const MediumRecord& medium, RayPart part)
{
    if (part.isEmpty() || medium.isClear) return;
    _around = &medium;
    _aroundPart = part;
    _aroundWay = MediumWay(medium, _origin, _direction, part);
    _extent = {std::min(_extent.begin, part.begin), std::max(_extent.end, part.end)};
}

void GridRay::setReach(float reach, RayPart part)
{
    _reached = {kInfinity, -kInfinity};
    const bool any = _around && _around->isThin();
    for (std::size_t i = 0; i < _table->size(); ++i)
    {
        const GridRecord& grid = (*_table)[i];
        if (!grid.scatters && !any) continue;
        RayPart within = part;
        clipToCube(grid.tileFromEngine, _origin, _direction, within, reach);
        clipToCube(grid.imageFromEngine, _origin, _direction, within, reach);
        if (within.isEmpty() || !(within.end < kInfinity)) continue;
        _reached = {std::min(_reached.begin, within.begin), std::max(_reached.end, within.end)};
    }
    if (_reached.isEmpty()) return;
    _extent = {std::min(_extent.begin, _reached.begin), std::max(_extent.end, _reached.end)};
}

void GridRay::setLight(const VolumeLight& light)
{
    _isLit = true;
    for (int i = 0; i < _count; ++i)
    {
        const auto k = static_cast<std::size_t>(i);
        _litDirections[k] =
            litDirection((*_table)[_spans[k].grid], light, pointAt(_spans[k].part.end));
    }
}

bool GridRay::scatters() const
{
    for (int i = 0; i < _count; ++i)
        if ((*_table)[_spans[static_cast<std::size_t>(i)].grid].scatters) return true;
    return _around && _around->scatters;
}

/// Returns the coefficients at a point of the ray. Volumes that are no densities glow: what they
/// take from light they replace by their colour.
GridRay::Coefficients GridRay::at(float distance, bool withEmission) const
{
    Coefficients sum;
    for (int i = 0; i < _count; ++i)
    {
        const auto k = static_cast<std::size_t>(i);
        const RayPart& part = _spans[k].part;
        if (!(distance >= part.begin && distance <= part.end)) continue;
        const GridRecord& grid = (*_table)[_spans[k].grid];
        const Volume& volume = *grid.volume;
        const Vec3 place = transformPoint(grid.imageFromEngine, pointAt(distance));
        const VolumePoint point = volumePoint(volume, place);
        const float amount = amountOf(volume, point.opacity);
        if (!(amount > 0.0f)) continue;
        sum.sigmaT += _extinctions[k] * amount;
        if (!withEmission) continue;
        const bool glows = volume.law != VolumeLaw::Density;
        Vec3 tint = volume.law == VolumeLaw::Samples ? volume.tint : Vec3(1.0f);
        if (_isLit && glows && volume.lit)
            tint *= lightScale(*volume.image, place, gradientStep(volume, cellStep(volume)),
                               _litDirections[k]);
        sum.emission += (glows ? _extinctions[k] : grid.emission) * amount *
                        glm::clamp(point.color * tint, 0.0f, kBrightest);
    }
    if (_around && distance >= _aroundPart.begin && distance < _aroundPart.end)
    {
        const float density = _aroundWay.density(distance);
        sum.sigmaT += _around->sigmaT * density;
        sum.emission += _around->emission * density;
    }
    return sum;
}

Scatterers GridRay::scatterersAt(float distance) const
{
    Scatterers scatterers;
    for (int i = 0; i < _count; ++i)
    {
        const auto k = static_cast<std::size_t>(i);
        const RayPart& part = _spans[k].part;
        const GridRecord& grid = (*_table)[_spans[k].grid];
        if (!grid.scatters || !(distance >= part.begin && distance <= part.end)) continue;
        const VolumePoint point =
            volumePoint(*grid.volume, transformPoint(grid.imageFromEngine, pointAt(distance)));
        const Vec3 albedo = glm::clamp(point.color, 0.0f, 1.0f);
        scatterers.add(grid.sigmaS * albedo * amountOf(*grid.volume, point.opacity), grid.phase);
    }
    if (_around && distance >= _aroundPart.begin && distance < _aroundPart.end)
        scatterers.add(_around->sigmaS * _aroundWay.density(distance), _around->phase);
    return scatterers;
}

GridFlight GridRay::flight(Vec3 pmf, NumberStream& numbers,
                           std::vector<TentativeCollision>* tentativeOnes) const
{
    GridFlight result;
    float u = numbers.next();
    const int channel = chooseChannel(pmf, u);
    Vec3 share(1.0f); // F, times a common factor
    float depth = depthOf(u);
    int tentative = 0;
    const Pieces::Extra extra = tentativeOnes ? Pieces::Extra::Reached : Pieces::Extra::Glowing;
    for (Pieces piece(*this, _extent.begin, _extent.end, extra); piece.advance();)
    {
        float t = piece.begin();
        while (piece.most > 0.0f && depth < piece.most * (piece.end() - t))
        {
            t += depth / piece.most;
            if (++tentative > kMostTentative)
            {
                result.cut = true;
                result.weight = Vec3(0.0f);
                return result;
            }
            const Coefficients here = at(t, true);
            const float norm = glm::dot(pmf, share);
            result.emitted += share * here.emission / (piece.most * norm);
            if (tentativeOnes) tentativeOnes->push_back({t, share / (piece.most * norm)});
            const Vec3 real = glm::min(here.sigmaT / piece.most, 1.0f);
            if (numbers.next() < real[channel])
            {
                result.collides = true;
                result.distance = t;
                const float density = glm::dot(pmf, share * here.sigmaT);
                result.weight = density > 0.0f ? share / density : Vec3(0.0f);
                return result;
            }
            share *= Vec3(1.0f) - real;
            share /= largestOf(share);
            depth = depthOf(numbers.next());
        }
        depth -= piece.most * (piece.end() - t);
    }
    result.distance = _extent.end;
    result.weight = share / glm::dot(pmf, share);
    return result;
}

GridWay GridRay::way(NumberStream& numbers) const
{
    GridWay result;
    float depth = depthOf(numbers.next());
    int tentative = 0;
    for (Pieces piece(*this, _extent.begin, _extent.end, Pieces::Extra::Glowing); piece.advance();)
    {
        float t = piece.begin();
        while (piece.most > 0.0f && depth < piece.most * (piece.end() - t))
        {
            t += depth / piece.most;
            if (++tentative > kMostTentative)
            {
                result.cut = true;
                result.left = Vec3(0.0f);
                return result;
            }
            const Coefficients here = at(t, true);
            result.emitted += result.left * here.emission / piece.most;
            result.left *= glm::max(Vec3(1.0f) - here.sigmaT / piece.most, 0.0f);
            // Roulette once little is left, so that dense volumes end ways.
            constexpr float kLittle = 0.02f, kSurvival = 0.25f;
            if (largestOf(result.left) < kLittle)
            {
                if (!(numbers.next() < kSurvival))
                {
                    result.left = Vec3(0.0f);
                    return result;
                }
                result.left /= kSurvival;
            }
            depth = depthOf(numbers.next());
        }
        depth -= piece.most * (piece.end() - t);
    }
    return result;
}

Vec3 GridRay::transmittance(float begin, float end, NumberStream& numbers) const
{
    Vec3 left(1.0f);
    float depth = depthOf(numbers.next());
    int tentative = 0;
    for (Pieces piece(*this, begin, std::min(end, _extent.end)); piece.advance();)
    {
        float t = piece.begin();
        left *= glm::exp(-piece.least * (piece.end() - t));
        // What a channel has above its least extinction: the majorant of the rest.
        const float rest = std::max(
            0.0f, piece.most - std::min(piece.least.x, std::min(piece.least.y, piece.least.z)));
        while (rest > 0.0f && depth < rest * (piece.end() - t))
        {
            t += depth / rest;
            if (++tentative > kMostTentative) return Vec3(0.0f);
            left *= glm::clamp(Vec3(1.0f) - (at(t, false).sigmaT - piece.least) / rest, 0.0f, 1.0f);
            constexpr float kLittle = 0.02f, kSurvival = 0.25f;
            if (largestOf(left) < kLittle)
            {
                if (!(numbers.next() < kSurvival)) return Vec3(0.0f);
                left /= kSurvival;
            }
            depth = depthOf(numbers.next());
        }
        if (largestOf(left) < 1e-30f) return Vec3(0.0f);
        depth -= rest * (piece.end() - t);
    }
    return left;
}

} // namespace osgRayTrace::engine
