// NodePrints.cpp - what is read of each class, without a virtual call where many nodes are of it.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/NodePrints.h"

#include "osgRayTrace/bridge/BufferContents.h"
#include "osgRayTrace/bridge/DrawHint.h"
#include "osgRayTrace/bridge/StateFingerprint.h"
#include "osgRayTrace/bridge/TriangleList.h"
#include "osgRayTrace/bridge/UntracedParts.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/EnvironmentLight>

#include <osg/Geode>
#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osg/PositionAttitudeTransform>
#include <osg/ShapeDrawable>
#include <osg/Switch>

#include <cstring>
#include <typeinfo>

namespace osgRayTrace::engine
{

namespace
{

/// Mixes two numbers into one: both halves of their product.
inline uint64_t fold(uint64_t a, uint64_t b)
{
    const auto product =
        static_cast<unsigned __int128>(a ^ 0x9e3779b97f4a7c15u) * (b ^ 0xbf58476d1ce4e5b9u);
    return static_cast<uint64_t>(product) ^ static_cast<uint64_t>(product >> 64);
}

inline uint64_t bitsOf(const void* pointer)
{
    return reinterpret_cast<uintptr_t>(pointer);
}

/// Of an even number of doubles, two at a time and each pair apart from the others, which makes it
/// fast.
inline uint64_t printOfDoubles(const double* values, int count)
{
    uint64_t print = 0;
    for (int i = 0; i < count; i += 2)
    {
        uint64_t pair[2];
        std::memcpy(pair, values + i, sizeof pair);
        print +=
            fold(pair[0] + static_cast<uint64_t>(i), pair[1]) * (2 * static_cast<uint64_t>(i) + 1);
    }
    return print;
}

/// The library's own decorator: a plain group for this traversal.
bool isDecorator(const osg::Node& node)
{
    return isFrom(&node, "osgRayTrace") && std::strcmp(node.className(), "RayTracedScene") == 0;
}

struct GroupChildren : osg::Group
{
    static const osg::NodeList& of(const osg::Group& group)
    {
        return group.*(&GroupChildren::_children);
    }
};

uint64_t groupPrint(const osg::Group& group)
{
    uint64_t print = bitsOf(group.getStateSet()) + hintPrint(group);
    for (const osg::ref_ptr<osg::Node>& child : childrenOf(group))
        print = fold(print, bitsOf(child.get()));
    return print;
}

uint64_t valuePrint(unsigned int modified, std::size_t count, const void* data, unsigned int kind)
{
    return fold(modified | uint64_t(count) << 32, bitsOf(data) ^ uint64_t(kind) << 8);
}

template <class Array> uint64_t arrayPrint(const osg::BufferData& data)
{
    const auto& array = static_cast<const Array&>(data);
    return valuePrint(array.getModifiedCount(), array.size(), array.asVector().data(),
                      static_cast<unsigned int>(array.getBinding()));
}

template <class Elements> uint64_t elementsPrint(const osg::BufferData& data)
{
    const auto& set = static_cast<const Elements&>(data);
    return valuePrint(set.getModifiedCount(), set.size(), set.asVector().data(), set.getMode());
}

/// What buffers of all classes have.
struct BufferLayout
{
    std::size_t count = 0;
    unsigned int kind = 0; ///< binding of an array, mode of a primitive set
    uint64_t ranges = 0;   ///< see rangesPrint
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
        if (hasTriangles(*set))
            layout.count = set->getNumIndices(); // others may lack what they count
        layout.kind = set->getMode();
        layout.ranges = rangesPrint(*set);
    }
    return layout;
}

uint64_t otherPrint(const osg::BufferData& data)
{
    const BufferLayout layout = layoutOf(data);
    return valuePrint(data.getModifiedCount(), layout.count, data.getDataPointer(), layout.kind) +
           layout.ranges;
}

uint64_t environmentPrint(const EnvironmentLight& light, KeptObjects* kept)
{
    Digest digest(kept);
    addImage(digest, light.getImage());
    digest.addObject(light.getCubeMap());
    if (light.getCubeMap()) addTexture(digest, *light.getCubeMap());
    digest.add(light.getRotation().asVec4(), light.getScale(), light.getVisible());
    return digest.value();
}

} // namespace

NodeKind kindOf(const osg::Node& node)
{
    const std::type_info& type = typeid(node);
    if (type == typeid(osg::Geometry) || type == typeid(osg::ShapeDrawable))
        return NodeKind::Geometry;
    const osg::Transform* transform = node.asTransform();
    if (transform && transform->getReferenceFrame() != osg::Transform::RELATIVE_RF)
        return NodeKind::Opaque; // where it is depends on the view
    if (type == typeid(osg::MatrixTransform)) return NodeKind::MatrixTransform;
    if (type == typeid(osg::PositionAttitudeTransform)) return NodeKind::PositionAttitudeTransform;
    if (type == typeid(osg::Group) || type == typeid(osg::Geode)) return NodeKind::Group;
    if (type == typeid(osg::Switch)) return NodeKind::Switch;
    if (type == typeid(osg::LightSource)) return NodeKind::Light;
    if (type == typeid(AreaLight)) return NodeKind::AreaLight;
    if (type == typeid(EnvironmentLight)) return NodeKind::Environment;
    return isDecorator(node) ? NodeKind::Group : NodeKind::Opaque;
}

const osg::NodeList& childrenOf(const osg::Group& group)
{
    return GroupChildren::of(group);
}

bool isOn(NodeKind kind, const osg::Group& group, unsigned int child)
{
    return kind != NodeKind::Switch || static_cast<const osg::Switch&>(group).getValue(child);
}

uint64_t matrixPrint(NodeKind kind, const osg::Node& node)
{
    if (kind == NodeKind::MatrixTransform)
        return printOfDoubles(static_cast<const osg::MatrixTransform&>(node).getMatrix().ptr(), 16);
    const auto& t = static_cast<const osg::PositionAttitudeTransform&>(node);
    double values[14] = {};
    std::memcpy(values, t.getPosition().ptr(), 3 * sizeof(double));
    for (int i = 0; i < 4; ++i)
        values[3 + i] = t.getAttitude()[i];
    std::memcpy(values + 7, t.getScale().ptr(), 3 * sizeof(double));
    std::memcpy(values + 10, t.getPivotPoint().ptr(), 3 * sizeof(double));
    return printOfDoubles(values, 14);
}

uint64_t nodePrint(NodeKind kind, const osg::Node& node)
{
    switch (kind)
    {
    case NodeKind::Group:
        return groupPrint(static_cast<const osg::Group&>(node));
    case NodeKind::Switch:
    {
        uint64_t print = groupPrint(static_cast<const osg::Group&>(node));
        for (const bool on : static_cast<const osg::Switch&>(node).getValueList())
            print = fold(print, on ? 1 : 2);
        return print;
    }
    case NodeKind::MatrixTransform:
    case NodeKind::PositionAttitudeTransform:
        return fold(groupPrint(static_cast<const osg::Group&>(node)),
                    static_cast<const osg::Transform&>(node).getReferenceFrame());
    case NodeKind::Light:
    {
        const auto& source = static_cast<const osg::LightSource&>(node);
        return fold(groupPrint(source), source.getReferenceFrame() + (source.getLight() ? 2u : 0u));
    }
    case NodeKind::AreaLight:
    case NodeKind::Environment:
        return bitsOf(node.getStateSet()) + hintPrint(node);
    case NodeKind::Geometry:
    case NodeKind::Opaque:
        break;
    }
    return 0;
}

uint64_t lightPrint(NodeKind kind, const osg::Node& node, KeptObjects* kept)
{
    if (kind == NodeKind::Environment)
        return environmentPrint(static_cast<const EnvironmentLight&>(node), kept);
    Digest digest(kept);
    if (kind == NodeKind::AreaLight)
    {
        const auto& light = static_cast<const AreaLight&>(node);
        digest.add(light.getCorner(), light.getEdgeU(), light.getEdgeV(), light.getRadiance(),
                   light.getTwoSided());
        return digest.value();
    }
    const osg::Light* light = static_cast<const osg::LightSource&>(node).getLight();
    digest.addObject(light);
    if (light) addLight(digest, *light);
    return digest.value();
}

uint64_t arraysPrint(const osg::Geometry& geometry)
{
    uint64_t print = 0;
    forEachBuffer(geometry, [&print](const osg::BufferData* data, bool)
                  { print = fold(print, bitsOf(data)); });
    return print;
}

uint64_t treatmentPrint(const osg::Geometry& geometry)
{
    return fold((geometry.getDrawCallback() ? 256u : 0u) + hintPrint(geometry),
                geometry.getDataVariance());
}

uint8_t hintPrint(const osg::Node& node)
{
    return node.getUserDataContainer() ? static_cast<uint8_t>(ownHint(node)) : uint8_t(0);
}

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

uint64_t rangesPrint(const osg::PrimitiveSet& set)
{
    if (const auto* arrays = dynamic_cast<const osg::DrawArrays*>(&set))
        return fold(static_cast<uint32_t>(arrays->getFirst()),
                    static_cast<uint32_t>(arrays->getCount()));
    if (const auto* lengths = dynamic_cast<const osg::DrawArrayLengths*>(&set))
        return fold(static_cast<uint32_t>(lengths->getFirst()), 1);
    const auto* several = dynamic_cast<const osg::MultiDrawArrays*>(&set);
    uint64_t print = 0;
    if (!several) return print;
    for (const GLint first : several->getFirsts())
        print = fold(print, static_cast<uint32_t>(first));
    for (const GLsizei count : several->getCounts())
        print = fold(print + 1, static_cast<uint32_t>(count));
    return print;
}

uint64_t contentsPrint(const osg::BufferData& data)
{
    const BufferLayout layout = layoutOf(data);
    const void* const values = data.getDataPointer();
    const uint64_t hash = values ? contentHash(values, data.getTotalDataSize()) : 0;
    return fold(hash, uint64_t(layout.count) << 32 ^ layout.kind) + layout.ranges;
}

uint64_t bufferPrint(BufferKind kind, const osg::BufferData& data)
{
    switch (kind)
    {
    case BufferKind::Vec2Array:
        return arrayPrint<osg::Vec2Array>(data);
    case BufferKind::Vec3Array:
        return arrayPrint<osg::Vec3Array>(data);
    case BufferKind::Vec4Array:
        return arrayPrint<osg::Vec4Array>(data);
    case BufferKind::Vec4ubArray:
        return arrayPrint<osg::Vec4ubArray>(data);
    case BufferKind::UIntElements:
        return elementsPrint<osg::DrawElementsUInt>(data);
    case BufferKind::UShortElements:
        return elementsPrint<osg::DrawElementsUShort>(data);
    case BufferKind::Arrays:
    {
        const auto& set =
            static_cast<const osg::DrawArrays&>(data); // whose setFirst has no dirty()
        return valuePrint(set.getModifiedCount() ^ static_cast<unsigned int>(set.getCount()) << 16,
                          static_cast<std::size_t>(uint32_t(set.getFirst())),
                          reinterpret_cast<const void*>(uintptr_t(uint32_t(set.getCount()))),
                          set.getMode());
    }
    case BufferKind::Other:
        break;
    }
    return otherPrint(data);
}

} // namespace osgRayTrace::engine
