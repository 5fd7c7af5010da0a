// MediumVolume.cpp - Medium and MediumVolume in .osgt, .osgb and .osgx files. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "ClassicLocale.h"
#include "TaggedWords.h"

#include <osgRayTrace/MediumVolume>

#include <osg/Notify>
#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

namespace medium
{

REGISTER_OBJECT_WRAPPER(osgRayTrace_Medium, new osgRayTrace::Medium, osgRayTrace::Medium,
                        "osg::Object osgRayTrace::Medium")
{
    ADD_VEC3_SERIALIZER(Absorption, osg::Vec3());
    ADD_VEC3_SERIALIZER(Scattering, osg::Vec3());
    ADD_VEC3_SERIALIZER(Emission, osg::Vec3());
    ADD_FLOAT_SERIALIZER(Anisotropy, 0.0f);
    ADD_INT_SERIALIZER(Priority, 0);
    BEGIN_ENUM_SERIALIZER(Phase, HENYEY_GREENSTEIN);
    ADD_ENUM_VALUE(HENYEY_GREENSTEIN);
    ADD_ENUM_VALUE(DROPLETS);
    END_ENUM_SERIALIZER();
    ADD_FLOAT_SERIALIZER(DropletSize, 10.0f);
    writeInClassicLocale(*wrapper);
}

} // namespace medium

namespace volume
{

using osgRayTrace::MediumVolume;

/// The shape of a volume with its lengths, if it is not EVERYWHERE.
class ShapeWords : public osgDB::BaseSerializer
{
public:
    ShapeWords() : osgDB::BaseSerializer(osgDB::BaseSerializer::READ_WRITE_PROPERTY) {}

    const std::string& getName() const override { return _name; }

    bool read(osgDB::InputStream& stream, osg::Object& object) override
    {
        if (!readsTag(stream, _name, kBinaryName)) return true;
        auto& volume = static_cast<MediumVolume&>(object);
        for (const auto& [name, word] : readWords(stream))
            setWord(volume, name, word);
        stream >> stream.END_BRACKET;
        return !stream.getException();
    }

    bool write(osgDB::OutputStream& stream, const osg::Object& object) override
    {
        const Words words = wordsOf(static_cast<const MediumVolume&>(object));
        if (words.empty()) return true;
        writeWords(stream, _name, kBinaryName, words);
        stream << stream.END_BRACKET << std::endl;
        return true;
    }

private:
    static Words wordsOf(const MediumVolume& volume)
    {
        const osg::ref_ptr<const MediumVolume> plain = new MediumVolume;
        const osg::BoundingBox &box = volume.getBox(), &unit = plain->getBox();
        Words words;
        if (volume.getShape() != plain->getShape())
            words.emplace_back("shape", volume.getShape() == MediumVolume::BOX ? "BOX" : "LAYER");
        if (volume.getScaleHeight() != plain->getScaleHeight())
            words.emplace_back("scaleHeight", wordOfNumbers({volume.getScaleHeight()}));
        if (box._min != unit._min || box._max != unit._max)
            words.emplace_back("box", wordOfNumbers({box.xMin(), box.yMin(), box.zMin(), box.xMax(),
                                                     box.yMax(), box.zMax()}));
        return words;
    }

    static void setWord(MediumVolume& volume, const std::string& name, const std::string& word)
    {
        const std::vector<float> v = valuesOf(word, 6);
        if (name == "shape" && (word == "BOX" || word == "LAYER"))
            volume.setShape(word == "BOX" ? MediumVolume::BOX : MediumVolume::LAYER);
        else if (name == "scaleHeight")
            volume.setScaleHeight(v[0]);
        else if (name == "box")
            volume.setBox({v[0], v[1], v[2], v[3], v[4], v[5]});
        else
            OSG_WARN << "osgRayTrace: a MediumVolume has a " << name << " " << word
                     << ", which this version does not know; ignored" << std::endl;
    }

    /// Begins the words in binary files.
    static constexpr std::string_view kBinaryName = "osgRayTrace::MediumVolume::Extent";

    const std::string _name = "Extent";
};

REGISTER_OBJECT_WRAPPER(osgRayTrace_MediumVolume, new osgRayTrace::MediumVolume,
                        osgRayTrace::MediumVolume,
                        "osg::Object osg::Node osgRayTrace::MediumVolume")
{
    ADD_OBJECT_SERIALIZER(Medium, osgRayTrace::Medium, nullptr);
    ADD_FLOAT_SERIALIZER(Radius, 0.0f);
    wrapper->addSerializer(new ShapeWords, osgDB::BaseSerializer::RW_USER);
    writeInClassicLocale(*wrapper);
}

} // namespace volume
