// ShaderState.cpp - inherits uniforms and textures, and reads the numbers in them. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ShaderState.h"

#include "osgRayTrace/base/NumberText.h"
#include "osgRayTrace/bridge/common/NamePattern.h"

#include <osg/ValueObject>

#include <algorithm>
#include <sstream>

namespace osgRayTrace::engine
{

namespace
{

constexpr unsigned int kMostComponents = 4;

/// Replaces an entry unless it has OVERRIDE and the new value lacks PROTECTED.
template <class Map, class T>
void apply(Map& map, const typename Map::key_type& key, const T* object, unsigned int value)
{
    const auto [entry, isNew] = map.try_emplace(key, object, value);
    const bool keeps = (entry->second.second & osg::StateAttribute::OVERRIDE) &&
                       !(value & osg::StateAttribute::PROTECTED);
    if (!isNew && !keeps) entry->second = {object, value};
}

template <class Array> std::vector<double> firstOf(const Array& array, unsigned int components)
{
    const std::size_t count = std::min<std::size_t>(components, array.size());
    return std::vector<double>(array.begin(), array.begin() + static_cast<std::ptrdiff_t>(count));
}

std::vector<double> numbersOf(const std::string& text)
{
    std::vector<double> numbers;
    std::istringstream words(text);
    std::string word;
    while (numbers.size() < kMostComponents && words >> word)
    {
        const auto number = parseNumber<double>(word);
        if (!number) break;
        numbers.push_back(*number);
    }
    return numbers;
}

/// Takes the numbers of a value of any type that has at most four of them.
class NumberReader : public osg::ValueObject::GetValueVisitor
{
public:
    std::vector<double> values;

    using osg::ValueObject::GetValueVisitor::apply;
    void apply(bool value) override { values = {value ? 1.0 : 0.0}; }
    void apply(char value) override { values = {double(value)}; }
    void apply(unsigned char value) override { values = {double(value)}; }
    void apply(short value) override { values = {double(value)}; }
    void apply(unsigned short value) override { values = {double(value)}; }
    void apply(int value) override { values = {double(value)}; }
    void apply(unsigned int value) override { values = {double(value)}; }
    void apply(float value) override { values = {double(value)}; }
    void apply(double value) override { values = {value}; }
    void apply(const std::string& value) override { values = numbersOf(value); }
    void apply(const osg::Vec2f& value) override { take(value); }
    void apply(const osg::Vec3f& value) override { take(value); }
    void apply(const osg::Vec4f& value) override { take(value); }
    void apply(const osg::Vec2d& value) override { take(value); }
    void apply(const osg::Vec3d& value) override { take(value); }
    void apply(const osg::Vec4d& value) override { take(value); }

private:
    template <class Vector> void take(const Vector& vector)
    {
        values.clear();
        for (int i = 0; i < Vector::num_components; ++i)
            values.push_back(double(vector[i]));
    }
};

} // namespace

std::shared_ptr<const ShaderState> below(const std::shared_ptr<const ShaderState>& state,
                                         const osg::StateSet& stateSet)
{
    const osg::StateSet::TextureAttributeList& units = stateSet.getTextureAttributeList();
    if (stateSet.getUniformList().empty() && units.empty()) return state;
    const auto result = std::make_shared<ShaderState>(*state);
    for (const auto& [name, pair] : stateSet.getUniformList())
        if (pair.first) apply(result->uniforms, name, pair.first.get(), pair.second);
    for (unsigned int unit = 0; unit < units.size(); ++unit)
        for (const auto& [type, pair] : units[unit])
            if (type.first == osg::StateAttribute::TEXTURE)
                apply(result->textures, unit, pair.first.get(), pair.second);
    return result;
}

bool ShaderReads::reads(const osg::Uniform& uniform) const
{
    return std::any_of(uniforms.begin(), uniforms.end(),
                       [&uniform](const std::string& pattern)
                       { return matchesPattern(pattern, uniform.getName()); });
}

std::vector<double> valuesOf(const osg::Uniform& uniform)
{
    const auto components =
        static_cast<unsigned int>(osg::Uniform::getTypeNumComponents(uniform.getType()));
    if (components > kMostComponents) return {};
    if (uniform.getFloatArray()) return firstOf(*uniform.getFloatArray(), components);
    if (uniform.getDoubleArray()) return firstOf(*uniform.getDoubleArray(), components);
    if (uniform.getIntArray()) return firstOf(*uniform.getIntArray(), components);
    if (uniform.getUIntArray()) return firstOf(*uniform.getUIntArray(), components);
    return {};
}

std::vector<double> userValuesOf(const osg::Object& userValue)
{
    NumberReader reader;
    if (const auto* value = dynamic_cast<const osg::ValueObject*>(&userValue)) value->get(reader);
    return std::move(reader.values);
}

} // namespace osgRayTrace::engine
