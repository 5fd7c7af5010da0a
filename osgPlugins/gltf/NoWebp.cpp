// NoWebp.cpp - stands for WebpImage.cpp if libwebp was not found. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/WebpImage.h"

namespace osgRayTrace::gltf
{

bool readsWebp()
{
    return false;
}

std::uint64_t webpPixels(const std::string&)
{
    return 0;
}

osg::ref_ptr<osg::Image> decodeWebp(const std::string&)
{
    return nullptr;
}

} // namespace osgRayTrace::gltf
