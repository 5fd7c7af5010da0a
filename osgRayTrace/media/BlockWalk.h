// BlockWalk.h - follows a ray through the blocks of one volume. Layer: media; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/media/GridTable.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

/// Walks through the blocks of one volume along a ray [Amanatides87].
class BlockWalk
{
public:
    void begin(const GridRecord& grid, Vec3 origin, Vec3 direction, RayPart part)
    {
        _grid = &grid;
        _part = part;
        const ValueBlocks& blocks = *grid.blocks->values;
        const VolumeImage& image = *grid.volume->image;
        const Vec3 size = Vec3(Vec3d(image.width, image.height, image.depth)) /
                          static_cast<float>(ValueBlocks::kSide);
        const Vec3 d = grid.imageFromEngine.linear * direction * size;
        const Vec3 p = transformPoint(grid.imageFromEngine, origin + direction * part.begin) * size;
        for (int k = 0; k < 3; ++k)
        {
            const int last = blocks.count[static_cast<std::size_t>(k)] - 1;
            _at[k] = p[k] > 0.0f ? static_cast<int>(std::min(p[k], static_cast<float>(last))) : 0;
            _step[k] = d[k] > 0.0f ? 1 : -1;
            _delta[k] = d[k] != 0.0f ? std::fabs(1.0f / d[k]) : kInfinity;
            const float border = static_cast<float>(_at[k] + (d[k] > 0.0f ? 1 : 0));
            _next[k] =
                d[k] != 0.0f ? part.begin + std::max(0.0f, (border - p[k]) / d[k]) : kInfinity;
        }
        _isWithin = false;
        _end = part.begin;
        _least = _most = 0.0f;
    }

    float end() const { return _end; }
    float least() const { return _least; }
    float most() const { return _most; }

    /// Goes on to the piece behind end(): the next block, or all that is behind the volume.
    void advance()
    {
        if (!_isWithin)
            _isWithin = true;
        else if (_end >= _part.end || !leaveBlock())
        {
            _end = kInfinity;
            _least = _most = 0.0f;
            return;
        }
        const ValueBlocks& blocks = *_grid->blocks->values;
        const std::size_t block =
            (static_cast<std::size_t>(_at[2]) * static_cast<std::size_t>(blocks.count[1]) +
             static_cast<std::size_t>(_at[1])) *
                static_cast<std::size_t>(blocks.count[0]) +
            static_cast<std::size_t>(_at[0]);
        _least = _grid->blocks->least[block];
        _most = _grid->blocks->most[block];
        _end = std::min(_part.end, std::min(_next[0], std::min(_next[1], _next[2])));
    }

private:
    /// Steps into the next block. Returns false behind the last one.
    bool leaveBlock()
    {
        const int k =
            _next[0] <= _next[1] ? (_next[0] <= _next[2] ? 0 : 2) : (_next[1] <= _next[2] ? 1 : 2);
        _at[k] += _step[k];
        _next[k] += _delta[k];
        return _at[k] >= 0 && _at[k] < _grid->blocks->values->count[static_cast<std::size_t>(k)];
    }

    const GridRecord* _grid = nullptr;
    RayPart _part;
    int _at[3], _step[3];
    float _next[3], _delta[3];
    float _end = 0.0f, _least = 0.0f, _most = 0.0f;
    bool _isWithin = false;
};

} // namespace osgRayTrace::engine
