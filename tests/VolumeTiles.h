// VolumeTiles.h - tiles of osgVolume, for tests. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osg/TransferFunction>
#include <osgVolume/MultipassTechnique>
#include <osgVolume/Property>
#include <osgVolume/RayTracedTechnique>
#include <osgVolume/VolumeScene>
#include <osgVolume/VolumeTile>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::test
{

/// Returns an image with a soft ball, of luminance or of RGBA with colours by place.
inline osg::ref_ptr<osg::Image> ballImage(int size, GLenum format = GL_LUMINANCE,
                                          double radius = 0.45)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(size, size, size, format, GL_UNSIGNED_BYTE);
    const double middle = 0.5 * (size - 1);
    const auto byte = [](double value)
    { return static_cast<unsigned char>(std::clamp(255.0 * value, 0.0, 255.0)); };
    for (int z = 0; z < size; ++z)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
            {
                const osg::Vec3d p(x - middle, y - middle, z - middle);
                const double value = 1.0 - p.length() / (radius * size);
                unsigned char* pixel = image->data(x, y, z);
                if (format == GL_RGBA)
                {
                    *pixel++ = byte(double(x) / size);
                    *pixel++ = byte(double(y) / size);
                    *pixel++ = byte(double(z) / size);
                }
                *pixel = byte(value);
            }
    return image;
}

/// Returns a function from blue and faint to yellow and dense, zero at both ends.
inline osg::ref_ptr<osg::TransferFunction1D> blueToYellow(float opacity = 0.4f)
{
    osg::ref_ptr<osg::TransferFunction1D> transfer = new osg::TransferFunction1D;
    transfer->setColor(0.0f, osg::Vec4(0.1f, 0.2f, 0.9f, 0.0f));
    transfer->setColor(0.3f, osg::Vec4(0.1f, 0.6f, 0.8f, 0.2f * opacity));
    transfer->setColor(0.7f, osg::Vec4(0.9f, 0.8f, 0.2f, opacity));
    transfer->setColor(1.0f, osg::Vec4(1.0f, 0.9f, 0.3f, opacity));
    return transfer;
}

/// Returns a tile of an image in a box, with a transfer function or without (null).
inline osg::ref_ptr<osgVolume::VolumeTile> tileOf(osg::Image* image,
                                                  osg::TransferFunction1D* transfer,
                                                  osgVolume::VolumeTechnique* technique,
                                                  const osg::Matrixd& locator)
{
    osg::ref_ptr<osgVolume::VolumeTile> tile = new osgVolume::VolumeTile;
    osg::ref_ptr<osgVolume::ImageLayer> layer = new osgVolume::ImageLayer(image);
    layer->setLocator(new osgVolume::Locator(locator));
    tile->setLocator(layer->getLocator());
    osg::ref_ptr<osgVolume::CompositeProperty> properties = new osgVolume::CompositeProperty;
    if (transfer) properties->addProperty(new osgVolume::TransferFunctionProperty(transfer));
    layer->setProperty(properties.get());
    tile->setLayer(layer.get());
    tile->setVolumeTechnique(technique);
    return tile;
}

inline void addProperty(osgVolume::VolumeTile& tile, osgVolume::Property* property)
{
    static_cast<osgVolume::CompositeProperty*>(tile.getLayer()->getProperty())
        ->addProperty(property);
}

} // namespace osgRayTrace::test
