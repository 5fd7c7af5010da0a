// NodeHashes.cpp - reads nodes of each class, without a virtual call for frequent classes. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/NodeHashes.h"

#include "osgRayTrace/base/MemoryHash.h"
#include "osgRayTrace/bridge/changes/StateHash.h"
#include "osgRayTrace/bridge/graph/DrawHint.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/EnvironmentLight>
#include <osgRayTrace/MediumVolume>

#include <osg/ClipNode>
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

/// Returns the hash of an even number of doubles. Two doubles at a time are hashed independently of
/// the other pairs, which makes the function fast.
inline uint64_t hashOfDoubles(const double* values, int count)
{
    uint64_t hash = 0;
    for (int i = 0; i < count; i += 2)
    {
        uint64_t pair[2];
        std::memcpy(pair, values + i, sizeof pair);
        hash +=
            fold(pair[0] + static_cast<uint64_t>(i), pair[1]) * (2 * static_cast<uint64_t>(i) + 1);
    }
    return hash;
}

uint64_t groupHash(const osg::Group& group)
{
    uint64_t hash =
        bitsOf(group.getStateSet()) + 3 * bitsOf(group.getCullCallback()) + hintHash(group);
    for (const osg::ref_ptr<osg::Node>& child : childrenOf(group))
        hash = fold(hash, bitsOf(child.get()));
    return hash;
}

uint64_t environmentHash(const EnvironmentLight& light, KeptObjects* kept)
{
    Hasher hasher(kept);
    addImage(hasher, light.getImage());
    hasher.addObject(light.getCubeMap());
    if (light.getCubeMap()) addTexture(hasher, *light.getCubeMap());
    hasher.add(light.getRotation().asVec4(), light.getScale(), light.getVisible());
    return hasher.value();
}

} // namespace

uint64_t matrixHash(NodeKind kind, const osg::Node& node)
{
    if (kind == NodeKind::MatrixTransform)
        return hashOfDoubles(static_cast<const osg::MatrixTransform&>(node).getMatrix().ptr(), 16);
    const auto& t = static_cast<const osg::PositionAttitudeTransform&>(node);
    double values[14] = {};
    std::memcpy(values, t.getPosition().ptr(), 3 * sizeof(double));
    for (int i = 0; i < 4; ++i)
        values[3 + i] = t.getAttitude()[i];
    std::memcpy(values + 7, t.getScale().ptr(), 3 * sizeof(double));
    std::memcpy(values + 10, t.getPivotPoint().ptr(), 3 * sizeof(double));
    return hashOfDoubles(values, 14);
}

uint64_t nodeHash(NodeKind kind, const osg::Node& node)
{
    switch (kind)
    {
    case NodeKind::Group:
        return groupHash(static_cast<const osg::Group&>(node));
    case NodeKind::Switch:
    {
        uint64_t hash = groupHash(static_cast<const osg::Group&>(node));
        for (const bool on : static_cast<const osg::Switch&>(node).getValueList())
            hash = fold(hash, on ? 1 : 2);
        return hash;
    }
    case NodeKind::MatrixTransform:
    case NodeKind::PositionAttitudeTransform:
        return fold(groupHash(static_cast<const osg::Group&>(node)),
                    static_cast<const osg::Transform&>(node).getReferenceFrame());
    case NodeKind::Light:
    {
        const auto& source = static_cast<const osg::LightSource&>(node);
        return fold(groupHash(source), source.getReferenceFrame() + (source.getLight() ? 2u : 0u));
    }
    case NodeKind::Clip:
        return fold(groupHash(static_cast<const osg::Group&>(node)),
                    static_cast<const osg::ClipNode&>(node).getReferenceFrame());
    case NodeKind::AreaLight:
    case NodeKind::Environment:
        return bitsOf(node.getStateSet()) + hintHash(node);
    case NodeKind::Volume: // becomes untracked as a box
        return fold(bitsOf(node.getStateSet()) + hintHash(node),
                    static_cast<const MediumVolume&>(node).getShape() == MediumVolume::BOX);
    case NodeKind::Geometry:
    case NodeKind::Untracked:
        break;
    }
    return 0;
}

uint64_t lightHash(NodeKind kind, const osg::Node& node, KeptObjects* kept)
{
    if (kind == NodeKind::Environment)
        return environmentHash(static_cast<const EnvironmentLight&>(node), kept);
    Hasher hasher(kept);
    if (kind == NodeKind::Volume)
    {
        const auto& volume = static_cast<const MediumVolume&>(node);
        addMedium(hasher, volume.getMedium());
        hasher.add(volume.getRadius(), volume.getShape(), volume.getScaleHeight(),
                   volume.getBox()._min, volume.getBox()._max);
        return hasher.value();
    }
    if (kind == NodeKind::AreaLight)
    {
        const auto& light = static_cast<const AreaLight&>(node);
        hasher.add(light.getCorner(), light.getEdgeU(), light.getEdgeV(), light.getRadiance(),
                   light.getTwoSided());
        return hasher.value();
    }
    const osg::Light* light = static_cast<const osg::LightSource&>(node).getLight();
    hasher.addObject(light);
    if (light) addLight(hasher, *light);
    return hasher.value();
}

uint64_t clipHash(const osg::ClipNode& node, const osg::Matrixd& sceneFromPlanes)
{
    Hasher hasher;
    hasher.addMatrix(sceneFromPlanes);
    for (const osg::ref_ptr<osg::ClipPlane>& plane : node.getClipPlaneList())
        if (plane) hasher.add(plane->getClipPlaneNum(), plane->getClipPlane());
    return hasher.value();
}

uint64_t arraysHash(const osg::Geometry& geometry, bool attributes)
{
    uint64_t hash = 0;
    forEachBuffer(geometry, attributes,
                  [&hash](const osg::BufferData* data, bool) { hash = fold(hash, bitsOf(data)); });
    return hash;
}

uint64_t conversionHash(const osg::Geometry& geometry)
{
    return fold((geometry.getDrawCallback() ? 256u : 0u) + hintHash(geometry),
                geometry.getDataVariance());
}

uint8_t hintHash(const osg::Node& node)
{
    return node.getUserDataContainer() ? static_cast<uint8_t>(ownHint(node)) : uint8_t(0);
}

} // namespace osgRayTrace::engine
