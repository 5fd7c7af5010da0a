// RuleSources.cpp - finds uniforms, user values and textures by patterns. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/RuleSources.h"

#include "osgRayTrace/bridge/appearance/materials/SurfaceState.h"
#include "osgRayTrace/bridge/common/NamePattern.h"
#include "osgRayTrace/film/ToneMap.h"

#include <osg/Image>
#include <osg/Program>
#include <osg/UserDataContainer>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether a pattern fits a file name, with or without its folders.
bool fitsFile(const std::string& pattern, const std::string& file)
{
    if (file.empty()) return false;
    return matchesPattern(pattern, file) || matchesPattern(pattern, osgDB::getSimpleFileName(file));
}

bool fitsProgram(const std::string& pattern, const GraphState& state)
{
    const osg::StateAttribute* attribute = programOf(state);
    if (!attribute) return false;
    if (matchesPattern(pattern, attribute->getName())) return true;
    const auto* program = dynamic_cast<const osg::Program*>(attribute);
    if (!program) return matchesPattern(pattern, attribute->className());
    for (unsigned int i = 0; i < program->getNumShaders(); ++i)
        if (fitsFile(pattern, program->getShader(i)->getFileName())) return true;
    return false;
}

bool isSampler(const osg::Uniform& uniform)
{
    return valuesOf(uniform).size() == 1 && uniform.getIntArray();
}

/// Returns the uniform that a pattern fits, the first one by name; null: none.
const osg::Uniform* findUniform(const std::string& pattern, const GraphState& state, bool sampler)
{
    const auto& uniforms = state.shader->uniforms;
    const bool isName = pattern.find('*') == std::string::npos;
    for (auto it = isName ? uniforms.find(pattern) : uniforms.begin(); it != uniforms.end(); ++it)
    {
        const osg::Uniform& uniform = *it->second.first;
        if (matchesPattern(pattern, it->first) && (!sampler || isSampler(uniform))) return &uniform;
        if (isName) break;
    }
    return nullptr;
}

const osg::Object* findUserValue(const std::string& pattern, const osg::Object& holder)
{
    const osg::UserDataContainer* container = holder.getUserDataContainer();
    if (!container) return nullptr;
    for (unsigned int i = 0; i < container->getNumUserObjects(); ++i)
    {
        const osg::Object* value = container->getUserObject(i);
        if (value && matchesPattern(pattern, value->getName())) return value;
    }
    return nullptr;
}

/// Returns the nearest user value of the nodes of a path and their state sets; null: none.
const osg::Object* findUserValue(const std::string& pattern, const osg::NodePath& path)
{
    for (auto node = path.rbegin(); node != path.rend(); ++node)
    {
        const osg::StateSet* stateSet = (*node)->getStateSet();
        const osg::Object* value = stateSet ? findUserValue(pattern, *stateSet) : nullptr;
        if (!value) value = findUserValue(pattern, **node);
        if (value) return value;
    }
    return nullptr;
}

std::string fileOf(const osg::Texture& texture)
{
    return texture.getNumImages() > 0 && texture.getImage(0) ? texture.getImage(0)->getFileName()
                                                             : std::string();
}

/// Returns the first unit whose texture has a file that the pattern fits.
std::optional<unsigned int> unitOfFile(const std::string& pattern, const GraphState& state)
{
    for (const auto& [unit, pair] : state.shader->textures)
    {
        const osg::Texture* texture = pair.first->asTexture();
        if (texture && fitsFile(pattern, fileOf(*texture))) return unit;
    }
    return std::nullopt;
}

std::optional<unsigned int> unitFrom(const std::vector<double>& values)
{
    constexpr double kMostUnits = 1024.0;
    if (values.empty() || !(values[0] >= 0.0 && values[0] < kMostUnits)) return std::nullopt;
    return static_cast<unsigned int>(values[0]);
}

/// Returns the texture of a unit; null: none, or one of another class.
template <class T> const T* boundTo(unsigned int unit, const GraphState& state)
{
    const auto found = state.shader->textures.find(unit);
    return found == state.shader->textures.end() ? nullptr
                                                 : dynamic_cast<const T*>(found->second.first);
}

bool holds(const ShaderCondition& condition, const osg::NodePath& path, const GraphState& state)
{
    switch (condition.kind)
    {
    case ShaderCondition::Kind::Program:
        return fitsProgram(condition.pattern, state);
    case ShaderCondition::Kind::Sampler:
        return findUniform(condition.pattern, state, true) != nullptr;
    case ShaderCondition::Kind::Uniform:
        return findUniform(condition.pattern, state, false) != nullptr;
    case ShaderCondition::Kind::Unit:
        return state.shader->textures.count(condition.unit) > 0;
    case ShaderCondition::Kind::User:
        return findUserValue(condition.pattern, path) != nullptr;
    case ShaderCondition::Kind::Texture:
        return unitOfFile(condition.pattern, state).has_value();
    }
    return false;
}

} // namespace

bool fits(const ShaderRule& rule, const osg::NodePath& path, const GraphState& state)
{
    return std::all_of(rule.conditions.begin(), rule.conditions.end(),
                       [&](const ShaderCondition& condition)
                       { return holds(condition, path, state); });
}

std::optional<Values> numbersOf(const ValueSource& source, const Parameter& parameter,
                                const osg::NodePath& path, const GraphState& state)
{
    if (source.kind == ValueSource::Kind::Constant) return source.constant;
    Values values;
    if (source.kind == ValueSource::Kind::Uniform)
    {
        if (const osg::Uniform* uniform = findUniform(source.pattern, state, false))
            values = valuesOf(*uniform);
    }
    else if (const osg::Object* value = findUserValue(source.pattern, path))
        values = userValuesOf(*value);
    const auto isNumber = [](double value) { return std::isfinite(value); };
    if (values.size() < parameter.count || !std::all_of(values.begin(), values.end(), isNumber))
        return std::nullopt;
    values.resize(parameter.count);
    for (double& value : values)
    {
        if (source.invert) value = 1.0 - value;
        value = std::clamp(value * source.scale, parameter.lowest, parameter.highest);
        if (source.srgb) value = double(linearFromSrgb(static_cast<float>(value)));
    }
    return values;
}

std::optional<unsigned int> unitOf(const TextureSource& source, const osg::NodePath& path,
                                   const GraphState& state)
{
    switch (source.kind)
    {
    case TextureSource::Kind::Sampler:
    {
        const osg::Uniform* uniform = findUniform(source.pattern, state, true);
        return uniform ? unitFrom(valuesOf(*uniform)) : std::nullopt;
    }
    case TextureSource::Kind::Unit:
        return source.unit;
    case TextureSource::Kind::User:
    {
        const osg::Object* value = findUserValue(source.pattern, path);
        return value ? unitFrom(userValuesOf(*value)) : std::nullopt;
    }
    case TextureSource::Kind::Texture:
        return unitOfFile(source.pattern, state);
    }
    return std::nullopt;
}

const osg::Texture2D* textureAt(unsigned int unit, const GraphState& state)
{
    return boundTo<osg::Texture2D>(unit, state);
}

const osg::Texture2DArray* arrayAt(unsigned int unit, const GraphState& state)
{
    return boundTo<osg::Texture2DArray>(unit, state);
}

} // namespace osgRayTrace::engine
