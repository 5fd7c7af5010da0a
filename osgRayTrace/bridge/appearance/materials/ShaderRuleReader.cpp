// ShaderRuleReader.cpp - checks the members of a rule, and says what is wrong. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/ShaderRuleReader.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

using Kind = LocatedJson::Kind;

constexpr double kMostUnits = 1024.0;
constexpr double kMostAttributes = 256.0;

template <class Value> struct Word
{
    const char* word;
    Value value;
};

template <class Value, std::size_t N>
const Word<Value>* findWord(const Word<Value> (&words)[N], const std::string& name)
{
    const auto found = std::find_if(std::begin(words), std::end(words),
                                    [&name](const auto& word) { return name == word.word; });
    return found == std::end(words) ? nullptr : found;
}

constexpr Word<ShaderCondition::Kind> kConditions[] = {
    {"program", ShaderCondition::Kind::Program}, {"sampler", ShaderCondition::Kind::Sampler},
    {"uniform", ShaderCondition::Kind::Uniform}, {"unit", ShaderCondition::Kind::Unit},
    {"user", ShaderCondition::Kind::User},       {"texture", ShaderCondition::Kind::Texture}};

constexpr Word<TextureSource::Kind> kTextureSources[] = {{"sampler", TextureSource::Kind::Sampler},
                                                         {"unit", TextureSource::Kind::Unit},
                                                         {"user", TextureSource::Kind::User},
                                                         {"texture", TextureSource::Kind::Texture}};

constexpr Word<ValueSource::Kind> kValueSources[] = {{"uniform", ValueSource::Kind::Uniform},
                                                     {"user", ValueSource::Kind::User}};

constexpr Word<int VertexAttributes::*> kAttributes[] = {{"position", &VertexAttributes::position},
                                                         {"normal", &VertexAttributes::normal},
                                                         {"texcoord", &VertexAttributes::texcoord}};

/// Describes a texture of a rule: the channels that are read unless the file names others.
struct TextureWord
{
    const char* word;
    const char* channels; ///< empty: a colour
};

constexpr TextureWord kTextures[kTextureFields] = {
    {"baseColorTexture", ""},          {"emissionTexture", ""},
    {"transmissionTexture", "r"},      {"metallicRoughnessTexture", "gb"},
    {"roughnessTexture", "r"},         {"metallicTexture", "r"},
    {"normalTexture", "rgb"},          {"subsurfaceTexture", "r"},
    {"subsurfaceRadiusTexture", "rgb"}};

const Parameter kAlphaReference = {"alphaReference", 1, 0.0, 1.0, nullptr};
const Parameter kLayer = {"layer", 1, 0.0, 65535.0, nullptr};

/// Reads one rule. A function that returns false has left the error and its line.
class RuleReader
{
public:
    explicit RuleReader(std::size_t number)
    {
        _result.rule.name = "rule " + std::to_string(number);
    }

    ShaderRuleResult read(const LocatedJson& json)
    {
        readMembers(json);
        if (!_result.error.empty()) _result.error = "'" + rule().name + "': " + _result.error;
        return std::move(_result);
    }

private:
    ShaderRule& rule() { return _result.rule; }

    bool fail(const LocatedJson& json, const std::string& what)
    {
        _result.line = json.line;
        _result.error = json.name.empty() ? what : "'" + json.name + "': " + what;
        return false;
    }

    bool wrongType(const LocatedJson& json, const char* wanted)
    {
        return fail(json, std::string(wanted) + " was expected, not " + wordOf(json.kind));
    }

    bool noRepeats(const LocatedJson& object)
    {
        std::vector<const std::string*> names;
        for (const LocatedJson& member : object.children)
        {
            for (const std::string* name : names)
                if (*name == member.name) return fail(member, "is there twice");
            names.push_back(&member.name);
            if (names.size() > 64) return fail(member, "is one of too many");
        }
        return true;
    }

    bool readMembers(const LocatedJson& json)
    {
        if (!json.is(Kind::Object)) return wrongType(json, "an object for a rule");
        for (const LocatedJson& member : json.children)
            if (member.name == "name" && !readText(member, rule().name)) return false;
        if (!noRepeats(json)) return false;
        for (const LocatedJson& member : json.children)
            if (member.name != "name" && !readMember(member)) return false;
        if (rule().conditions.empty()) return fail(json, "the rule has no condition in an 'if'");
        const auto& textures = rule().textures;
        if (textures[kMetallicRoughnessField] &&
            (textures[kRoughnessField] || textures[kMetallicField]))
            return fail(json, "metallicRoughnessTexture excludes roughnessTexture and "
                              "metallicTexture");
        return true;
    }

    bool readMember(const LocatedJson& json)
    {
        if (json.name == "if") return readConditions(json);
        if (json.name == "attributes") return readAttributes(json);
        if (json.name == kAlphaReference.name)
            return readValue(json, kAlphaReference, rule().alphaReference.emplace());
        for (unsigned int field = 0; field < kTextureFields; ++field)
            if (json.name == kTextures[field].word)
                return readTexture(json, kTextures[field].channels,
                                   rule().textures[field].emplace());
        const Parameter* parameter = findParameter(json.name);
        if (!parameter)
        {
            std::string names = "is no member of a rule; there are name, if, attributes, " +
                                parameterNames() + ", alphaReference";
            for (const TextureWord& texture : kTextures)
                names += ", " + std::string(texture.word);
            return fail(json, names);
        }
        return readValue(json, *parameter,
                         rule().parameters.emplace_back(ParameterRule{parameter, {}}).source);
    }

    bool readText(const LocatedJson& json, std::string& text)
    {
        if (!json.is(Kind::Text)) return wrongType(json, "a string");
        if (json.text.empty()) return fail(json, "the string is empty");
        text = json.text;
        return true;
    }

    bool readFlag(const LocatedJson& json, bool& flag)
    {
        if (!json.is(Kind::Boolean)) return wrongType(json, "true or false");
        flag = json.boolean;
        return true;
    }

    /// Reads a whole number from 0 up to most, without most itself.
    template <class Integer> bool readIndex(const LocatedJson& json, double most, Integer& index)
    {
        if (!json.is(Kind::Number)) return wrongType(json, "a number");
        if (!(json.number >= 0.0 && json.number < most) || std::floor(json.number) != json.number)
            return fail(json, "the number is none of 0, 1, ... " +
                                  std::to_string(static_cast<int>(most) - 1));
        index = static_cast<Integer>(json.number);
        return true;
    }

    /// Reads conditions. An array stands for several conditions of a kind, which all must hold.
    bool readConditions(const LocatedJson& json)
    {
        if (!json.is(Kind::Object)) return wrongType(json, "an object");
        if (!noRepeats(json)) return false;
        for (const LocatedJson& member : json.children)
        {
            const auto* word = findWord(kConditions, member.name);
            if (!word)
                return fail(member, "is no condition; there are program, sampler, uniform, unit, "
                                    "user, texture");
            if (!member.is(Kind::Array))
            {
                if (!readCondition(member, word->value)) return false;
                continue;
            }
            for (const LocatedJson& item : member.children)
                if (!readCondition(item, word->value)) return false;
        }
        return true;
    }

    bool readCondition(const LocatedJson& json, ShaderCondition::Kind kind)
    {
        ShaderCondition& condition = rule().conditions.emplace_back();
        condition.kind = kind;
        return kind == ShaderCondition::Kind::Unit ? readIndex(json, kMostUnits, condition.unit)
                                                   : readText(json, condition.pattern);
    }

    bool readAttributes(const LocatedJson& json)
    {
        if (!json.is(Kind::Object)) return wrongType(json, "an object");
        if (!noRepeats(json)) return false;
        for (const LocatedJson& member : json.children)
        {
            const auto* word = findWord(kAttributes, member.name);
            if (!word) return fail(member, "is no attribute; there are position, normal, texcoord");
            if (!readIndex(member, kMostAttributes, rule().attributes.*word->value)) return false;
        }
        return true;
    }

    bool readValue(const LocatedJson& json, const Parameter& parameter, ValueSource& source)
    {
        if (json.is(Kind::Object)) return readValueSource(json, parameter, source);
        const bool single = parameter.count == 1;
        const char* wanted =
            single ? "a number or an object" : "an array of three numbers or an object";
        if (single != json.is(Kind::Number) || (!single && !json.is(Kind::Array)))
            return wrongType(json, wanted);
        if (single) return readConstant(json, json, parameter, source);
        for (const LocatedJson& item : json.children)
            if (!readConstant(item, json, parameter, source)) return false;
        if (source.constant.size() != parameter.count)
            return fail(json, "an array of three numbers was expected, not one of another length");
        return true;
    }

    bool readConstant(const LocatedJson& json, const LocatedJson& named, const Parameter& parameter,
                      ValueSource& source)
    {
        if (!json.is(Kind::Number)) return wrongType(json, "a number");
        if (!(json.number >= parameter.lowest && json.number <= parameter.highest))
            return fail(named, "a number is out of range");
        if (parameter.isWhole && json.number != std::floor(json.number))
            return fail(named, "a whole number was expected");
        source.constant.push_back(json.number);
        return true;
    }

    bool readValueSource(const LocatedJson& json, const Parameter& parameter, ValueSource& source)
    {
        if (!noRepeats(json)) return false;
        for (const LocatedJson& member : json.children)
        {
            bool good = true;
            if (const auto* word = findWord(kValueSources, member.name))
            {
                if (source.kind != ValueSource::Kind::Constant)
                    return fail(member, "is a second source");
                source.kind = word->value;
                good = readText(member, source.pattern);
            }
            else if (member.name == "invert")
                good = readFlag(member, source.invert);
            else if (member.name == "optional")
                good = readFlag(member, source.optional);
            else if (member.name == "srgb" && parameter.count == 3)
                good = readFlag(member, source.srgb);
            else if (member.name == "scale")
                good = readScale(member, source.scale);
            else
                return fail(member, "does not belong here; there are uniform, user, invert, scale, "
                                    "optional, and srgb for a colour");
            if (!good) return false;
        }
        if (source.kind != ValueSource::Kind::Constant) return true;
        return fail(json, "the object names no uniform or user value");
    }

    bool readScale(const LocatedJson& json, double& scale)
    {
        if (!json.is(Kind::Number)) return wrongType(json, "a number");
        scale = json.number;
        return true;
    }

    bool readTexture(const LocatedJson& json, const std::string& channels, TextureSource& source)
    {
        if (!json.is(Kind::Object)) return wrongType(json, "an object");
        if (!noRepeats(json)) return false;
        source.channels = channels;
        bool found = false;
        for (const LocatedJson& member : json.children)
        {
            bool good = true;
            if (const auto* word = findWord(kTextureSources, member.name))
            {
                if (std::exchange(found, true)) return fail(member, "is a second source");
                source.kind = word->value;
                good = word->value == TextureSource::Kind::Unit
                           ? readIndex(member, kMostUnits, source.unit)
                           : readText(member, source.pattern);
            }
            else if (member.name == kLayer.name)
                good = readValue(member, kLayer, source.layer.emplace());
            else if (member.name == "optional")
                good = readFlag(member, source.optional);
            else if (member.name == "srgb" && channels.empty())
                good = readFlag(member, source.srgb.emplace());
            else if (member.name == "invert" && !channels.empty())
                good = readFlag(member, source.invert);
            else if (member.name == "channels" && !channels.empty())
                good = readChannels(member, source.channels);
            else
                return fail(member,
                            "does not belong here; there are sampler, unit, user, texture, "
                            "layer, optional, srgb for a colour, and channels and invert for "
                            "others");
            if (!good) return false;
        }
        return found || fail(json, "the object names no texture");
    }

    bool readChannels(const LocatedJson& json, std::string& channels)
    {
        constexpr const char* kWords[] = {"one letter", "two letters", "three letters"};
        const std::size_t count = channels.size();
        if (!readText(json, channels)) return false;
        if (channels.size() != count || channels.find_first_not_of("rgba") != std::string::npos)
            return fail(json, "'" + channels + "' is not " + kWords[count - 1] + " of rgba");
        return true;
    }

    ShaderRuleResult _result;
};

} // namespace

ShaderRuleResult readShaderRule(const LocatedJson& json, std::size_t number)
{
    return RuleReader(number).read(json);
}

bool ShaderRule::readsUserValues() const
{
    const auto ofUser = [](const ValueSource& s) { return s.kind == ValueSource::Kind::User; };
    return std::any_of(conditions.begin(), conditions.end(),
                       [](const ShaderCondition& condition)
                       { return condition.kind == ShaderCondition::Kind::User; }) ||
           std::any_of(parameters.begin(), parameters.end(),
                       [&](const ParameterRule& item) { return ofUser(item.source); }) ||
           std::any_of(textures.begin(), textures.end(),
                       [&](const auto& texture)
                       {
                           return texture && (texture->kind == TextureSource::Kind::User ||
                                              (texture->layer && ofUser(*texture->layer)));
                       }) ||
           (alphaReference && ofUser(*alphaReference));
}

} // namespace osgRayTrace::engine
