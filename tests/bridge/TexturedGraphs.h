// TexturedGraphs.h - small images, and graphs that wear them, for the tests of the bridge. Layer:
// tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osg/Texture2D>

#include <cstring>
#include <vector>

namespace osgRayTrace::engine
{

using Bytes = std::vector<uint8_t>;
using Floats = std::vector<float>;

/// Returns an image that owns a copy of the values.
template <class Scalar>
osg::ref_ptr<osg::Image> imageOf(int width, int height, GLenum format, GLenum type,
                                 const std::vector<Scalar>& values, int packing = 1)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, format, type, packing);
    REQUIRE(image->getTotalSizeInBytes() >= values.size() * sizeof(Scalar));
    std::memcpy(image->data(), values.data(), values.size() * sizeof(Scalar));
    return image;
}

inline osg::ref_ptr<osg::Texture2D> smallTexture()
{
    osg::ref_ptr<osg::Texture2D> texture =
        new osg::Texture2D(imageOf<uint8_t>(1, 1, GL_RGB, GL_UNSIGNED_BYTE, {10, 20, 30}));
    texture->setName("small");
    return texture;
}

inline osg::ref_ptr<osg::Geometry> texturedGeometry(osg::StateAttribute* texture)
{
    const auto geometry = triangleGeometry();
    geometry->setTexCoordArray(0, new osg::Vec2Array(3));
    geometry->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture,
                                                                 osg::StateAttribute::ON);
    return geometry;
}

} // namespace osgRayTrace::engine
