// MaterialAssignment.cpp - gives geometry the materials of a library. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialAssignment.h"

#include "osgRayTrace/film/ToneMap.h"

#include <osg/Image>
#include <osg/Material>
#include <osg/Texture2D>
#include <osgDB/FileNameUtils>

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

const osg::Texture2D* textureOf(const GraphState& state)
{
    return state.isOn(0, kTexture2DBit) ? state.attribute<osg::Texture2D>(0, kTextureSlot)
                                        : nullptr;
}

float linear(float value)
{
    return std::isfinite(value) ? linearFromSrgb(value) : 0.0f;
}

/// Takes the diffuse colour and texture of the state.
void takeColor(const GraphState& state, PhysicalMaterial& material)
{
    if (const auto* source = state.attribute<osg::Material>(kMaterialSlot))
    {
        const osg::Vec4& color = source->getDiffuse(osg::Material::FRONT);
        material.setBaseColor(osg::Vec3(linear(color.r()), linear(color.g()), linear(color.b())));
    }
    // The texture is held, but not changed.
    material.setBaseColorTexture(const_cast<osg::Texture2D*>(textureOf(state)));
}

} // namespace

const MaterialRule* MaterialAssignment::ruleFor(const osg::NodePath& path,
                                                const GraphState& state) const
{
    for (auto node = path.rbegin(); node != path.rend() && !_library->nodes.empty(); ++node)
        if (const MaterialRule* rule = _library->nodes.find((*node)->getName())) return rule;
    if (const auto* material = state.attribute<osg::Material>(kMaterialSlot))
        if (const MaterialRule* rule = _library->materials.find(material->getName())) return rule;
    const osg::Texture2D* texture = textureOf(state);
    if (!texture || !texture->getImage()) return nullptr;
    const std::string& file = texture->getImage()->getFileName();
    if (const MaterialRule* rule = _library->textures.find(file)) return rule;
    return _library->textures.find(osgDB::getSimpleFileName(file));
}

const osg::StateSet& MaterialAssignment::stateSetOf(const MaterialRule& rule, uint32_t number,
                                                    const GraphState& state)
{
    osg::ref_ptr<osg::StateSet>& stateSet = _stateSets[{&rule, rule.keepsColor ? number : 0}];
    if (stateSet) return *stateSet;
    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial(*rule.material);
    if (rule.keepsColor) takeColor(state, *material);
    stateSet = new osg::StateSet;
    stateSet->setAttribute(material.get(),
                           osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED);
    return *stateSet;
}

uint32_t MaterialAssignment::stateOf(const osg::NodePath& path, StateStack& states)
{
    const uint32_t number = states.top();
    if (!_library) return number;
    const GraphState state = states.states()[number];
    const MaterialRule* rule = ruleFor(path, state);
    if (!rule) return number;
    _used.insert(rule);
    states.push(stateSetOf(*rule, number, state));
    const uint32_t assigned = states.top();
    states.pop();
    return assigned;
}

void MaterialAssignment::reportUnused(ConversionReport& report) const
{
    if (!_library) return;
    for (const auto* rules : {&_library->nodes, &_library->materials, &_library->textures})
        for (const MaterialRule& rule : *rules)
            if (_used.count(&rule) == 0)
                report.warn("warned.material-name",
                            "material file, " + rule.group + " '" + rule.pattern + "'",
                            "nothing in the scene has this name");
}

} // namespace osgRayTrace::engine
