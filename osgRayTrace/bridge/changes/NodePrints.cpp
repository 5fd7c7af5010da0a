// NodePrints.cpp - what is read of each class, without a virtual call where many nodes are of it.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/NodePrints.h"

#include "osgRayTrace/bridge/changes/StateFingerprint.h"
#include "osgRayTrace/bridge/common/ContentHash.h"
#include "osgRayTrace/bridge/graph/DrawHint.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"

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

uint64_t groupPrint(const osg::Group& group)
{
    uint64_t print = bitsOf(group.getStateSet()) + hintPrint(group);
    for (const osg::ref_ptr<osg::Node>& child : childrenOf(group))
        print = fold(print, bitsOf(child.get()));
    return print;
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

} // namespace osgRayTrace::engine
