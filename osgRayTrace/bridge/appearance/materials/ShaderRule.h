// ShaderRule.h - a rule of a material file for state that programs read. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/MaterialParameters.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

/// Names something that the state or the path of a geometry must have.
struct ShaderCondition
{
    enum class Kind
    {
        Program, ///< a program's name, the file of one of its shaders, or the class of a program
                 ///< that is no osg::Program
        Sampler, ///< a uniform of one integer, or of a sampler type
        Uniform,
        Unit,    ///< a texture is bound to the unit
        User,    ///< a user value of a state set or a node on the path
        Texture, ///< the file of a texture that is bound to any unit
    };

    Kind kind = Kind::Program;
    std::string pattern;
    unsigned int unit = 0; ///< Kind::Unit only
};

/// Tells where the numbers of a parameter come from.
struct ValueSource
{
    enum class Kind
    {
        Constant,
        Uniform,
        User
    };

    Kind kind = Kind::Constant;
    Values constant;
    std::string pattern;   ///< pattern of the uniform's or the user value's name
    bool invert = false;   ///< true: 1 - x, as for gloss
    double scale = 1.0;    ///< factor, after invert
    bool srgb = false;     ///< true: the colour is encoded in sRGB
    bool optional = false; ///< true: nobody is told if it is not there
};

/// Tells where a texture comes from, and what of it is read.
struct TextureSource
{
    enum class Kind
    {
        Sampler, ///< unit that an integer uniform tells
        Unit,
        User,   ///< unit that a user value tells
        Texture ///< texture of the first unit whose file fits
    };

    Kind kind = Kind::Sampler;
    std::string pattern;
    unsigned int unit = 0;            ///< Kind::Unit only
    std::optional<ValueSource> layer; ///< layer of a texture array; nothing: a 2-D texture
    std::string channels;             ///< letters of "rgba", one for each channel that is read
    bool invert = false;              ///< true: 1 - x for each channel that is read
    std::optional<bool> srgb; ///< whether a colour is encoded in sRGB; nothing: by its format
    bool optional = false;    ///< true: nobody is told if it is not there
};

/// Names the textures of a rule. Roughness and metallic are parts of one texture.
enum TextureField : unsigned int
{
    kBaseColorField,
    kEmissionField,
    kTransmissionField,
    kMetallicRoughnessField,
    kRoughnessField,
    kMetallicField,
    kNormalField,
    kSubsurfaceField,
    kSubsurfaceRadiusField,
    kTextureFields,
};

struct ParameterRule
{
    const Parameter* parameter = nullptr;
    ValueSource source;
};

/// Names vertex attributes that take the place of a geometry's own arrays; -1: the own array.
struct VertexAttributes
{
    int position = -1, normal = -1, texcoord = -1;

    bool any() const { return position >= 0 || normal >= 0 || texcoord >= 0; }
};

struct ShaderRule
{
    std::string name; ///< name in the file, or "rule N"
    std::vector<ShaderCondition> conditions;
    std::vector<ParameterRule> parameters;
    std::array<std::optional<TextureSource>, kTextureFields> textures;
    std::optional<ValueSource> alphaReference;
    VertexAttributes attributes;

    /// Returns whether the rule depends on user values, which belong to paths and not to states.
    bool readsUserValues() const;
};

} // namespace osgRayTrace::engine
