// SceneIndex.h - which part of a Scene each path to a geometry has become. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/scene/Scene.h"

#include <osg/Geometry>

#include <optional>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

/// What of a use's state decides on more than its material.
struct StateEffects
{
    const char* rasterized = nullptr; ///< see rasterizedState
    uint64_t restart = 0;
    float depthBias = 0.0f;
    bool physical = false;
    bool setsColor = false;  ///< see setsCurrentColor
    uint64_t clipPlanes = 0; ///< that are on, see clipPlanesOn
    bool hasAmbient = false; ///< a light model of its own, lit
    Vec3 ambient{0.0f};
    ConversionCounts counts; ///< of its material

    bool operator==(const StateEffects& other) const;
};

/// textures: as in rasterizedState.
StateEffects stateEffectsOf(const GraphState& state, const TextureConverter& textures);

struct TracedUse
{
    uint32_t instance = kInvalid; ///< kInvalid: nothing of it is traced
    uint32_t effects = kInvalid;  ///< kInvalid: OSG draws it
};

struct TracedGeometry
{
    osg::ref_ptr<const osg::Geometry> geometry; ///< its key in SceneIndex::geometries
    std::vector<TracedUse> uses;                ///< in the order of the traversal
    bool patchable = true; ///< false: made where it is, as raised faces are, or not watched
    bool plain = true;     ///< nothing of it is counted but that it was converted
};

/// Uses are added, changed and removed by the functions below alone, which count.
struct SceneIndex
{
    std::unordered_map<const osg::Geometry*, TracedGeometry> geometries;
    std::vector<StateEffects> stateEffects; ///< all different

    /// A new entry if there is none.
    TracedGeometry& at(const osg::Geometry& geometry)
    {
        TracedGeometry& traced = geometries[&geometry];
        traced.geometry = &geometry;
        return traced;
    }

    uint32_t effects(const StateEffects& effects);

    void addUse(TracedGeometry& traced, const TracedUse& use, std::size_t before);
    void removeUse(TracedGeometry& traced, std::size_t use);
    void removeUses(TracedGeometry& traced);
    void setEffects(TracedUse& use, uint32_t effects);

    /// Uses whose state makes another colour current: see MaterialRules.
    std::size_t colorUses() const { return _colorUses; }

private:
    bool setsColor(const TracedUse& use) const
    {
        return use.effects != kInvalid && stateEffects[use.effects].setsColor;
    }

    std::size_t _colorUses = 0;
};

} // namespace osgRayTrace::engine
