// SceneIndex.cpp - how state decides on the treatment of a surface. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/SceneIndex.h"

#include "osgRayTrace/bridge/appearance/materials/MaterialConverter.h"
#include "osgRayTrace/bridge/common/ClipPlanes.h"
#include "osgRayTrace/bridge/geometry/TriangleList.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"

#include <osg/LightModel>

#include <algorithm>
#include <tuple>

namespace osgRayTrace::engine
{

bool Treatment::operator==(const Treatment& other) const
{
    const auto values = [](const Treatment& t)
    {
        return std::tie(t.rasterized, t.restart, t.lift, t.physical, t.setsColor, t.clipPlanes,
                        t.hasAmbient, t.ambient, t.counts);
    };
    return values(*this) == values(other);
}

Treatment treatmentOf(const GraphState& state, const TextureConverter& textures)
{
    Treatment treatment;
    treatment.rasterized = rasterizedState(state, textures, nullptr);
    treatment.restart = restartOf(state).key();
    treatment.lift = polygonLift(state);
    treatment.physical = state.attributes[kPhysicalMaterialSlot] != nullptr;
    treatment.setsColor = setsCurrentColor(state);
    treatment.clipPlanes = clipPlanesOn(state);
    const auto* model = state.attribute<osg::LightModel>(kLightModelSlot);
    treatment.hasAmbient = model && state.isOn(kLightingBit);
    if (treatment.hasAmbient)
    {
        const osg::Vec4& color = model->getAmbientIntensity();
        treatment.ambient = Vec3(color.r(), color.g(), color.b());
    }
    return treatment;
}

uint32_t SceneIndex::treatment(const Treatment& treatment)
{
    const auto found = std::find(treatments.begin(), treatments.end(), treatment);
    const auto index = static_cast<uint32_t>(found - treatments.begin());
    if (found == treatments.end()) treatments.push_back(treatment);
    return index;
}

} // namespace osgRayTrace::engine
