// SceneIndex.cpp - finds the effects of state beyond the material of a surface. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/SceneIndex.h"

#include "osgRayTrace/bridge/appearance/materials/MaterialConverter.h"
#include "osgRayTrace/bridge/appearance/materials/PhysicalConversion.h"
#include "osgRayTrace/bridge/appearance/materials/SurfaceState.h"
#include "osgRayTrace/bridge/common/ClipPlanes.h"
#include "osgRayTrace/bridge/geometry/TriangleList.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"

#include <osg/LightModel>

#include <algorithm>
#include <tuple>
#include <unordered_set>
#include <utility>

namespace osgRayTrace::engine
{

bool StateEffects::operator==(const StateEffects& other) const
{
    const auto values = [](const StateEffects& t)
    {
        return std::tie(t.rasterized, t.proxied, t.restart, t.depthBias, t.physical, t.setsColor,
                        t.clipPlanes, t.hasAmbient, t.ambient, t.uvSets, t.counts);
    };
    return values(*this) == values(other);
}

StateEffects stateEffectsOf(const GraphState& state, const TextureConverter& textures)
{
    StateEffects effects;
    effects.rasterized = rasterizedState(state, textures, nullptr);
    effects.restart = restartOf(state).key();
    effects.depthBias = depthBias(state);
    effects.physical = state.attributes[kPhysicalMaterialSlot] != nullptr;
    effects.uvSets = moreUvSetsOf(state);
    effects.setsColor = setsCurrentColor(state);
    effects.clipPlanes = clipPlanesOn(state);
    const auto* model = state.attribute<osg::LightModel>(kLightModelSlot);
    effects.hasAmbient = model && state.isOn(kLightingBit);
    if (effects.hasAmbient)
    {
        const osg::Vec4& color = model->getAmbientIntensity();
        effects.ambient = Vec3(color.r(), color.g(), color.b());
    }
    return effects;
}

uint32_t SceneIndex::effects(const StateEffects& effects)
{
    const auto found = std::find(stateEffects.begin(), stateEffects.end(), effects);
    const auto index = static_cast<uint32_t>(found - stateEffects.begin());
    if (found == stateEffects.end()) stateEffects.push_back(effects);
    return index;
}

uint32_t SceneIndex::leftEffects(const LeftState& left)
{
    StateEffects known;
    known.rasterized = left.reason;
    known.proxied = left.proxied;
    return effects(known);
}

void SceneIndex::addUse(TracedGeometry& traced, const TracedUse& use, std::size_t before)
{
    traced.uses.insert(traced.uses.begin() + static_cast<std::ptrdiff_t>(before), use);
    _colorUses += setsColor(use);
}

void SceneIndex::removeUse(TracedGeometry& traced, std::size_t use)
{
    _colorUses -= setsColor(traced.uses[use]);
    traced.uses.erase(traced.uses.begin() + static_cast<std::ptrdiff_t>(use));
}

void SceneIndex::removeUses(TracedGeometry& traced)
{
    for (const TracedUse& use : traced.uses)
        _colorUses -= setsColor(use);
    traced.uses.clear();
}

void SceneIndex::setEffects(TracedUse& use, uint32_t effects)
{
    _colorUses -= setsColor(use);
    use.effects = effects;
    _colorUses += setsColor(use);
}

bool SceneIndex::isFollowedInCull(const osg::Geometry& geometry, bool complete) const
{
    const auto found = geometries.find(&geometry);
    if (found == geometries.end() || !found->second.culled) return false;
    const std::vector<TracedUse>& uses = found->second.uses;
    return complete || std::all_of(uses.begin(), uses.end(),
                                   [](const TracedUse& use) { return use.effects == kInvalid; });
}

bool SceneIndex::isLeft(const osg::Geometry& geometry) const
{
    const auto found = geometries.find(&geometry);
    return found != geometries.end() &&
           std::all_of(found->second.uses.begin(), found->second.uses.end(),
                       [](const TracedUse& use)
                       { return use.instance == kInvalid && use.effects == kInvalid; });
}

void SceneIndex::addUntraced(const RasterizedParts& parts,
                             const std::vector<const osg::Geometry*>& more)
{
    std::vector<std::pair<const osg::Geometry*, uint32_t>> untraced;
    std::unordered_set<const osg::Geometry*> unordered; // more is in no order with parts
    for (const osg::Geometry* geometry : more)
    {
        if (geometries.count(geometry)) continue;
        untraced.emplace_back(geometry, kInvalid);
        unordered.insert(geometry);
    }
    for (const RasterizedPart& part : parts)
    {
        const osg::Geometry* geometry =
            part.path.empty() ? nullptr : part.path.back()->asGeometry();
        if (!geometry || part.kind != RasterizedPart::Draw || geometries.count(geometry)) continue;
        const bool known = part.left && !unordered.count(geometry);
        untraced.emplace_back(geometry, known ? leftEffects(*part.left) : kInvalid);
    }
    for (const auto& [geometry, left] : untraced)
        at(*geometry).uses.push_back({kInvalid, kInvalid, left});
}

} // namespace osgRayTrace::engine
