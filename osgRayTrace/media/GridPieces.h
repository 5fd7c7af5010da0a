// GridPieces.h - the pieces of a ray through volumes, block by block. Layer: media; private to
// GridRay.cpp and GridParts.cpp.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/media/BlockWalk.h"
#include "osgRayTrace/media/GridRay.h"

#include <algorithm>

namespace osgRayTrace::engine
{

inline float largestOf(Vec3 v)
{
    return std::max(v.x, std::max(v.y, v.z));
}

/// The pieces of a stretch on which the majorant is constant, one after the other.
class GridRay::Pieces
{
public:
    /// Which pieces get additional tentative collisions.
    enum class Extra
    {
        None,
        Glowing, ///< those that emit: emission is collected where nothing is extinguished, too
        Reached, ///< those within reach of what scatters, see setReach, and those in dense media
    };

    Pieces(const GridRay& ray, float begin, float end, Extra wanted = Extra::None)
        : _ray(ray), _begin(begin), _last(end)
    {
        // A few collisions along the way, whose number does not matter for the mean.
        constexpr float kExtraDepth = 4.0f;
        const auto extraOn = [](float length)
        { return length > 0.0f ? kExtraDepth / length : 0.0f; };
        const bool reached = wanted == Extra::Reached;
        if (reached && !ray._reached.isEmpty())
            _reachedExtra = extraOn(ray._reached.end - ray._reached.begin);
        const float extra = wanted != Extra::None ? extraOn(end - begin) : 0.0f;
        if (ray._around && (reached ? ray._around->isDense : ray._around->emits))
            _aroundExtra = extra;
        for (int i = 0; i < ray._count; ++i)
        {
            const auto k = static_cast<std::size_t>(i);
            RayPart part = ray._spans[k].part;
            part.begin = std::max(part.begin, begin);
            part.end = std::min(part.end, end);
            if (part.isEmpty()) continue;
            const GridRecord& grid = (*ray._table)[ray._spans[k].grid];
            _extras[_count] = !reached && grid.emission != Vec3(0.0f) ? extra : 0.0f;
            _factors[_count] = ray._extinctions[k];
            _walks[_count++].begin(grid, ray._origin, ray._direction, part);
        }
        _end = begin;
    }

    /// Goes on to the next piece. Returns false behind the last one.
    bool advance()
    {
        _begin = _end;
        if (!(_begin < _last)) return false;
        _end = _last;
        most = 0.0f;
        least = Vec3(0.0f);
        for (std::size_t i = 0; i < _count; ++i)
        {
            while (_walks[i].end() <= _begin)
                _walks[i].advance();
            _end = std::min(_end, _walks[i].end());
            most += _walks[i].most() * largestOf(_factors[i]);
            if (_walks[i].most() > 0.0f) most += _extras[i];
            least += _walks[i].least() * _factors[i];
        }
        if (_ray._around && endsWithin(_ray._aroundPart))
        {
            _end = std::min(_end, _ray._aroundWay.evenEnd(_begin));
            const auto [thin, thick] = _ray._aroundWay.densities(_begin, _end);
            most += largestOf(_ray._around->sigmaT) * thick + _aroundExtra;
            least += _ray._around->sigmaT * thin;
        }
        if (_reachedExtra > 0.0f && endsWithin(_ray._reached)) most += _reachedExtra;
        return true;
    }

    float begin() const { return _begin; }
    float end() const { return _end; }

    float most = 0.0f; ///< extinction that no channel exceeds within the piece [1/length]
    Vec3 least{0.0f};  ///< extinction that each channel has at least

private:
    /// Ends the piece where a part begins or ends. Returns whether the part holds the piece.
    bool endsWithin(const RayPart& part)
    {
        if (_begin < part.begin) _end = std::min(_end, part.begin);
        if (_begin < part.begin || !(_begin < part.end)) return false;
        _end = std::min(_end, part.end);
        return true;
    }

    const GridRay& _ray;
    BlockWalk _walks[kMostVolumes];
    Vec3 _factors[kMostVolumes];
    float _extras[kMostVolumes];
    float _aroundExtra = 0.0f, _reachedExtra = 0.0f;
    std::size_t _count = 0;
    float _begin, _last, _end = 0.0f;
};

} // namespace osgRayTrace::engine
