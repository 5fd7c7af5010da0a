// MaterialDetails.cpp - parameters as names and words, then the textures. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "MaterialDetails.h"

#include "TaggedWords.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/Notify>
#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

using osgRayTrace::Medium;
using osgRayTrace::PhysicalMaterial;

namespace
{

constexpr const char* kTextures[PhysicalMaterial::NUMBER_OF_TEXTURES] = {
    "baseColorTexture",
    "metallicRoughnessTexture",
    "transmissionTexture",
    "emissionTexture",
    "normalTexture",
    "specularTexture",
    "specularColorTexture",
    "clearcoatTexture",
    "clearcoatRoughnessTexture",
    "sheenColorTexture",
    "sheenRoughnessTexture",
    "anisotropyTexture",
    "diffuseTransmissionTexture",
    "diffuseTransmissionColorTexture",
    "iridescenceTexture",
    "iridescenceThicknessTexture",
    "clearcoatNormalTexture",
    "subsurfaceTexture",
    "subsurfaceRadiusTexture"};

PhysicalMaterial::TextureUse useOf(int number)
{
    return static_cast<PhysicalMaterial::TextureUse>(number);
}

/// Returns whether a texture is one that the wrapper has no serializer of its own for.
bool isDetail(int number)
{
    return number >= PhysicalMaterial::NORMAL_TEXTURE;
}

std::string wordOf(float value)
{
    return wordOfNumbers({value});
}

std::string wordOf(int value)
{
    return wordOfNumbers({static_cast<float>(value)});
}

std::string wordOf(bool value)
{
    return wordOfNumbers({value ? 1.0f : 0.0f});
}

std::string wordOf(const osg::Vec3& v)
{
    return wordOfNumbers({v.x(), v.y(), v.z()});
}

void read(const std::string& word, float& value)
{
    value = valuesOf(word, 1)[0];
}

void read(const std::string& word, int& value)
{
    value = static_cast<int>(valuesOf(word, 1)[0]);
}

void read(const std::string& word, bool& value)
{
    value = valuesOf(word, 1)[0] != 0.0f;
}

void read(const std::string& word, osg::Vec3& value)
{
    const std::vector<float> v = valuesOf(word, 3);
    value.set(v[0], v[1], v[2]);
}

/// Describes a parameter that is a number, a flag or a colour.
struct Parameter
{
    const char* name;
    std::string (*get)(const PhysicalMaterial&);
    void (*set)(PhysicalMaterial&, const std::string&);
};

/// Returns the parameter of a getter and a setter.
template <auto kGet, auto kSet> constexpr Parameter parameter(const char* name)
{
    return {name, [](const PhysicalMaterial& material) { return wordOf((material.*kGet)()); },
            [](PhysicalMaterial& material, const std::string& word)
            {
                std::decay_t<decltype((material.*kGet)())> value;
                read(word, value);
                (material.*kSet)(value);
            }};
}

/// Returns the parameter of a getter and a setter of the interior, which is made if it is set.
template <auto kGet, auto kSet> constexpr Parameter interior(const char* name)
{
    return {name,
            [](const PhysicalMaterial& material)
            {
                const osg::ref_ptr<const Medium> plain = new Medium;
                const Medium* medium =
                    material.getInterior() ? material.getInterior() : plain.get();
                return wordOf((medium->*kGet)());
            },
            [](PhysicalMaterial& material, const std::string& word)
            {
                std::decay_t<decltype((std::declval<const Medium&>().*kGet)())> value;
                read(word, value);
                if (!material.getInterior()) material.setInterior(new Medium);
                (material.getInterior()->*kSet)(value);
            }};
}

/// Returns a word of both the phase function and the size of droplets.
std::string dropletsOf(const PhysicalMaterial& material)
{
    const Medium* medium = material.getInterior();
    const bool droplets = medium && medium->getPhase() == Medium::DROPLETS;
    return wordOf(droplets ? medium->getDropletSize() : 0.0f);
}

void setDroplets(PhysicalMaterial& material, const std::string& word)
{
    float size = 0.0f;
    read(word, size);
    if (!material.getInterior()) material.setInterior(new Medium);
    material.getInterior()->setPhase(size > 0.0f ? Medium::DROPLETS : Medium::HENYEY_GREENSTEIN);
    if (size > 0.0f) material.getInterior()->setDropletSize(size);
}

using M = PhysicalMaterial;
constexpr Parameter kParameters[] = {
    parameter<&M::getAlpha, &M::setAlpha>("alpha"),
    parameter<&M::getVertexColors, &M::setVertexColors>("vertexColors"),
    parameter<&M::getNormalScale, &M::setNormalScale>("normalScale"),
    parameter<&M::getThinWalled, &M::setThinWalled>("thinWalled"),
    parameter<&M::getAttenuationColor, &M::setAttenuationColor>("attenuationColor"),
    parameter<&M::getAttenuationDistance, &M::setAttenuationDistance>("attenuationDistance"),
    interior<&Medium::getAbsorption, &Medium::setAbsorption>("interiorAbsorption"),
    interior<&Medium::getScattering, &Medium::setScattering>("interiorScattering"),
    interior<&Medium::getEmission, &Medium::setEmission>("interiorEmission"),
    interior<&Medium::getAnisotropy, &Medium::setAnisotropy>("interiorAnisotropy"),
    {"interiorDropletSize", dropletsOf, setDroplets},
    interior<&Medium::getPriority, &Medium::setPriority>("interiorPriority"),
    parameter<&M::getSpecular, &M::setSpecular>("specular"),
    parameter<&M::getSpecularColor, &M::setSpecularColor>("specularColor"),
    parameter<&M::getClearcoat, &M::setClearcoat>("clearcoat"),
    parameter<&M::getClearcoatRoughness, &M::setClearcoatRoughness>("clearcoatRoughness"),
    parameter<&M::getClearcoatNormalScale, &M::setClearcoatNormalScale>("clearcoatNormalScale"),
    parameter<&M::getSheenColor, &M::setSheenColor>("sheenColor"),
    parameter<&M::getSheenRoughness, &M::setSheenRoughness>("sheenRoughness"),
    parameter<&M::getAnisotropy, &M::setAnisotropy>("anisotropy"),
    parameter<&M::getAnisotropyRotation, &M::setAnisotropyRotation>("anisotropyRotation"),
    parameter<&M::getDiffuseTransmission, &M::setDiffuseTransmission>("diffuseTransmission"),
    parameter<&M::getDiffuseTransmissionColor, &M::setDiffuseTransmissionColor>(
        "diffuseTransmissionColor"),
    parameter<&M::getSubsurface, &M::setSubsurface>("subsurface"),
    parameter<&M::getSubsurfaceRadius, &M::setSubsurfaceRadius>("subsurfaceRadius"),
    parameter<&M::getIridescence, &M::setIridescence>("iridescence"),
    parameter<&M::getIridescenceIor, &M::setIridescenceIor>("iridescenceIor"),
    parameter<&M::getIridescenceThicknessMinimum, &M::setIridescenceThicknessMinimum>(
        "iridescenceThicknessMinimum"),
    parameter<&M::getIridescenceThicknessMaximum, &M::setIridescenceThicknessMaximum>(
        "iridescenceThicknessMaximum")};

/// Returns the parameters that are not defaults, by name. The word of a texture is 1.
Words wordsOf(const PhysicalMaterial& material)
{
    const osg::ref_ptr<PhysicalMaterial> plain = new PhysicalMaterial;
    Words words;
    for (const Parameter& parameter : kParameters)
    {
        std::string word = parameter.get(material);
        if (word != parameter.get(*plain)) words.emplace_back(parameter.name, std::move(word));
    }
    for (int i = 0; i < PhysicalMaterial::NUMBER_OF_TEXTURES; ++i)
    {
        const PhysicalMaterial::TexturePlace& p = material.getTexturePlace(useOf(i));
        if (!(p == PhysicalMaterial::TexturePlace()))
            words.emplace_back(kTextures[i] + std::string("Place"),
                               wordOfNumbers({float(p.unit), p.offset.x(), p.offset.y(), p.rotation,
                                              p.scale.x(), p.scale.y()}));
        if (isDetail(i) && material.getTexture(useOf(i))) words.emplace_back(kTextures[i], "1");
    }
    return words;
}

/// Returns the number of the texture that a word is about, or -1.
int textureOf(const std::string& name, const char* suffix)
{
    for (int i = 0; i < PhysicalMaterial::NUMBER_OF_TEXTURES; ++i)
        if (name == kTextures[i] + std::string(suffix)) return i;
    return -1;
}

/// Sets what a word says; returns false if this version does not know it.
bool setWord(PhysicalMaterial& material, const std::string& name, const std::string& word)
{
    for (const Parameter& parameter : kParameters)
    {
        if (name != parameter.name) continue;
        parameter.set(material, word);
        return true;
    }
    const int texture = textureOf(name, "Place");
    if (texture < 0) return false;
    const std::vector<float> v = valuesOf(word, 6);
    PhysicalMaterial::TexturePlace place;
    constexpr float kLastUnit = 7.0f;
    place.unit = v[0] >= 1.0f ? static_cast<unsigned int>(std::min(v[0], kLastUnit)) : 0;
    place.offset.set(v[1], v[2]);
    place.rotation = v[3];
    place.scale.set(v[4], v[5]);
    material.setTexturePlace(useOf(texture), place);
    return true;
}

bool isTexture(const std::string& name)
{
    const std::string suffix = "Texture";
    return name.size() > suffix.size() &&
           name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0;
}

/// Begins the parameters in binary files, which have it in no other place.
constexpr std::string_view kBinaryName = "osgRayTrace::PhysicalMaterial::Details";

class MaterialDetails : public osgDB::BaseSerializer
{
public:
    MaterialDetails() : osgDB::BaseSerializer(osgDB::BaseSerializer::READ_WRITE_PROPERTY) {}

    const std::string& getName() const override { return _name; }

    bool read(osgDB::InputStream& stream, osg::Object& object) override
    {
        if (!readsTag(stream, _name, kBinaryName)) return true;
        return readDetails(stream, static_cast<PhysicalMaterial&>(object));
    }

    bool write(osgDB::OutputStream& stream, const osg::Object& object) override
    {
        const auto& material = static_cast<const PhysicalMaterial&>(object);
        const Words words = wordsOf(material);
        if (words.empty()) return true;
        writeWords(stream, _name, kBinaryName, words);
        for (const auto& [name, word] : words)
            if (isTexture(name))
                stream.writeObject(material.getTexture(useOf(textureOf(name, ""))));
        stream << stream.END_BRACKET << std::endl;
        return true;
    }

private:
    static bool readDetails(osgDB::InputStream& stream, PhysicalMaterial& material)
    {
        std::vector<std::string> textures;
        for (const auto& [name, word] : readWords(stream))
        {
            if (isTexture(name))
                textures.push_back(name);
            else if (!setWord(material, name, word))
                OSG_WARN << "osgRayTrace: a PhysicalMaterial has a parameter " << name
                         << ", which this version does not know; ignored" << std::endl;
        }
        for (const std::string& name : textures)
        {
            if (stream.getException()) break;
            const osg::ref_ptr<osg::Object> object = stream.readObject();
            const int number = textureOf(name, "");
            auto* texture = dynamic_cast<osg::Texture2D*>(object.get());
            if (number >= 0 && texture) material.setTexture(useOf(number), texture);
        }
        stream >> stream.END_BRACKET;
        return !stream.getException();
    }

    const std::string _name = "Details";
};

} // namespace

osgDB::BaseSerializer* materialDetails()
{
    return new MaterialDetails;
}
