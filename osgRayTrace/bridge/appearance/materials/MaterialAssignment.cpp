// MaterialAssignment.cpp - gives geometry the materials of a library or of the application. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialAssignment.h"

#include "osgRayTrace/bridge/appearance/materials/RuleMaterial.h"
#include "osgRayTrace/bridge/appearance/materials/RuleSources.h"
#include "osgRayTrace/bridge/appearance/materials/SurfaceState.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <osg/AlphaFunc>
#include <osg/Image>
#include <osg/Material>
#include <osg/Texture2D>
#include <osgDB/FileNameUtils>

#include <exception>

namespace osgRayTrace::engine
{

namespace
{

constexpr auto kForced = osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;

/// Takes the diffuse colour and texture of the state.
void takeColor(const GraphState& state, PhysicalMaterial& material)
{
    takeDiffuse(state, material);
    // The texture is held, but not changed.
    material.setBaseColorTexture(const_cast<osg::Texture2D*>(textureOf(state)));
}

osg::ref_ptr<osg::StateSet> stateSetWith(PhysicalMaterial* material)
{
    osg::ref_ptr<osg::StateSet> stateSet = new osg::StateSet;
    stateSet->setAttribute(material, kForced);
    return stateSet;
}

uint32_t below(StateStack& states, const osg::StateSet& stateSet)
{
    states.push(stateSet);
    const uint32_t number = states.top();
    states.pop();
    return number;
}

/// Returns the model's material with the values of a rule that edits; null: nothing changes.
osg::ref_ptr<PhysicalMaterial> edited(const MaterialRule& rule, const GraphState& state)
{
    const osg::ref_ptr<PhysicalMaterial> own = materialOfModel(state);
    osg::ref_ptr<PhysicalMaterial> result = new PhysicalMaterial(*own);
    for (const auto& [parameter, values] : rule.given)
        parameter->set(*result, values);
    return result->compare(*own) == 0 ? nullptr : result;
}

} // namespace

const MaterialRule* ruleFor(const MaterialLibrary& rules, const osg::NodePath& path,
                            const GraphState& state)
{
    for (auto node = path.rbegin(); node != path.rend() && !rules.nodes.empty(); ++node)
        if (const MaterialRule* rule = rules.nodes.find((*node)->getName())) return rule;
    if (const auto* material = state.attribute<osg::Material>(kMaterialSlot))
        if (const MaterialRule* rule = rules.materials.find(material->getName())) return rule;
    const osg::Texture2D* texture = textureOf(state);
    if (!texture || !texture->getImage()) return nullptr;
    const std::string& file = texture->getImage()->getFileName();
    if (const MaterialRule* rule = rules.textures.find(file)) return rule;
    return rules.textures.find(osgDB::getSimpleFileName(file));
}

osg::ref_ptr<PhysicalMaterial> materialOfModel(const GraphState& state)
{
    if (const auto* own = state.attribute<PhysicalMaterial>(kPhysicalMaterialSlot))
        return new PhysicalMaterial(*own);
    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    takeColor(state, *material);
    return material;
}

/// Returns the application's material, or null.
osg::ref_ptr<PhysicalMaterial> MaterialAssignment::ask(const osg::NodePath& path) const
{
    std::vector<const osg::StateSet*> stateSets;
    for (const osg::ref_ptr<const osg::StateSet>& stateSet : _givers.inherited)
        stateSets.push_back(stateSet.get());
    for (const osg::Node* node : path)
        if (node->getStateSet()) stateSets.push_back(node->getStateSet());
    try
    {
        return _givers.hook->materialFor(path, stateSets);
    }
    catch (const std::exception& error)
    {
        warnOnce("material hook: " + std::string(error.what()) + ", taken as no material");
    }
    catch (...)
    {
        warnOnce("material hook: an exception, taken as no material");
    }
    return nullptr;
}

/// Returns the application's material from the answers that are kept, or asks and keeps the answer.
osg::ref_ptr<PhysicalMaterial> MaterialAssignment::hookMaterial(const osg::NodePath& path)
{
    if (!_answers) return ask(path);
    if (const osg::ref_ptr<PhysicalMaterial>* known = _answers->find(*path.back())) return *known;
    if (_repeats)
    {
        _lacksAnswers = true;
        return nullptr;
    }
    return _answers->add(*path.back(), ask(path));
}

const osg::StateSet* MaterialAssignment::stateSetOf(const MaterialRule& rule, uint32_t number,
                                                    const GraphState& state)
{
    const bool asksState = rule.keepsColor || rule.edits;
    const auto [known, isNew] = _stateSets.try_emplace({&rule, asksState ? number : 0});
    if (!isNew) return known->second;
    if (rule.edits)
    {
        if (const osg::ref_ptr<PhysicalMaterial> material = edited(rule, state))
            known->second = stateSetWith(material);
        return known->second;
    }
    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial(*rule.material);
    if (rule.keepsColor) takeColor(state, *material);
    known->second = stateSetWith(material);
    return known->second;
}

/// Returns the first rule of "shaders" that fits, with its state. Rules that read user values are
/// tried for each path, the others once for each state.
const MaterialAssignment::ShaderMatch&
MaterialAssignment::shaderMatch(const osg::NodePath& path, uint32_t number, const GraphState& state)
{
    const auto [known, isNew] = _shaderMatches.try_emplace(number);
    ShaderMatch& match = known->second;
    if (!isNew && !_givers.rules->readsUserValues) return match;
    match = ShaderMatch();
    for (const ShaderRule& rule : _givers.rules->shaders)
    {
        if (!fits(rule, path, state)) continue;
        RuleMaterial made = materialOf(rule, path, state, _derived);
        if (!made.missing.empty()) _missing.emplace(&rule, made.missing);
        match.rule = &rule;
        match.unit = made.unit;
        match.stateSet = stateSetWith(made.material);
        if (made.alphaReference)
            match.stateSet->setAttributeAndModes(
                new osg::AlphaFunc(osg::AlphaFunc::GREATER, *made.alphaReference),
                osg::StateAttribute::ON | kForced);
        break;
    }
    return match;
}

AssignedState MaterialAssignment::stateOf(const osg::NodePath& path, StateStack& states)
{
    AssignedState result;
    const uint32_t number = result.state = states.top();
    if (_givers.hook)
        if (const osg::ref_ptr<PhysicalMaterial> material = hookMaterial(path))
        {
            result.by = &_hookName;
            result.state = below(states, *stateSetWith(material));
            return result;
        }
    if (!_givers.rules) return result;
    const GraphState state = states.states()[number];
    if (const MaterialRule* rule = ruleFor(*_givers.rules, path, state))
    {
        _used.insert(rule);
        const osg::StateSet* stateSet = stateSetOf(*rule, number, state);
        if (!stateSet) return result;
        if (programOf(state)) result.by = &rule->pattern;
        result.state = below(states, *stateSet);
        return result;
    }
    if (_givers.rules->shaders.empty()) return result;
    const ShaderMatch& match = shaderMatch(path, number, state);
    if (!match.rule) return result;
    _usedShaders = true;
    result.by = &match.rule->name;
    result.attributes = match.rule->attributes;
    result.unit = match.unit;
    result.state = below(states, *match.stateSet);
    return result;
}

void MaterialAssignment::reportRules(ConversionReport& report) const
{
    if (!_givers.rules) return;
    const MaterialLibrary& rules = *_givers.rules;
    for (const auto* group : {&rules.nodes, &rules.materials, &rules.textures})
        for (const MaterialRule& rule : *group)
            if (_used.count(&rule) == 0)
                report.warn("warned.material-name",
                            "material file, " + rule.group + " '" + rule.pattern + "'",
                            "nothing in the scene has this name");
    if (!rules.shaders.empty() && !_usedShaders)
        report.warn("warned.material-name", "material file, shaders",
                    "nothing in the scene fits any of the rules");
    for (const auto& [rule, what] : _missing)
        report.warn("warned.material-value", "material file, shaders '" + rule->name + "'",
                    "asks for the " + what + ", which is not there");
}

} // namespace osgRayTrace::engine
