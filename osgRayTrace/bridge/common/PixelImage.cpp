// PixelImage.cpp - the engine's pixels as osg::Image. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/PixelImage.h"

#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace osgRayTrace::engine
{

namespace
{

constexpr uint64_t kMostBytes = 0xffffffffu;

unsigned int byteOf(float value)
{
    const float clamped = value > 0.0f ? std::min(value, 1.0f) : 0.0f; // NaN becomes 0
    return static_cast<unsigned int>(std::lround(255.0f * clamped));
}

} // namespace

osg::ref_ptr<osg::Image> newPixelImage(int width, int height, GLenum format, GLenum type)
{
    const uint64_t pixelBytes = osg::Image::computePixelSizeInBits(format, type) / 8;
    if (uint64_t(width) * uint64_t(height) * pixelBytes > kMostBytes)
    {
        warnOnce("the image is too large for osg::Image, which holds 4 GiB at most");
        return nullptr;
    }
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, format, type, 1);
    return image;
}

osg::ref_ptr<osg::Image> pixelImage(const std::vector<float>& values, int width, int height,
                                    GLenum format)
{
    const osg::ref_ptr<osg::Image> image = newPixelImage(width, height, format, GL_FLOAT);
    if (image) std::copy(values.begin(), values.end(), reinterpret_cast<float*>(image->data()));
    return image;
}

void blendOver(osg::Image& image, const osg::Vec4& color)
{
    const unsigned int below[4] = {byteOf(color.r()), byteOf(color.g()), byteOf(color.b()),
                                   byteOf(color.a())};
    unsigned char* const end = image.data() + image.getTotalSizeInBytes();
    for (unsigned char* pixel = image.data(); pixel != end; pixel += 4)
    {
        const unsigned int through = 255u - pixel[3];
        for (int i = 0; through > 0 && i < 4; ++i)
        {
            const unsigned int sum = pixel[i] + (through * below[i] + 127u) / 255u;
            pixel[i] = static_cast<unsigned char>(std::min(sum, 255u));
        }
    }
}

void blendOver(osg::Image& image, const osg::Image& background)
{
    const unsigned char* below = background.data();
    unsigned char* const end = image.data() + image.getTotalSizeInBytes();
    for (unsigned char* pixel = image.data(); pixel != end; pixel += 4, below += 4)
    {
        const unsigned int through = 255u - pixel[3];
        for (int i = 0; i < 3; ++i)
        {
            const unsigned int sum = pixel[i] + (through * below[i] + 127u) / 255u;
            pixel[i] = static_cast<unsigned char>(std::min(sum, 255u));
        }
        pixel[3] = 255;
    }
}

} // namespace osgRayTrace::engine
