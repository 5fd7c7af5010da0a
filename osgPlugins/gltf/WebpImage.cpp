// WebpImage.cpp - calls libwebp. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/WebpImage.h"

#include <webp/decode.h>

namespace osgRayTrace::gltf
{

namespace
{

const std::uint8_t* dataOf(const std::string& bytes)
{
    return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

} // namespace

bool readsWebp()
{
    return true;
}

std::uint64_t webpPixels(const std::string& bytes)
{
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(dataOf(bytes), bytes.size(), &features) != VP8_STATUS_OK) return 0;
    if (features.has_animation || features.width <= 0 || features.height <= 0) return 0;
    return std::uint64_t(features.width) * std::uint64_t(features.height);
}

osg::ref_ptr<osg::Image> decodeWebp(const std::string& bytes)
{
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(dataOf(bytes), bytes.size(), &features) != VP8_STATUS_OK) return nullptr;
    if (features.has_animation) return nullptr;
    const int width = features.width, height = features.height;
    const bool alpha = features.has_alpha != 0;
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, alpha ? GL_RGBA : GL_RGB, GL_UNSIGNED_BYTE);
    if (!image->data()) return nullptr;
    const int stride = static_cast<int>(image->getRowSizeInBytes());
    const auto* decoded = alpha ? WebPDecodeRGBAInto(dataOf(bytes), bytes.size(), image->data(),
                                                     image->getTotalSizeInBytes(), stride)
                                : WebPDecodeRGBInto(dataOf(bytes), bytes.size(), image->data(),
                                                    image->getTotalSizeInBytes(), stride);
    if (!decoded) return nullptr;
    image->setInternalTextureFormat(alpha ? GL_RGBA : GL_RGB);
    image->flipVertical();
    return image;
}

} // namespace osgRayTrace::gltf
