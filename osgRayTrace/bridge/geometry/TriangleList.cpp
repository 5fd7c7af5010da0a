// TriangleList.cpp - finds primitive sets with triangles, and the index that restarts strips.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/TriangleList.h"

#include "osgRayTrace/bridge/geometry/PrimitiveModes.h"

#include <osg/PrimitiveRestartIndex>

namespace osgRayTrace::engine
{

static_assert(sizeof(UVec3) == 3 * sizeof(GLuint), "index triples are packed");

PrimitiveRestart restartOf(const GraphState& state)
{
    PrimitiveRestart restart;
    restart.atLargest = state.isOn(kFixedRestartBit);
    restart.on = restart.atLargest || state.isOn(kPrimitiveRestartBit);
    const auto* index = state.attribute<osg::PrimitiveRestartIndex>(kPrimitiveRestartSlot);
    if (restart.on && index) restart.index = index->getRestartIndex();
    return restart;
}

bool hasIndices(const osg::PrimitiveSet& set)
{
    switch (set.getType())
    {
    case osg::PrimitiveSet::DrawArraysPrimitiveType:
    case osg::PrimitiveSet::DrawArrayLengthsPrimitiveType:
    case osg::PrimitiveSet::MultiDrawArraysPrimitiveType:
    case osg::PrimitiveSet::DrawElementsUBytePrimitiveType:
    case osg::PrimitiveSet::DrawElementsUShortPrimitiveType:
    case osg::PrimitiveSet::DrawElementsUIntPrimitiveType:
        return true;
    default:
        return false; // commands that are on the GPU
    }
}

bool hasTriangles(const osg::PrimitiveSet& set)
{
    return hasIndices(set) && untracedMode(set.getMode()) == nullptr;
}

const UVec3* TriangleList::data() const
{
    return source ? reinterpret_cast<const UVec3*>(&source->front()) : triangles.data();
}

std::size_t TriangleList::size() const
{
    return source ? source->size() / 3 : triangles.size();
}

} // namespace osgRayTrace::engine
