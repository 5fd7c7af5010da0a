// VertexArrays.cpp - reads, checks and transforms vertex data, or shares it. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/VertexArrays.h"

#include "osgRayTrace/bridge/geometry/HostArrays.h"
#include "osgRayTrace/bridge/geometry/MatrixMaps.h"
#include "osgRayTrace/film/ToneMap.h"

#include <cmath>
#include <memory>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kLargestCoordinate = 1e18f; ///< Embree's limit is 1.844e18
/// Tolerance of a normal's squared length, beyond which it is normalised.
constexpr float kUnitTolerance = 1e-3f;

static_assert(sizeof(Vec2) == 8 && sizeof(Vec3) == 12 && sizeof(Vec4) == 16, "rows are packed");

/// Returns whether all values are within the limit; NaN is not. The loop over floats is plain, so
/// the compiler vectorizes it.
bool allWithin(const float* values, std::size_t count, float largest)
{
    unsigned int outside = 0;
    for (std::size_t i = 0; i < count; ++i)
        outside |= static_cast<unsigned int>(!(std::fabs(values[i]) <= largest));
    return outside == 0;
}

bool allUnit(const Vec3* normals, std::size_t count)
{
    unsigned int off = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
        const Vec3& n = normals[i];
        const float error = n.x * n.x + n.y * n.y + n.z * n.z - 1.0f;
        off |= static_cast<unsigned int>(!(std::fabs(error) <= kUnitTolerance));
    }
    return off == 0;
}

/// Returns whether 4 bytes past the end may be read. Embree loads vertices 16 bytes at a time, so
/// it reads 4 bytes past the last one. These bytes lie within the same page, and so cannot fault,
/// unless the array ends at the end of a page.
bool mayBeReadPast(const void* end)
{
    constexpr std::uintptr_t kSmallestPage = 4096;
    return reinterpret_cast<std::uintptr_t>(end) % kSmallestPage != 0;
}

/// Returns engine memory for count values, with room for Embree's read past the end.
template <class T> std::vector<T> paddedVector(std::size_t count, const T& value)
{
    std::vector<T> values;
    values.reserve(count + 1);
    values.assign(count, value);
    return values;
}

template <class T> SharedArray<T> copyOf(const T* values, std::size_t count)
{
    std::vector<T> copy;
    copy.reserve(count + 1);
    copy.assign(values, values + count);
    return copy;
}

bool isWithin(const Vec3d& p, double largest)
{
    return std::fabs(p.x) <= largest && std::fabs(p.y) <= largest && std::fabs(p.z) <= largest;
}

double determinantOf(const osg::Matrixd& m)
{
    return m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) -
           m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0)) +
           m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
}

uint64_t countOf(const std::vector<uint8_t>& flags)
{
    uint64_t count = 0;
    for (const uint8_t flag : flags)
        count += flag;
    return count;
}

} // namespace

/// Returns the array's own rows if they may be used in place of a copy; otherwise null. The rows
/// must be one a vertex, of type T, and not declared to change.
template <class T> const T* VertexReader::shareable(const osg::Array& array) const
{
    if (!_map.rows.empty() || array.getNumElements() < _map.vertexCount) return nullptr;
    return rowsOf<T>(array);
}

template <class T> SharedArray<T> VertexReader::share(const osg::Array& array) const
{
    const T* values = rowsOf<T>(array);
    const bool changes = _request.copies || _geometry.getDataVariance() == osg::Object::DYNAMIC ||
                         array.getDataVariance() == osg::Object::DYNAMIC;
    if (changes || !mayBeReadPast(values + _map.vertexCount))
        return copyOf(values, _map.vertexCount);
    return SharedArray<T>(values, _map.vertexCount, keepHostArray(array));
}

RowSelection VertexReader::rowsOfBinding(const osg::Array& array, IntegerMeaning integers) const
{
    const bool perSet = array.getBinding() == osg::Array::BIND_PER_PRIMITIVE_SET;
    const std::vector<uint32_t>& rows = perSet ? _map.primitiveSets : _map.rows;
    return {_map.vertexCount, rows.empty() ? nullptr : rows.data(), integers};
}

Positions VertexReader::positions(const osg::Array& array) const
{
    const std::size_t count = _map.vertexCount;
    Positions result;
    if (!_request.transform)
    {
        const Vec3* ready = shareable<Vec3>(array);
        if (ready && allWithin(&ready->x, 3 * count, kLargestCoordinate))
        {
            result.values = share<Vec3>(array);
            return result;
        }
    }

    const PointMap map(_request.transform);
    std::vector<Vec3> values = paddedVector(count, Vec3(0.0f));
    const RowSelection rows{count, _map.rows.empty() ? nullptr : _map.rows.data()};
    forEachRow(array, rows,
               [&](std::size_t i, const Vec4d& row)
               {
                   const Vec3d p = map(row.w == 1.0 ? Vec3d(row) : Vec3d(row) / row.w);
                   if (isWithin(p, kLargestCoordinate))
                   {
                       values[i] = Vec3(p);
                       return;
                   }
                   result.unsound.resize(count);
                   result.unsound[i] = 1;
               });
    result.values = std::move(values);
    return result;
}

Normals VertexReader::normals(const osg::Array* array) const
{
    Normals result;
    const osg::Array::Binding binding = bindingOf(array);
    if (binding == osg::Array::BIND_OFF || array->getDataSize() < 3) return result;

    const std::size_t count = _map.vertexCount;
    if (binding == osg::Array::BIND_PER_VERTEX && !_request.transform)
    {
        const Vec3* ready = shareable<Vec3>(*array);
        if (ready && allUnit(ready, count))
        {
            result.values = share<Vec3>(*array);
            return result;
        }
    }

    const NormalMap map(_request.transform);
    std::vector<Vec3> values(count, Vec3(0.0f));
    uint64_t found = 0;
    const auto put = [&](std::size_t i, const Vec4d& row)
    {
        const Vec3d n = map(Vec3d(row));
        const double length = glm::length(n);
        if (!(length > 0.0) || !std::isfinite(length)) return;
        values[i] = Vec3(n / length);
        ++found;
    };
    if (binding == osg::Array::BIND_OVERALL)
    {
        forEachRow(*array, {1, nullptr, IntegerMeaning::Normalized}, put);
        if (found == 1) values.assign(count, values[0]);
        found *= count;
    }
    else
        forEachRow(*array, rowsOfBinding(*array, IntegerMeaning::Normalized), put);

    if (found == 0) return result;
    if (found < count)
    {
        result.missing.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            result.missing[i] = values[i] == Vec3(0.0f);
    }
    result.values = std::move(values);
    return result;
}

SharedArray<Vec2> VertexReader::textureCoordinates(const osg::Array* array,
                                                   ConversionCounts& counts) const
{
    if (!isReadable(array)) return {};
    const std::size_t count = _map.vertexCount;
    const Vec2* ready = shareable<Vec2>(*array);
    if (ready && allWithin(&ready->x, 2 * count, kLargestCoordinate)) return share<Vec2>(*array);

    std::vector<Vec2> values(count, Vec2(0.0f));
    std::vector<uint8_t> missing(count, 1);
    const RowSelection rows{count, _map.rows.empty() ? nullptr : _map.rows.data()};
    forEachRow(*array, rows,
               [&](std::size_t i, const Vec4d& row)
               {
                   const Vec3d uv(row.x / row.w, row.y / row.w, 0.0);
                   if (!isWithin(uv, kLargestCoordinate)) return;
                   values[i] = Vec2(uv);
                   missing[i] = 0;
               });
    if (const uint64_t repaired = countOf(missing))
        counts["repaired.texture-coordinate"] += repaired;
    return values;
}

SharedArray<float> VertexReader::thirdCoordinates(const osg::Array* array) const
{
    if (!isReadable(array) || array->getDataSize() < 3) return {};
    std::vector<float> values(_map.vertexCount, 0.0f);
    bool any = false;
    const RowSelection rows{values.size(), _map.rows.empty() ? nullptr : _map.rows.data()};
    forEachRow(*array, rows,
               [&](std::size_t i, const Vec4d& row)
               {
                   const Vec3d coordinates = Vec3d(row) / row.w;
                   if (!isWithin(coordinates, kLargestCoordinate)) return;
                   values[i] = static_cast<float>(coordinates.z);
                   any = any || values[i] != 0.0f;
               });
    if (!any) return {};
    return values;
}

SharedArray<Vec4> VertexReader::colors(const osg::Array* array, ConversionCounts& counts) const
{
    const osg::Array::Binding binding = bindingOf(array);
    if (binding == osg::Array::BIND_OFF || binding == osg::Array::BIND_OVERALL) return {};
    const std::size_t count = _map.vertexCount;
    if (binding == osg::Array::BIND_PER_VERTEX && !_request.decodeColors)
    {
        const Vec4* ready = shareable<Vec4>(*array);
        if (ready && allWithin(&ready->x, 4 * count, kLargestCoordinate))
            return share<Vec4>(*array);
    }

    std::vector<Vec4> values(count, Vec4(1.0f));
    std::vector<uint8_t> missing(count, 1);
    forEachRow(*array, rowsOfBinding(*array, IntegerMeaning::Normalized),
               [&](std::size_t i, const Vec4d& row)
               {
                   if (!isWithin(Vec3d(row), kLargestCoordinate) ||
                       !(std::fabs(row.w) <= kLargestCoordinate))
                       return;
                   Vec4 color(row);
                   for (int c = 0; c < 3 && _request.decodeColors; ++c)
                       color[c] = linearFromSrgb(color[c]);
                   if (!isFinite(Vec3(color))) return; // 1e16 in sRGB is 1e38 in linear light
                   values[i] = color;
                   missing[i] = 0;
               });
    if (const uint64_t repaired = countOf(missing)) counts["repaired.color"] += repaired;
    return values;
}

SharedArray<Vec4> VertexReader::tangents(const osg::Array* array) const
{
    if (!isReadable(array) || array->getDataSize() != 4 ||
        array->getBinding() != osg::Array::BIND_PER_VERTEX)
        return {};
    const std::size_t count = _map.vertexCount;
    if (!_request.transform)
    {
        const Vec4* ready = shareable<Vec4>(*array);
        if (ready && allWithin(&ready->x, 4 * count, kLargestCoordinate))
            return share<Vec4>(*array);
    }
    const std::optional<osg::Matrixd>& m = _request.transform;
    // A transform that mirrors turns the side on which the bitangent is.
    const double sign = m && determinantOf(*m) < 0.0 ? -1.0 : 1.0;
    std::vector<Vec4> values(count, Vec4(0.0f));
    forEachRow(*array, rowsOfBinding(*array, IntegerMeaning::Normalized),
               [&](std::size_t i, const Vec4d& row)
               {
                   const osg::Vec3d local(row.x, row.y, row.z);
                   const osg::Vec3d t = m ? osg::Matrixd::transform3x3(local, *m) : local;
                   const Vec4 value(Vec4d(t.x(), t.y(), t.z(), sign * row.w));
                   if (isFinite(Vec3(value)) && std::isfinite(value.w)) values[i] = value;
               });
    return values;
}

} // namespace osgRayTrace::engine
