// BufferHashes.cpp - reads arrays and primitive sets of each class. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/BufferHashes.h"

#include "osgRayTrace/base/MemoryHash.h"
#include "osgRayTrace/bridge/geometry/TriangleList.h"

#include <typeinfo>

namespace osgRayTrace::engine
{

namespace
{

uint64_t valueHash(unsigned int modified, std::size_t count, const void* data, unsigned int kind)
{
    return fold(modified | uint64_t(count) << 32, bitsOf(data) ^ uint64_t(kind) << 8);
}

template <class Array> uint64_t arrayHash(const osg::BufferData& data)
{
    const auto& array = static_cast<const Array&>(data);
    return valueHash(array.getModifiedCount(), array.size(), array.asVector().data(),
                     static_cast<unsigned int>(array.getBinding()));
}

template <class Elements> uint64_t elementsHash(const osg::BufferData& data)
{
    const auto& set = static_cast<const Elements&>(data);
    return valueHash(set.getModifiedCount(), set.size(), set.asVector().data(), set.getMode());
}

/// Holds the values that buffers of all classes have.
struct BufferLayout
{
    std::size_t count = 0;
    unsigned int kind = 0; ///< binding of an array, mode of a primitive set
    uint64_t ranges = 0;   ///< see rangesHash
};

BufferLayout layoutOf(const osg::BufferData& data)
{
    BufferLayout layout;
    if (const osg::Array* array = data.asArray())
    {
        layout.count = array->getNumElements();
        layout.kind = static_cast<unsigned int>(array->getBinding());
    }
    else if (const osg::PrimitiveSet* set = data.asPrimitiveSet())
    {
        // Sets without triangles may lack the indices that they count.
        if (hasTriangles(*set)) layout.count = set->getNumIndices();
        layout.kind = set->getMode();
        layout.ranges = rangesHash(*set);
    }
    return layout;
}

uint64_t otherHash(const osg::BufferData& data)
{
    const BufferLayout layout = layoutOf(data);
    return valueHash(data.getModifiedCount(), layout.count, data.getDataPointer(), layout.kind) +
           layout.ranges;
}

} // namespace

BufferKind bufferKindOf(const osg::BufferData& data)
{
    const std::type_info& type = typeid(data);
    if (type == typeid(osg::Vec2Array)) return BufferKind::Vec2Array;
    if (type == typeid(osg::Vec3Array)) return BufferKind::Vec3Array;
    if (type == typeid(osg::Vec4Array)) return BufferKind::Vec4Array;
    if (type == typeid(osg::Vec4ubArray)) return BufferKind::Vec4ubArray;
    if (type == typeid(osg::DrawElementsUInt)) return BufferKind::UIntElements;
    if (type == typeid(osg::DrawElementsUShort)) return BufferKind::UShortElements;
    if (type == typeid(osg::DrawArrays)) return BufferKind::Arrays;
    return BufferKind::Other;
}

uint64_t rangesHash(const osg::PrimitiveSet& set)
{
    if (const auto* arrays = dynamic_cast<const osg::DrawArrays*>(&set))
        return fold(static_cast<uint32_t>(arrays->getFirst()),
                    static_cast<uint32_t>(arrays->getCount()));
    if (const auto* lengths = dynamic_cast<const osg::DrawArrayLengths*>(&set))
        return fold(static_cast<uint32_t>(lengths->getFirst()), 1);
    const auto* several = dynamic_cast<const osg::MultiDrawArrays*>(&set);
    uint64_t hash = 0;
    if (!several) return hash;
    for (const GLint first : several->getFirsts())
        hash = fold(hash, static_cast<uint32_t>(first));
    for (const GLsizei count : several->getCounts())
        hash = fold(hash + 1, static_cast<uint32_t>(count));
    return hash;
}

uint64_t contentsHash(const osg::BufferData& data)
{
    const BufferLayout layout = layoutOf(data);
    const void* const values = data.getDataPointer();
    const uint64_t hash = values ? memoryHash(values, data.getTotalDataSize()) : 0;
    return fold(hash, uint64_t(layout.count) << 32 ^ layout.kind) + layout.ranges;
}

uint64_t bufferHash(BufferKind kind, const osg::BufferData& data)
{
    switch (kind)
    {
    case BufferKind::Vec2Array:
        return arrayHash<osg::Vec2Array>(data);
    case BufferKind::Vec3Array:
        return arrayHash<osg::Vec3Array>(data);
    case BufferKind::Vec4Array:
        return arrayHash<osg::Vec4Array>(data);
    case BufferKind::Vec4ubArray:
        return arrayHash<osg::Vec4ubArray>(data);
    case BufferKind::UIntElements:
        return elementsHash<osg::DrawElementsUInt>(data);
    case BufferKind::UShortElements:
        return elementsHash<osg::DrawElementsUShort>(data);
    case BufferKind::Arrays:
    {
        // SetFirst of the class does not call dirty().
        const auto& set = static_cast<const osg::DrawArrays&>(data);
        return valueHash(set.getModifiedCount() ^ static_cast<unsigned int>(set.getCount()) << 16,
                         static_cast<std::size_t>(uint32_t(set.getFirst())),
                         reinterpret_cast<const void*>(uintptr_t(uint32_t(set.getCount()))),
                         set.getMode());
    }
    case BufferKind::Other:
        break;
    }
    return otherHash(data);
}

} // namespace osgRayTrace::engine
