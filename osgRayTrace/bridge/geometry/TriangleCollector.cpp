// TriangleCollector.cpp - reads primitive sets of all modes and index types. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/TriangleCollector.h"

#include "osgRayTrace/bridge/geometry/PointSolids.h"
#include "osgRayTrace/bridge/geometry/PolygonCutter.h"
#include "osgRayTrace/bridge/geometry/PrimitiveModes.h"

#include <algorithm>
#include <limits>

namespace osgRayTrace::engine
{

namespace
{

class TriangleCollector
{
public:
    TriangleCollector(TriangleList& list, const osg::Geometry& geometry, std::size_t vertexCount,
                      const PrimitiveRestart& restart, const ListContents& contents)
        : _list(list),
          _vertexCount(vertexCount),
          _restart(restart),
          _numbered(contents.numbered),
          _solids(contents.solids),
          _polygons(geometry, vertexCount)
    {
    }

    void append(const osg::PrimitiveSet& set, unsigned int number)
    {
        _primitiveSet = number;
        const bool solids = _solids && hasSolids(set);
        if (const char* reason = solids ? nullptr : untracedMode(set.getMode()))
        {
            ++_list.counts[reason];
            if (_numbered) _primitives += PrimitiveCounter(set).count();
            return;
        }
        if (set.getNumInstances() > 1) ++_list.counts["approximated.instanced-draw"];
        if (appendArrays(set) || appendElements(set)) return;
        ++_list.counts["not-traced.indirect-draw"];
        if (_numbered) _primitives += PrimitiveCounter(set).count();
    }

private:
    bool appendArrays(const osg::PrimitiveSet& set)
    {
        const GLenum mode = set.getMode();
        if (const auto* arrays = dynamic_cast<const osg::DrawArrays*>(&set))
        {
            appendRange(mode, arrays->getFirst(), arrays->getCount());
            return true;
        }
        if (const auto* lengths = dynamic_cast<const osg::DrawArrayLengths*>(&set))
        {
            int64_t first = lengths->getFirst();
            for (const GLsizei length : *lengths)
            {
                appendRange(mode, first, length);
                first += std::max(length, 0);
            }
            return true;
        }
        if (const auto* multi = dynamic_cast<const osg::MultiDrawArrays*>(&set))
        {
            const std::size_t draws =
                std::min(multi->getFirsts().size(), multi->getCounts().size());
            for (std::size_t i = 0; i < draws; ++i)
                appendRange(mode, multi->getFirsts()[i], multi->getCounts()[i]);
            return true;
        }
        return false;
    }

    bool appendElements(const osg::PrimitiveSet& set)
    {
        return appendIndices<osg::DrawElementsUInt>(set) ||
               appendIndices<osg::DrawElementsUShort>(set) ||
               appendIndices<osg::DrawElementsUByte>(set);
    }

    /// Appends the triangles of a range, cut to the vertices that exist: a wrong count must not
    /// make a list of billions.
    void appendRange(GLenum mode, int64_t first, int64_t count)
    {
        const auto end = static_cast<int64_t>(_vertexCount);
        const int64_t wanted = std::max<int64_t>(count, 0);
        const int64_t usable = first < 0 ? 0 : std::clamp<int64_t>(end - first, 0, wanted);
        if (usable < wanted && isPointOrLine(mode))
            _list.counts["skipped.point-or-line"] +=
                PrimitiveCounter::countOf(mode, wanted) - PrimitiveCounter::countOf(mode, usable);
        else if (usable < wanted)
            _list.counts["skipped.index-out-of-range"] +=
                triangleCount(mode, wanted) - triangleCount(mode, usable);
        appendPrimitives(mode, usable,
                         [first](std::size_t i) { return static_cast<uint32_t>(first + i); });
    }

    template <class Elements> bool appendIndices(const osg::PrimitiveSet& set)
    {
        const auto* elements = dynamic_cast<const Elements*>(&set);
        if (!elements) return false;
        if (elements->empty()) return true;
        const auto* index = &elements->front();
        using Index = typename Elements::value_type;
        const uint32_t end =
            _restart.atLargest ? std::numeric_limits<Index>::max() : _restart.index;
        const std::size_t size = elements->size();
        for (std::size_t first = 0; first <= size;)
        {
            const auto* last = index + size;
            if (_restart.on)
                last = std::find_if(index + first, last, [end](Index i) { return i == end; });
            const auto* run = index + first;
            appendPrimitives(set.getMode(), static_cast<std::size_t>(last - run),
                             [run](std::size_t i) { return static_cast<uint32_t>(run[i]); });
            first = static_cast<std::size_t>(last - index) + 1;
        }
        return true;
    }

    template <class Index> void appendPrimitives(GLenum mode, std::size_t count, const Index& index)
    {
        if (isPointOrLine(mode)) return appendSolids(mode, count, index);
        grow(triangleCount(mode, count));
        if (mode != GL_POLYGON || !_polygons.append(count, index, _list.triangles))
            appendTriangles(mode, count, index, _list.triangles);
        if (_numbered) number(mode, count);
    }

    /// Appends points and line segments, numbered one by one.
    template <class Index> void appendSolids(GLenum mode, std::size_t count, const Index& index)
    {
        const bool points = mode == GL_POINTS;
        const std::size_t solids = PrimitiveCounter::countOf(mode, count);
        const std::size_t step = mode == GL_LINES ? 2 : 1;
        for (std::size_t i = 0; i < solids; ++i, ++_primitives)
        {
            // The last segment of a loop leads back, unless it would be the first one again.
            const std::size_t from = i * step, to = points ? from : (from + 1) % count;
            if (mode == GL_LINE_LOOP && (count < 2 || (count == 2 && i == 1))) continue;
            _list.solids.push_back({index(from), index(to), points, _primitiveSet, _primitives});
        }
    }

    /// Numbers the triangles that were appended last, which are all of count vertices.
    void number(GLenum mode, std::size_t count)
    {
        const uint32_t triangles = mode == GL_QUADS || mode == GL_QUAD_STRIP ? 2 : 1;
        for (uint32_t i = 0; _list.primitives.size() < _list.triangles.size(); ++i)
            _list.primitives.push_back(_primitives + i / triangles);
        _primitives += static_cast<uint32_t>(PrimitiveCounter::countOf(mode, count));
    }

    /// Reserves exactly as much as a single set needs; for many small sets the memory doubles, as a
    /// vector's does by itself.
    void grow(std::size_t more)
    {
        std::vector<UVec3>& triangles = _list.triangles;
        const std::size_t needed = triangles.size() + more;
        if (needed <= triangles.capacity()) return;
        triangles.reserve(triangles.empty() ? needed : std::max(needed, 2 * triangles.capacity()));
    }

    TriangleList& _list;
    std::size_t _vertexCount;
    const PrimitiveRestart& _restart;
    const bool _numbered;
    const bool _solids;
    unsigned int _primitiveSet = 0;
    uint32_t _primitives = 0; // number of primitives so far
    PolygonCutter _polygons;
};

const osg::DrawElementsUInt* soleTriangleList(const osg::Geometry& geometry,
                                              const PrimitiveRestart& restart)
{
    if (restart.on) return nullptr;
    if (geometry.getNumPrimitiveSets() != 1) return nullptr;
    const auto* elements = dynamic_cast<const osg::DrawElementsUInt*>(geometry.getPrimitiveSet(0));
    if (!elements || elements->getMode() != GL_TRIANGLES || elements->size() < 3) return nullptr;
    return elements->getNumInstances() > 1 ? nullptr : elements;
}

} // namespace

TriangleList trianglesOf(const osg::Geometry& geometry, std::size_t vertexCount,
                         const PrimitiveRestart& restart, const ListContents& contents)
{
    TriangleList list;
    if (!contents.numbered) list.source = soleTriangleList(geometry, restart);
    if (list.source)
    {
        list.setEnds = {list.size()};
        return list;
    }
    TriangleCollector collector(list, geometry, vertexCount, restart, contents);
    for (unsigned int i = 0; i < geometry.getNumPrimitiveSets(); ++i)
    {
        if (const osg::PrimitiveSet* set = geometry.getPrimitiveSet(i)) collector.append(*set, i);
        list.setEnds.push_back(list.triangles.size());
    }
    return list;
}

} // namespace osgRayTrace::engine
