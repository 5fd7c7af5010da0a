// TileOrder.h - an order of tiles in which any few of them are spread over the image. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace osgRayTrace::engine
{

/// Returns a number whose multiples modulo count are all numbers below count, once each, with
/// successive ones far apart: the golden section of count, or the next number below it that shares
/// no factor with count.
inline std::size_t evenStride(std::size_t count)
{
    auto stride = static_cast<std::size_t>(0.6180339887 * static_cast<double>(count));
    while (stride > 1 && std::gcd(stride, count) != 1)
        --stride;
    return std::max<std::size_t>(stride, 1);
}

/// Orders all tiles of an image: square groups of tiles one after the other, and the groups spread
/// over the image. The larger groups are, the more of the few tiles that a call traces lie
/// together.
class TileOrder
{
public:
    /// Makes an order. across, up: tiles along the image's sides; group: tiles along a side of a
    /// group.
    TileOrder(std::size_t across, std::size_t up, std::size_t group)
        : _across(across), _up(up), _group(group), _groupsAcross((across + group - 1) / group)
    {
        _groups = _groupsAcross * ((up + group - 1) / group);
        _stride = evenStride(_groups);
    }

    /// Returns the number of places in the order; some places in groups at the image's border have
    /// no tile.
    std::size_t places() const { return _groups * _group * _group; }

    /// Returns the tile of a place; across * up: the place has no tile.
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
