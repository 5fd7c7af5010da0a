// TileOrder.h - an order of tiles in which any few of them are spread over the image. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace osgRayTrace::engine
{

/// Its multiples modulo count are all numbers below count, once each, and successive ones lie far
/// apart: the golden section of count, or the next below it that shares no factor with it.
inline std::size_t evenStride(std::size_t count)
{
    auto stride = static_cast<std::size_t>(0.6180339887 * static_cast<double>(count));
    while (stride > 1 && std::gcd(stride, count) != 1)
        --stride;
    return std::max<std::size_t>(stride, 1);
}

/// All tiles of an image, square groups of them one after the other and these spread over the
/// image: the larger they are, the more of the few tiles that a call makes lie together.
class TileOrder
{
public:
    /// across, up: tiles; group: of them, along a side of a group.
    TileOrder(std::size_t across, std::size_t up, std::size_t group)
        : _across(across), _up(up), _group(group), _groupsAcross((across + group - 1) / group)
    {
        _groups = _groupsAcross * ((up + group - 1) / group);
        _stride = evenStride(_groups);
    }

    /// Places in the order; some of those in groups at the image's border are of no tile.
    std::size_t places() const { return _groups * _group * _group; }

    /// Of a place; across * up: none.
    std::size_t tile(std::size_t place) const
    {
        const std::size_t within = place % (_group * _group);
        const std::size_t group = place / (_group * _group) * _stride % _groups;
        const std::size_t x = group % _groupsAcross * _group + within % _group;
        const std::size_t y = group / _groupsAcross * _group + within / _group;
        return x < _across && y < _up ? y * _across + x : _across * _up;
    }

private:
    std::size_t _across, _up, _group, _groupsAcross, _groups, _stride;
};

} // namespace osgRayTrace::engine
