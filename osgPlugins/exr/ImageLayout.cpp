// ImageLayout.cpp - the table of layouts. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/exr/ImageLayout.h"

#include "osgRayTrace/base/NeverDestroyed.h"

#include <osg/Texture>

namespace osgRayTrace::engine
{

namespace
{

const std::vector<ImageLayout>& layouts()
{
    static const NeverDestroyed<std::vector<ImageLayout>> table(std::vector<ImageLayout>{
        {GL_RGB, {"R", "G", "B"}, GL_RGB32F_ARB, GL_RGB16F_ARB},
        {GL_RGBA, {"R", "G", "B", "A"}, GL_RGBA32F_ARB, GL_RGBA16F_ARB},
        {GL_LUMINANCE, {"Y"}, GL_LUMINANCE32F_ARB, GL_LUMINANCE16F_ARB},
        {GL_LUMINANCE_ALPHA, {"Y", "A"}, GL_LUMINANCE_ALPHA32F_ARB, GL_LUMINANCE_ALPHA16F_ARB},
        {GL_ALPHA, {"A"}, GL_ALPHA32F_ARB, GL_ALPHA16F_ARB},
        {GL_BGR, {"B", "G", "R"}},
        {GL_BGRA, {"B", "G", "R", "A"}},
        {GL_RED, {"Y"}},
        {GL_INTENSITY, {"Y"}},
        {GL_DEPTH_COMPONENT, {"Y"}},
    });
    return *table;
}

} // namespace

GLint ImageLayout::internalFormat(GLenum type) const
{
    if (type == GL_FLOAT) return floatTexture;
    return type == GL_HALF_FLOAT ? halfTexture : static_cast<GLint>(pixelFormat);
}

const ImageLayout& layoutOf(GLenum pixelFormat)
{
    static const NeverDestroyed<ImageLayout> none(ImageLayout{GL_NONE, {}});
    for (const ImageLayout& layout : layouts())
    {
        if (layout.pixelFormat == pixelFormat) return layout;
    }
    return *none;
}

GLenum formatOf(const ExrImage& image)
{
    const bool alpha = image.find("A") != nullptr;
    if (image.find("R") || image.find("G") || image.find("B")) return alpha ? GL_RGBA : GL_RGB;
    if (image.find("Y")) return alpha ? GL_LUMINANCE_ALPHA : GL_LUMINANCE;
    return alpha ? GL_ALPHA : GL_NONE;
}

} // namespace osgRayTrace::engine
