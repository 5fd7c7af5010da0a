// SceneExtent.cpp - the size of a scene, and its unit of length for float arithmetic. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/SceneExtent.h"

#include "osgRayTrace/bridge/common/ArrayReader.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

// These are binary exponents. Embree is right if triangles and distances are 3e-13 to 4e12 long,
// 2^-41 to 2^42: extents have to leave room below for small triangles and above for long rays.
constexpr int kSmallestExtent = -16;
constexpr int kLargestExtent = 31;
/// A scene is not tiny if one in so many lengths is ordinary.
constexpr uint64_t kOrdinaryShare = 8;
/// Exponent above the median; scaled with an outlier, the median would be 2^-18.
constexpr int kOutlier = 50;

/// Largest ratio of coordinates to size: with less than 2^10 floats from end to end a body shows
/// its rounding.
constexpr double kCoarse = 16384.0;

Vec3d positionOf(const Vec4d& row)
{
    return row.w == 1.0 ? Vec3d(row) : Vec3d(row) / row.w;
}

double largestOf(const Vec3d& v)
{
    return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

/// Returns the bounds of the rows: the common case, without a branch for each vertex, which takes 2
/// ms a million. There are no bounds if a coordinate is above the limit.
VertexBounds boundsOfRows(const Vec3* rows, std::size_t count, float limit)
{
    Vec3 low(kInfinity), high(-kInfinity);
    unsigned int outside = 0;
    for (std::size_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k)
        {
            const float v = rows[i][k];
            low[k] = v < low[k] ? v : low[k];
            high[k] = v > high[k] ? v : high[k];
            outside |= static_cast<unsigned int>(!(std::fabs(v) <= limit));
        }
    if (outside || count == 0) return {};
    return {Vec3d(low), Vec3d(high), count};
}

/// Returns the box of all positions whose coordinates are within the limit; NaN is not.
VertexBounds boundsWithin(const osg::Array& positions, double limit)
{
    VertexBounds bounds;
    bounds.low = Vec3d(HUGE_VAL);
    bounds.high = Vec3d(-HUGE_VAL);
    forEachRow(
        positions, {positions.getNumElements()},
        [&](std::size_t, const Vec4d& row)
        {
            const Vec3d p = positionOf(row);
            if (!(std::fabs(p.x) <= limit && std::fabs(p.y) <= limit && std::fabs(p.z) <= limit))
                return;
            bounds.low = glm::min(bounds.low, p);
            bounds.high = glm::max(bounds.high, p);
            ++bounds.count;
        });
    return bounds.count ? bounds : VertexBounds();
}

} // namespace

void LengthCounts::add(double length, uint64_t count)
{
    if (length > 0.0 && std::isfinite(length)) _counts[std::ilogb(length)] += count;
}

double LengthCounts::limit() const
{
    uint64_t total = 0;
    for (const auto& entry : _counts)
        total += entry.second;
    if (total == 0) return 0.0;

    uint64_t below = 0;
    auto median = _counts.begin();
    while ((below += median->second) * 2 < total)
        ++median;
    const auto beyond = _counts.upper_bound(median->first + kOutlier);
    return std::ldexp(1.0, std::prev(beyond)->first + 1);
}

/// Returns the counts without the tiny parts of a scene of ordinary size: these parts do not make
/// the scene tiny, as they are too small to be seen.
LengthCounts LengthCounts::ordinary() const
{
    uint64_t all = 0, ordinary = 0;
    for (const auto& entry : _counts)
    {
        all += entry.second;
        if (entry.first >= kSmallestExtent) ordinary += entry.second;
    }
    LengthCounts counts = *this;
    if (ordinary * kOrdinaryShare >= all)
        counts._counts.erase(counts._counts.begin(), counts._counts.lower_bound(kSmallestExtent));
    return counts;
}

double LengthCounts::unit() const
{
    const double largest = ordinary().limit();
    if (largest == 0.0) return 1.0;
    const int exponent = std::ilogb(largest) - 1;
    if (exponent < kSmallestExtent) return std::ldexp(1.0, exponent);
    if (exponent > kLargestExtent) return std::ldexp(1.0, exponent - kLargestExtent);
    return 1.0;
}

bool LengthCounts::areOrdinary() const
{
    return _counts.empty() ||
           (_counts.begin()->first >= kSmallestExtent && _counts.rbegin()->first <= kLargestExtent);
}

bool isOrdinaryLength(double length)
{
    LengthCounts counts;
    counts.add(length);
    return std::isfinite(length) && counts.areOrdinary();
}

VertexBounds vertexBounds(const osg::Array& positions)
{
    // Coordinates of ordinary size have no outliers among them.
    constexpr float kOrdinary = 0x1p20f;
    if (const Vec3* rows = rowsOf<Vec3>(positions))
    {
        const VertexBounds bounds = boundsOfRows(rows, positions.getNumElements(), kOrdinary);
        if (bounds.count > 0) return bounds;
    }

    LengthCounts lengths;
    forEachRow(positions, {positions.getNumElements()},
               [&](std::size_t, const Vec4d& row) { lengths.add(largestOf(positionOf(row))); });
    return boundsWithin(positions, lengths.limit());
}

double largestCoordinate(const VertexBounds& bounds, const osg::Matrixd& m)
{
    const Vec3d c = bounds.centre(), h = 0.5 * (bounds.high - bounds.low);
    double largest = 0.0;
    for (int k = 0; k < 3; ++k)
    {
        const double centre = c.x * m(0, k) + c.y * m(1, k) + c.z * m(2, k) + m(3, k);
        const double half =
            h.x * std::fabs(m(0, k)) + h.y * std::fabs(m(1, k)) + h.z * std::fabs(m(2, k));
        largest = std::max(largest, std::fabs(centre) + half);
    }
    return largest;
}

bool areCoarseInFloat(const VertexBounds& bounds)
{
    const double largest = std::max(largestOf(bounds.low), largestOf(bounds.high));
    return bounds.count > 1 && largest > kCoarse * 2.0 * bounds.radius() && bounds.radius() > 0.0;
}

} // namespace osgRayTrace::engine
