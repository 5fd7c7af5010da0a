// StateStackTest.cpp - state is inherited as osg::State does it, for any nesting.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/StateStack.h"
#include "tests/Catch.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/Material>
#include <osg/State>
#include <osg/Texture2D>

#include <random>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

constexpr unsigned int kFlags[] = {0, osg::StateAttribute::OVERRIDE, osg::StateAttribute::PROTECTED,
                                   osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED};

/// Gives access to OSG's own stacks, because captureCurrentState leaves textures out.
class OpenState : public osg::State
{
public:
    bool isTexture2DOn()
    {
        const auto& values = getOrCreateTextureModeMap(0)[GL_TEXTURE_2D].valueVec;
        return !values.empty() && (values.back() & osg::StateAttribute::ON) != 0;
    }
    const osg::StateAttribute* texture()
    {
        const osg::StateAttribute::TypeMemberPair key(osg::StateAttribute::TEXTURE, 0);
        const auto& attributes = getOrCreateTextureAttributeMap(0)[key].attributeVec;
        return attributes.empty() ? nullptr : attributes.back().first;
    }
};

unsigned int pick(std::mt19937& random, unsigned int count)
{
    return random() % count;
}

osg::ref_ptr<osg::StateSet> randomStateSet(std::mt19937& random)
{
    const auto value = [&random] { return pick(random, 2) | kFlags[pick(random, 4)]; };
    osg::ref_ptr<osg::StateSet> stateSet = new osg::StateSet;
    if (pick(random, 2)) stateSet->setMode(GL_LIGHTING, value());
    if (pick(random, 2)) stateSet->setMode(GL_LIGHT0 + 3, value());
    if (pick(random, 2)) stateSet->setMode(GL_LIGHT0 + 40, value());
    if (pick(random, 2)) stateSet->setMode(GL_LIGHT0 + 1000, value());
    if (pick(random, 2)) stateSet->setMode(GL_BLEND, value());
    if (pick(random, 2)) stateSet->setAttribute(new osg::Material, value());
    if (pick(random, 2)) stateSet->setAttribute(new PhysicalMaterial, value());
    if (pick(random, 2)) stateSet->setTextureMode(0, GL_TEXTURE_2D, value());
    if (pick(random, 2)) stateSet->setTextureAttribute(0, new osg::Texture2D, value());
    if (pick(random, 2)) stateSet->setTextureAttribute(1, new osg::Texture2D, value());
    return stateSet;
}

bool isLightOn(const GraphState& state, unsigned int number)
{
    if (!state.moreLights) return false;
    const auto light = state.moreLights->find(number);
    return light != state.moreLights->end() && (light->second & osg::StateAttribute::ON) != 0;
}

bool isOn(const osg::StateSet& state, GLenum mode)
{
    return (state.getMode(mode) & osg::StateAttribute::ON) != 0;
}

} // namespace

TEST_CASE("state stack: agrees with osg::State for random nestings", "[bridge]")
{
    std::mt19937 random(1);
    for (int trial = 0; trial < 500; ++trial)
    {
        StateStack stack{GraphState()};
        osg::ref_ptr<OpenState> reference = new OpenState;
        std::vector<osg::ref_ptr<osg::StateSet>> pushed;
        for (unsigned int depth = 1 + pick(random, 6); depth > 0; --depth)
        {
            pushed.push_back(randomStateSet(random));
            stack.push(*pushed.back());
            reference->pushStateSet(pushed.back());
        }
        if (pick(random, 2))
        {
            stack.pop();
            reference->popStateSet();
        }

        osg::ref_ptr<osg::StateSet> expected = new osg::StateSet;
        reference->captureCurrentState(*expected);
        const GraphState& state = stack.states()[stack.top()];
        CHECK(state.isOn(kLightingBit) == isOn(*expected, GL_LIGHTING));
        CHECK(state.isOn(3) == isOn(*expected, GL_LIGHT0 + 3));
        CHECK(isLightOn(state, 40) == isOn(*expected, GL_LIGHT0 + 40));
        CHECK(isLightOn(state, 1000) == isOn(*expected, GL_LIGHT0 + 1000));
        CHECK(state.isOn(kBlendBit) == isOn(*expected, GL_BLEND));
        CHECK(state.isOn(0, kTexture2DBit) == reference->isTexture2DOn());
        CHECK(state.attributes[kMaterialSlot] ==
              expected->getAttribute(osg::StateAttribute::MATERIAL));
        CHECK(state.attributes[kPhysicalMaterialSlot] ==
              expected->getAttribute(PhysicalMaterial::ATTRIBUTE_TYPE));
        CHECK(state.attributes[kUnitSlot + kTextureSlot] == reference->texture());
    }
}

TEST_CASE("state stack: equal paths give the same state, others do not", "[bridge]")
{
    osg::ref_ptr<osg::StateSet> a = new osg::StateSet;
    a->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    osg::ref_ptr<osg::StateSet> b = new osg::StateSet;
    StateStack stack{GraphState()};
    stack.push(*a);
    const uint32_t first = stack.top();
    stack.pop();
    CHECK(stack.top() == 0);
    stack.push(*a);
    CHECK(stack.top() == first);
    stack.push(*b);
    const uint32_t below = stack.top();
    CHECK(below != first);
    stack.pop();
    stack.pop();
    stack.push(*b);
    CHECK(stack.top() != below);
    CHECK_FALSE(stack.states()[stack.top()].isOn(kLightingBit));
}

TEST_CASE("state stack: uniforms and textures of all units are kept only if somebody reads them",
          "[bridge]")
{
    osg::ref_ptr<osg::StateSet> first = new osg::StateSet, second = new osg::StateSet;
    first->addUniform(new osg::Uniform("diffuseMap", 7));
    first->setTextureAttribute(7, new osg::Texture2D);
    const auto push = [&](StateStack& states)
    {
        states.push(*first);
        states.push(*second);
        CHECK(states.states().size() == 3);
    };
    StateStack plain((GraphState()));
    push(plain);
    for (const GraphState& state : plain.states())
        CHECK(state.shader == nullptr);

    GraphState root;
    root.shader = std::make_shared<ShaderState>();
    StateStack reading(root);
    push(reading);
    const ShaderState& shader = *reading.states().back().shader;
    CHECK(shader.uniforms.count("diffuseMap") == 1);
    CHECK(shader.textures.count(7) == 1);
    CHECK(reading.states()[1].shader == reading.states()[2].shader); // shared if nothing changes
}
