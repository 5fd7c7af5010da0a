// SceneConverter.h - from an OpenSceneGraph scene graph to a Scene of the engine. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"

#include <osgRayTrace/RayTraceSettings>

#include <osg/Light>
#include <osg/Node>
#include <osg/Vec3d>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace osgRayTrace::engine
{

/// What to convert a graph for.
struct ConversionInput
{
    osg::Node* root = nullptr;
    osg::Vec3d eye;                      ///< world space: levels of detail, and where the origin is put
    osg::Vec3d origin;                   ///< of the engine's coordinates, world space
    unsigned int traversalMask = 0xffffffffu;
    /// The light that osgViewer adds outside of the graph; null: none. In view space (headlight) or world
    /// space (sky light). Replaced by a light of the same number in the graph.
    osg::ref_ptr<const osg::Light> viewLight;
    bool viewLightInEyeSpace = true;
    osg::Vec4 clearColor{0.2f, 0.2f, 0.4f, 1.0f}; ///< as shown
    RayTraceSettings::ColorRule colorRule = RayTraceSettings::AUTOMATIC_COLOR;
};

/// Counts by "<class>.<reason>" as Statistics::conversion shows them.
using ConversionCounts = std::map<std::string, uint64_t>;

struct ConversionResult
{
    std::shared_ptr<const Scene> scene; ///< never null
    ConversionCounts counts;
    double seconds = 0.0;
};

/// Keeps what it needs to share unchanged parts between snapshots. Used by one thread at a time.
class SceneConverter
{
public:
    SceneConverter();
    ~SceneConverter();

    /// Converts the graph as it is now. The graph is read, not changed (bounds may be computed). Warns
    /// once an object through osg::notify. Bad data is skipped and counted; throws std::bad_alloc only.
    ConversionResult convert(const ConversionInput& input);

private:
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace osgRayTrace::engine
