// RuleMaterial.cpp - makes materials of what shader rules ask for. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/RuleMaterial.h"

#include "osgRayTrace/bridge/appearance/materials/RuleSources.h"
#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/film/ToneMap.h"

#include <osg/Material>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

namespace osgRayTrace::engine
{

namespace
{

constexpr std::string_view kLetters = "rgba";

/// Makes the material of one rule.
class MaterialMaker
{
public:
    MaterialMaker(const ShaderRule& rule, const osg::NodePath& path, const GraphState& state,
                  DerivedTextures& derived)
        : _rule(rule), _path(path), _state(state), _derived(derived)
    {
    }

    RuleMaterial make()
    {
        _result.material = new PhysicalMaterial;
        _result.material->setName(_rule.name);
        setTextures();
        for (const ParameterRule& rule : _rule.parameters)
        {
            const std::optional<Values> values = numbers(*rule.parameter, rule.source);
            if (values && !lacksTexture(rule.parameter->name))
                rule.parameter->set(*_result.material, *values);
        }
        if (!gives("baseColor")) takeDiffuse(_state, *_result.material);
        if (!gives("baseColor") && !_rule.textures[kBaseColorField])
            _result.material->setBaseColorTexture(const_cast<osg::Texture2D*>(textureOf(_state)));
        if (_rule.alphaReference)
        {
            static const Parameter kReference = {"alphaReference", 1, 0.0, 1.0, nullptr};
            if (const auto values = numbers(kReference, *_rule.alphaReference))
                _result.alphaReference = static_cast<float>(values->front());
        }
        return std::move(_result);
    }

private:
    struct Found
    {
        const osg::Texture2D* texture = nullptr; ///< null: it is not there
        unsigned int unit = 0;
    };

    void miss(const std::string& kind, const std::string& name, bool optional)
    {
        if (!optional && _result.missing.empty()) _result.missing = kind + " '" + name + "'";
    }

    bool gives(const char* name) const
    {
        return std::any_of(_rule.parameters.begin(), _rule.parameters.end(),
                           [name](const ParameterRule& rule)
                           { return std::strcmp(rule.parameter->name, name) == 0; });
    }

    /// Returns whether the rule has a texture for a parameter, and the texture is not there.
    bool lacksTexture(const std::string& parameter) const
    {
        const PhysicalMaterial& m = *_result.material;
        const auto asks = [this](TextureField field) { return _rule.textures[field].has_value(); };
        if (parameter == "emission") return asks(kEmissionField) && !m.getEmissionTexture();
        if (parameter == "transmission")
            return asks(kTransmissionField) && !m.getTransmissionTexture();
        if (parameter == "subsurface")
            return asks(kSubsurfaceField) && !m.getTexture(PhysicalMaterial::SUBSURFACE_TEXTURE);
        if (parameter == "subsurfaceRadius")
            return asks(kSubsurfaceRadiusField) &&
                   !m.getTexture(PhysicalMaterial::SUBSURFACE_RADIUS_TEXTURE);
        if (parameter == "metallic") return _lacksMetallic;
        if (parameter == "roughness") return _lacksRoughness;
        return false;
    }

    /// Returns the numbers of a parameter, and records if they are not there.
    std::optional<Values> numbers(const Parameter& parameter, const ValueSource& source)
    {
        std::optional<Values> values = numbersOf(source, parameter, _path, _state);
        const bool ofUniform = source.kind == ValueSource::Kind::Uniform;
        if (!values) miss(ofUniform ? "uniform" : "user value", source.pattern, source.optional);
        return values;
    }

    /// Returns a layer of the array of a unit; null: there is none. Numbers are rounded and clamped
    /// as texture arrays do it.
    const osg::Texture2D* layerAt(unsigned int unit, const TextureSource& source)
    {
        static const Parameter kLayer = {"layer", 1, 0.0, 65535.0, nullptr};
        const osg::Texture2DArray* array = arrayAt(unit, _state);
        if (!array || array->getNumImages() == 0) return nullptr;
        const std::optional<Values> values = numbers(kLayer, *source.layer);
        if (!values) return nullptr;
        const double last = array->getNumImages() - 1;
        return _derived.ofLayer(
            *array, static_cast<unsigned int>(std::min(std::floor(values->front() + 0.5), last)));
    }

    /// Returns the texture of a field, and records what is not there.
    Found find(TextureField field)
    {
        const std::optional<TextureSource>& source = _rule.textures[field];
        if (!source) return {};
        const std::optional<unsigned int> unit = unitOf(*source, _path, _state);
        const osg::Texture2D* texture = nullptr;
        if (unit) texture = source->layer ? layerAt(*unit, *source) : textureAt(*unit, _state);
        if (!texture)
        {
            constexpr const char* kWords[] = {"of sampler", "of unit", "of user value", "of file"};
            const bool byUnit = source->kind == TextureSource::Kind::Unit;
            miss(std::string(source->layer ? "layer " : "2-D texture ") +
                     kWords[static_cast<int>(source->kind)],
                 byUnit ? std::to_string(source->unit) : source->pattern, source->optional);
            return {};
        }
        if (!_hasUnit) _result.unit = *unit;
        _hasUnit = true;
        return {texture, *unit};
    }

    ChannelSource channelOf(TextureField field, const Found& found, std::size_t letter) const
    {
        if (!found.texture) return {};
        const TextureSource& source = *_rule.textures[field];
        return {found.texture, static_cast<int>(kLetters.find(source.channels[letter])),
                source.invert};
    }

    /// Returns a texture of channels, or a source that only OpenGL has.
    osg::Texture2D* derived(const std::array<ChannelSource, 3>& channels)
    {
        for (const ChannelSource& source : channels)
            if (source.texture && isOnlyInOpenGL(*source.texture))
                return const_cast<osg::Texture2D*>(source.texture);
        osg::Texture2D* texture = _derived.ofChannels(channels);
        if (!texture) miss("texels of a texture for", "channels", false);
        return texture;
    }

    osg::Texture2D* colorTexture(TextureField field)
    {
        const Found found = find(field);
        if (!found.texture) return nullptr;
        const TextureSource& source = *_rule.textures[field];
        // The texture is held, but not changed.
        auto* plain = const_cast<osg::Texture2D*>(found.texture);
        if (!source.srgb || isOnlyInOpenGL(*found.texture)) return plain;
        osg::Texture2D* texture = _derived.ofEncoding(*found.texture, *source.srgb);
        return texture ? texture : plain;
    }

    /// Returns a texture whose red is one channel of a field's.
    osg::Texture2D* redTexture(TextureField field)
    {
        const Found found = find(field);
        if (!found.texture) return nullptr;
        const ChannelSource red = channelOf(field, found, 0);
        return red.channel == 0 && !red.invert ? const_cast<osg::Texture2D*>(found.texture)
                                               : derived({red, {}, {}});
    }

    /// Returns a texture of three channels of a field's, which are no colours.
    osg::Texture2D* dataTexture(TextureField field)
    {
        const Found found = find(field);
        if (!found.texture) return nullptr;
        const TextureSource& source = *_rule.textures[field];
        if (source.channels == "rgb" && !source.invert)
            return const_cast<osg::Texture2D*>(found.texture);
        return derived(
            {channelOf(field, found, 0), channelOf(field, found, 1), channelOf(field, found, 2)});
    }

    void setTextures()
    {
        PhysicalMaterial& m = *_result.material;
        m.setBaseColorTexture(colorTexture(kBaseColorField));
        m.setEmissionTexture(colorTexture(kEmissionField));
        m.setTransmissionTexture(redTexture(kTransmissionField));
        m.setTexture(PhysicalMaterial::SUBSURFACE_TEXTURE, redTexture(kSubsurfaceField));
        m.setTexture(PhysicalMaterial::NORMAL_TEXTURE, dataTexture(kNormalField));
        m.setTexture(PhysicalMaterial::SUBSURFACE_RADIUS_TEXTURE,
                     dataTexture(kSubsurfaceRadiusField));
        if (_rule.textures[kMetallicRoughnessField])
            setMetallicRoughness();
        else
            setSeparately();
    }

    void setMetallicRoughness()
    {
        const Found found = find(kMetallicRoughnessField);
        _lacksMetallic = _lacksRoughness = !found.texture;
        if (!found.texture) return;
        const TextureSource& source = *_rule.textures[kMetallicRoughnessField];
        const ChannelSource roughness = channelOf(kMetallicRoughnessField, found, 0);
        const ChannelSource metallic = channelOf(kMetallicRoughnessField, found, 1);
        _result.material->setMetallicRoughnessTexture(
            source.channels == "gb" && !source.invert
                ? const_cast<osg::Texture2D*>(found.texture)
                : derived({ChannelSource(), roughness, metallic}));
    }

    void setSeparately()
    {
        const Found roughness = find(kRoughnessField), metallic = find(kMetallicField);
        _lacksRoughness = _rule.textures[kRoughnessField] && !roughness.texture;
        _lacksMetallic = _rule.textures[kMetallicField] && !metallic.texture;
        if (!roughness.texture && !metallic.texture) return;
        _result.material->setMetallicRoughnessTexture(
            derived({ChannelSource(), channelOf(kRoughnessField, roughness, 0),
                     channelOf(kMetallicField, metallic, 0)}));
    }

    const ShaderRule& _rule;
    const osg::NodePath& _path;
    const GraphState& _state;
    DerivedTextures& _derived;
    RuleMaterial _result;
    bool _hasUnit = false, _lacksMetallic = false, _lacksRoughness = false;
};

float linear(float value)
{
    return std::isfinite(value) ? linearFromSrgb(value) : 0.0f;
}

} // namespace

RuleMaterial materialOf(const ShaderRule& rule, const osg::NodePath& path, const GraphState& state,
                        DerivedTextures& derived)
{
    return MaterialMaker(rule, path, state, derived).make();
}

void takeDiffuse(const GraphState& state, PhysicalMaterial& material)
{
    const auto* source = state.attribute<osg::Material>(kMaterialSlot);
    if (!source) return;
    const osg::Vec4& color = source->getDiffuse(osg::Material::FRONT);
    material.setBaseColor(osg::Vec3(linear(color.r()), linear(color.g()), linear(color.b())));
}

const osg::Texture2D* textureOf(const GraphState& state)
{
    return state.isOn(0, kTexture2DBit) ? state.attribute<osg::Texture2D>(0, kTextureSlot)
                                        : nullptr;
}

} // namespace osgRayTrace::engine
