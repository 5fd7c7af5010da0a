// WebpImage.h - images of EXT_texture_webp, decoded by libwebp: OSG has no plugin for them. Layer:
// osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

#include <cstdint>
#include <string>

namespace osgRayTrace::gltf
{

/// Returns whether the library is built in.
bool readsWebp();

/// Returns whether an image's first bytes are those of WebP.
inline bool isWebp(const std::string& bytes)
{
    return bytes.compare(0, 4, "RIFF") == 0 && bytes.size() >= 12 &&
           bytes.compare(8, 4, "WEBP") == 0;
}

/// Returns the number of pixels by the header of a WebP image; 0 if it does not say, is an
/// animation, or the library is not built in.
std::uint64_t webpPixels(const std::string& bytes);

/// Returns the image, its first row at the bottom; null if it cannot be decoded.
osg::ref_ptr<osg::Image> decodeWebp(const std::string& bytes);

} // namespace osgRayTrace::gltf
