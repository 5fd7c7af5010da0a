// StatesAbove.cpp - collects the state that a scene graph inherits. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/StatesAbove.h"

#include <memory>

namespace osgRayTrace::engine
{

namespace
{

GraphState rootState(const ConversionInput& input)
{
    GraphState state;
    if (input.lighting) state.modesOn |= uint64_t(1) << kLightingBit;
    if (input.materials && input.materials->reads) state.shader = std::make_shared<ShaderState>();
    if (input.viewLight)
    {
        const int number = input.viewLight->getLightNum();
        if (number >= 0 && number < kMaskedLights)
            state.modesOn |= uint64_t(1) << number;
        else if (number >= 0 && number < kLightNumbers)
            state.moreLights = std::make_shared<LightModes>(
                LightModes{{static_cast<unsigned int>(number), osg::StateAttribute::ON}});
    }
    return state;
}

} // namespace

StateStack statesAbove(const ConversionInput& input)
{
    StateStack states(rootState(input));
    for (const osg::ref_ptr<const osg::StateSet>& stateSet : input.inheritedState)
        states.push(*stateSet);
    states.forgetMasks();
    return states;
}

} // namespace osgRayTrace::engine
