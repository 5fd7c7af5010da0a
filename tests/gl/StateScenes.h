// StateScenes.h - small geometries to put a state on. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "MatchPictures.h"

#include <osg/MatrixTransform>
#include <osg/Texture2D>

namespace osgRayTrace::test
{

constexpr auto kOn = osg::StateAttribute::ON;
constexpr auto kOff = osg::StateAttribute::OFF;

/// This is the largest mean difference that is allowed over the pixels that both pictures cover.
constexpr double kMostDifference = 2.0; ///< of 255

/// Returns a square in the plane z = 0 of one colour, with normals +z and texture coordinates from
/// 0 to repeat in units 0 and 1.
inline osg::ref_ptr<osg::Geometry> square(float half, const osg::Vec4& color = {1, 1, 1, 1},
                                          float repeat = 1.0f, float z = 0.0f)
{
    osg::ref_ptr<osg::Geometry> geometry = osg::createTexturedQuadGeometry(
        osg::Vec3(-half, -half, z), osg::Vec3(2.0f * half, 0.0f, 0.0f),
        osg::Vec3(0.0f, 2.0f * half, 0.0f), repeat, repeat);
    geometry->setTexCoordArray(1, geometry->getTexCoordArray(0));
    geometry->setColorArray(new osg::Vec4Array(1, &color), osg::Array::BIND_OVERALL);
    return geometry;
}

inline osg::ref_ptr<osg::Geometry> unlit(osg::ref_ptr<osg::Geometry> geometry)
{
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, kOff);
    return geometry;
}

/// Returns size*size texels of different colours and alpha, none of them black.
inline osg::ref_ptr<osg::Image> patchwork(int size, GLenum format = GL_RGBA)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(size, size, 1, format, GL_UNSIGNED_BYTE);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
        {
            const float s = (x + 0.5f) / size, t = (y + 0.5f) / size;
            image->setColor(osg::Vec4(0.2f + 0.8f * s, 0.1f + 0.9f * t, (x + y) % 2 ? 0.9f : 0.3f,
                                      (x / 2 + y / 2) % 2 ? 0.25f : 1.0f),
                            x, y);
        }
    return image;
}

inline osg::ref_ptr<osg::Texture2D>
textureOf(osg::Image* image, osg::Texture::WrapMode wrap = osg::Texture::REPEAT,
          osg::Texture::FilterMode filter = osg::Texture::LINEAR)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setWrap(osg::Texture::WRAP_S, wrap);
    texture->setWrap(osg::Texture::WRAP_T, wrap);
    texture->setFilter(osg::Texture::MIN_FILTER, filter);
    texture->setFilter(osg::Texture::MAG_FILTER, filter);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

inline osg::ref_ptr<osg::Group> groupOf(std::initializer_list<osg::ref_ptr<osg::Node>> nodes)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (const auto& node : nodes)
        group->addChild(node.get());
    return group;
}

inline osg::ref_ptr<osg::MatrixTransform> placed(const osg::Matrixd& matrix, osg::Node* child)
{
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
    transform->addChild(child);
    return transform;
}

/// Draws the scene both ways, prints the difference, and returns whether the two pictures are alike
/// in colours and coverage. The picture must be ray traced for the most part.
inline bool matches(const std::string& name, osg::Node* model, const MatchSetup& setup = {},
                    Statistics* statistics = nullptr)
{
    const Comparison comparison = match(name, model, setup, statistics);
    UNSCOPED_INFO(name << ": mean difference " << comparison.difference << " where both cover, "
                       << comparison.both << " pixels of " << comparison.either);
    return comparison.difference < kMostDifference && comparison.both > 500 &&
           comparison.both > 0.9 * comparison.either;
}

} // namespace osgRayTrace::test
