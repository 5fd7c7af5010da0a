// Serializers.h - objects written to OSG's native formats and read again. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Catch.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/Texture2D>
#include <osgDB/Registry>

#include <algorithm>
#include <sstream>
#include <string>

namespace osgRayTrace::test
{

struct Format
{
    const char* extension;
    const char* fileType; ///< the name by which OSG's stream reader knows the format
};

constexpr Format kFormats[] = {{"osgt", "Ascii"}, {"osgb", "Binary"}, {"osgx", "XML"}};

inline osg::ref_ptr<osgDB::Options> optionsOf(const Format& format)
{
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("WriteImageHint=IncludeData");
    options->setPluginStringData("fileType", format.fileType);
    return options;
}

inline osgDB::ReaderWriter& readerWriter(const Format& format)
{
    auto* found = osgDB::Registry::instance()->getReaderWriterForExtension(format.extension);
    REQUIRE(found);
    return *found;
}

inline std::string written(const osg::Object& object, const Format& format)
{
    std::ostringstream stream;
    const auto result = readerWriter(format).writeObject(object, stream, optionsOf(format));
    REQUIRE(result.success());
    return stream.str();
}

inline osg::ref_ptr<osg::Object> read(const std::string& text, const Format& format)
{
    std::istringstream stream(text);
    const osg::ref_ptr<osgDB::Options> options = optionsOf(format);
    auto result = readerWriter(format).readObject(stream, options);
    return result.getObject();
}

template <typename T> osg::ref_ptr<T> roundTrip(const T& object, const Format& format)
{
    const osg::ref_ptr<osg::Object> copy = read(written(object, format), format);
    REQUIRE(copy);
    osg::ref_ptr<T> typed = dynamic_cast<T*>(copy.get());
    REQUIRE(typed);
    return typed;
}

inline osg::ref_ptr<osg::Texture2D> texture(unsigned char value)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::fill(image->data(), image->data() + image->getTotalSizeInBytes(), value);
    return new osg::Texture2D(image);
}

inline int valueOf(const osg::Texture2D* texture)
{
    return texture && texture->getImage() ? texture->getImage()->data()[0] : -1;
}

inline osg::ref_ptr<PhysicalMaterial> glass()
{
    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setName("glass");
    material->setBaseColor(osg::Vec3(0.25f, 0.5f, 0.75f));
    material->setMetallic(0.125f);
    material->setRoughness(0.375f);
    material->setTransmission(0.625f);
    material->setIor(2.25f);
    material->setEmission(osg::Vec3(1.5f, 2.5f, 300.0f));
    material->setBaseColorTexture(texture(1));
    material->setMetallicRoughnessTexture(texture(2));
    material->setTransmissionTexture(texture(3));
    material->setEmissionTexture(texture(4));
    return material;
}

} // namespace osgRayTrace::test
