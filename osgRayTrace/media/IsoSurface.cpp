// IsoSurface.cpp - marching cubes whose cells are derived, not tabled. Layer: media.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/IsoSurface.h"

#include "osgRayTrace/media/VolumeSample.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kNoEdge = -1;

/// Returns the edge between two corners that differ in one coordinate.
int edgeBetween(unsigned int a, unsigned int b)
{
    const unsigned int low = a & b;
    switch (a ^ b)
    {
    case 1:
        return static_cast<int>(low >> 1);
    case 2:
        return static_cast<int>(4 + (low & 1) + (low >> 2) * 2);
    default:
        return static_cast<int>(8 + low);
    }
}

/// Returns the corners of a face in turn, counter-clockwise from outside of the cell.
std::array<unsigned int, 4> cornersOf(int axis, int side)
{
    const unsigned int b = 1u << (axis + 1) % 3, c = 1u << (axis + 2) % 3;
    const unsigned int at = side ? 1u << axis : 0u;
    if (side) return {at, at | b, at | b | c, at | c};
    return {at, at | c, at | b | c, at | b};
}

/// Returns the faces of an edge as bits 2 * axis + side.
unsigned int facesOf(int edge)
{
    const int axis = edge / 4;
    unsigned int faces = 0;
    for (int k = 0, bit = 0; k < 3; ++k)
        if (k != axis) faces |= 1u << (2 * k + (edge >> bit++ & 1));
    return faces;
}

/// Adds a fan over a loop of edges. It begins where no side of its triangles, other than those of
/// the loop, lies in a face of the cell: the cell beyond the face might have the same side.
void addFan(const std::vector<int>& loop, IsoCell& cell)
{
    const std::size_t count = loop.size();
    std::size_t first = 0;
    const auto staysWithin = [&](std::size_t start)
    {
        for (std::size_t k = 2; k + 1 < count; ++k)
            if (facesOf(loop[start]) & facesOf(loop[(start + k) % count])) return false;
        return true;
    };
    while (first < count && !staysWithin(first))
        ++first;
    auto filled = static_cast<std::size_t>(3 * cell.triangles);
    for (std::size_t k = 1; k + 1 < count; ++k)
        for (const std::size_t i : {first, first + k, first + k + 1})
            cell.edges[filled++] = static_cast<uint8_t>(loop[i % count]);
    cell.triangles += static_cast<int>(count) - 2;
}

IsoCell cellOf(unsigned int inside)
{
    // The surface leaves each face along lines from the edge at which a walk around the face comes
    // to corners that are inside, to the edge at which it leaves them.
    int next[12];
    std::fill(next, next + 12, kNoEdge);
    for (int face = 0; face < 6; ++face)
    {
        const auto corners = cornersOf(face / 2, face % 2);
        for (std::size_t i = 0; i < 4; ++i)
        {
            const unsigned int from = corners[i];
            const bool enters =
                !(inside >> from & 1u) && (inside >> corners[(i + 1) % 4] & 1u) != 0;
            if (!enters) continue;
            std::size_t last = i + 1;
            while (inside >> corners[(last + 1) % 4] & 1u)
                ++last;
            next[edgeBetween(from, corners[(i + 1) % 4])] =
                edgeBetween(corners[last % 4], corners[(last + 1) % 4]);
        }
    }
    IsoCell cell;
    for (int& begin : next)
    {
        std::vector<int> loop;
        for (int edge = static_cast<int>(&begin - next); next[edge] != kNoEdge;)
        {
            loop.push_back(edge);
            edge = std::exchange(next[edge], kNoEdge);
        }
        if (!loop.empty()) addFan(loop, cell);
    }
    return cell;
}

/// Walks over the lattice, slice by slice. Point i of an axis is the middle of voxel i - 1, so that
/// the first and the last point are beyond the image.
class Lattice
{
public:
    Lattice(const VolumeImage& image, float value, const Affine& tileFromImage)
        : _image(image),
          _size{image.width, image.height, image.depth},
          _sign(value < 0.0f ? -1.0f : 1.0f),
          _value(value),
          _tile(tileFromImage),
          _isCut(tileFromImage.linear != Mat3(1.0f) || tileFromImage.translation != Vec3(0.0f)),
          _width(static_cast<std::size_t>(image.width) + 2),
          _height(static_cast<std::size_t>(image.height) + 2)
    {
        for (int s = 0; s < 2; ++s)
        {
            _inside[s].resize(_width * _height);
            _xRows[s].resize(_height);
            _yRows[s].resize(_height);
        }
        _zRows.resize(_height);
    }

    /// Returns false if there are too many triangles.
    bool walk(std::size_t mostTriangles)
    {
        for (int z = 0; z < _size[2] + 2; ++z)
        {
            findInside(z);
            addSliceVertices(z);
            if (z == 0) continue;
            addUpwardVertices(z - 1);
            for (int y = 0; y < _size[1] + 1; ++y)
                addCells(y, z - 1);
            if (surface.triangles.size() > mostTriangles) return false;
        }
        return true;
    }

    IsoSurface surface;

private:
    /// How far a point is inside by its value; not above 0: it is outside.
    float depthAt(const int (&at)[3]) const
    {
        float v = 0.0f;
        if (_image.floats.empty())
            v = detail::valueAt(_image, _image.bytes.data(), at[0] - 1, at[1] - 1, at[2] - 1,
                                _image.channels - 1) *
                (1.0f / 255.0f);
        else
            v = detail::valueAt(_image, _image.floats.data(), at[0] - 1, at[1] - 1, at[2] - 1,
                                _image.channels - 1);
        return _sign * (v - _value);
    }

    Vec3 place(const int (&at)[3]) const
    {
        Vec3 p;
        for (int k = 0; k < 3; ++k)
            p[k] = (static_cast<float>(at[k]) - 0.5f) / static_cast<float>(_size[k]);
        return p;
    }

    bool isWithin(const int (&at)[3]) const
    {
        for (int k = 0; k < 3; ++k)
            if (at[k] < 1 || at[k] > _size[k]) return false;
        if (!_isCut) return true;
        const Vec3 p = transformPoint(_tile, place(at));
        return p.x >= 0.0f && p.x <= 1.0f && p.y >= 0.0f && p.y <= 1.0f && p.z >= 0.0f &&
               p.z <= 1.0f;
    }

    void findInside(int z)
    {
        std::vector<uint8_t>& inside = _inside[z & 1];
        std::fill(inside.begin(), inside.end(), uint8_t(0));
        if (z < 1 || z > _size[2]) return;
        for (int y = 1; y <= _size[1]; ++y)
            for (int x = 1; x <= _size[0]; ++x)
            {
                const int at[] = {x, y, z};
                inside[index(x, y)] = depthAt(at) > 0.0f && isWithin(at);
            }
    }

    std::size_t index(int x, int y) const
    {
        return static_cast<std::size_t>(y) * _width + static_cast<std::size_t>(x);
    }

    uint32_t vertexCount() const { return static_cast<uint32_t>(surface.positions.size()); }

    void addSliceVertices(int z)
    {
        const std::vector<uint8_t>& inside = _inside[z & 1];
        for (int y = 0; y < _size[1] + 2; ++y)
        {
            _xRows[z & 1][static_cast<std::size_t>(y)] = vertexCount();
            for (int x = 0; x < _size[0] + 1; ++x)
                if (inside[index(x, y)] != inside[index(x + 1, y)])
                    addVertex({x, y, z}, 0, inside[index(x, y)] != 0);
        }
        for (int y = 0; y < _size[1] + 1; ++y)
        {
            _yRows[z & 1][static_cast<std::size_t>(y)] = vertexCount();
            for (int x = 0; x < _size[0] + 2; ++x)
                if (inside[index(x, y)] != inside[index(x, y + 1)])
                    addVertex({x, y, z}, 1, inside[index(x, y)] != 0);
        }
    }

    void addUpwardVertices(int z)
    {
        const std::vector<uint8_t>&low = _inside[z & 1], &high = _inside[(z + 1) & 1];
        for (int y = 0; y < _size[1] + 2; ++y)
        {
            _zRows[static_cast<std::size_t>(y)] = vertexCount();
            for (int x = 0; x < _size[0] + 2; ++x)
                if (low[index(x, y)] != high[index(x, y)])
                    addVertex({x, y, z}, 2, low[index(x, y)] != 0);
        }
    }

    /// Adds the vertex of the edge from a point along an axis, which crosses the surface.
    void addVertex(std::array<int, 3> point, int axis, bool fromInside)
    {
        int from[] = {point[0], point[1], point[2]}, to[] = {point[0], point[1], point[2]};
        ++(fromInside ? to : from)[axis];
        const Vec3 a = place(from), b = place(to);
        const float depth = depthAt(from), beyond = depthAt(to);
        float t = beyond <= 0.0f ? depth / (depth - beyond) : 1.0f;
        bool isFace = false;
        Vec3 normal(0.0f);
        const auto meetFace = [&](float at, Vec3 outward)
        {
            if (!(at < t) && (beyond <= 0.0f || isFace)) return;
            t = std::min(at, t);
            isFace = true;
            normal = outward;
        };
        if (to[axis] < 1 || to[axis] > _size[axis])
        {
            Vec3 outward(0.0f);
            outward[axis] = b[axis] > a[axis] ? 1.0f : -1.0f;
            meetFace(0.5f, outward);
        }
        if (_isCut)
        {
            const Vec3 p = transformPoint(_tile, a), q = transformPoint(_tile, b);
            for (int k = 0; k < 3; ++k)
            {
                const Vec3 row(_tile.linear[0][k], _tile.linear[1][k], _tile.linear[2][k]);
                if (q[k] < 0.0f) meetFace(p[k] / (p[k] - q[k]), -row);
                if (q[k] > 1.0f) meetFace((1.0f - p[k]) / (q[k] - p[k]), row);
            }
        }
        // Corners keep a distance from each other: a triangle needs an area.
        constexpr float kLeast = 1e-3f;
        t = t > kLeast ? std::min(t, 1.0f - kLeast) : kLeast;
        const Vec3 p = a + (b - a) * t;
        surface.positions.push_back(p);
        surface.normals.push_back(isFace ? normal : downGradient(p));
    }

    Vec3 downGradient(Vec3 p) const
    {
        Vec3 gradient;
        for (int k = 0; k < 3; ++k)
        {
            Vec3 step(0.0f);
            step[k] = 1.0f / static_cast<float>(_size[k]);
            gradient[k] = (volumeValue(_image, p + step) - volumeValue(_image, p - step)) *
                          static_cast<float>(_size[k]);
        }
        const float largest =
            std::max(std::fabs(gradient.x), std::max(std::fabs(gradient.y), std::fabs(gradient.z)));
        if (!(largest > 0.0f) || !(largest < kInfinity)) return Vec3(0.0f);
        return gradient * (-_sign / largest);
    }

    /// Adds the triangles of a row of cells. The vertices of a row of edges were numbered in turn.
    void addCells(int y, int z)
    {
        const std::vector<uint8_t>* slices[] = {&_inside[z & 1], &_inside[(z + 1) & 1]};
        uint32_t next[12]; // vertices of the edges of a cell, if they have one
        for (int r = 0; r < 2; ++r)
        {
            const int slice = (z + r) & 1;
            const auto row = static_cast<std::size_t>(y);
            next[2 * r] = _xRows[slice][row];
            next[2 * r + 1] = _xRows[slice][row + 1];
            next[4 + 2 * r] = _yRows[slice][row];
            next[8 + 2 * r] = _zRows[row + static_cast<std::size_t>(r)];
        }
        for (int x = 0; x < _size[0] + 1; ++x)
        {
            unsigned int inside = 0;
            for (unsigned int corner = 0; corner < 8; ++corner)
                inside |=
                    unsigned((
                        *slices[corner >> 2])[index(x + int(corner & 1), y + int(corner >> 1 & 1))])
                    << corner;
            if (inside == 0 || inside == 255) continue;
            const auto crosses = [inside](unsigned int a, unsigned int b)
            { return (inside >> a & 1u) != (inside >> b & 1u) ? 1u : 0u; };
            for (unsigned int r = 0; r < 2; ++r)
            {
                next[5 + 2 * r] = next[4 + 2 * r] + crosses(4 * r, 4 * r + 2);
                next[9 + 2 * r] = next[8 + 2 * r] + crosses(2 * r, 2 * r + 4);
            }
            const IsoCell& cell = isoCell(inside);
            for (int i = 0; i < cell.triangles; ++i)
            {
                const uint8_t* edges = &cell.edges[static_cast<std::size_t>(3 * i)];
                surface.triangles.push_back({next[edges[0]], next[edges[1]], next[edges[2]]});
            }
            for (unsigned int r = 0; r < 4; ++r)
                next[r] += crosses(2 * r, 2 * r + 1);
            for (const int edge : {4, 6, 8, 10})
                next[edge] = next[edge + 1];
        }
    }

    const VolumeImage& _image;
    const int _size[3];
    const float _sign, _value;
    const Affine _tile;
    const bool _isCut; // by a box other than that of the image
    const std::size_t _width, _height;
    std::vector<uint8_t> _inside[2]; // of two slices
    // The first vertices of the rows of edges along each axis: of two slices, and between them.
    std::vector<uint32_t> _xRows[2], _yRows[2], _zRows;
};

} // namespace

const IsoCell& isoCell(unsigned int inside)
{
    static const std::array<IsoCell, 256> cells = []
    {
        std::array<IsoCell, 256> all;
        for (unsigned int i = 0; i < 256; ++i)
            all[i] = cellOf(i);
        return all;
    }();
    return cells[inside & 255u];
}

std::optional<IsoSurface> isoSurface(const VolumeImage& image, float value,
                                     const Affine& tileFromImage, std::size_t mostTriangles)
{
    Lattice lattice(image, value, tileFromImage);
    if (!lattice.walk(mostTriangles)) return std::nullopt;
    return std::move(lattice.surface);
}

} // namespace osgRayTrace::engine
