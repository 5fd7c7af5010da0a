// TextureFormats.h - the channels that OpenGL's texture formats have. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GL>

namespace osgRayTrace::engine
{

struct TextureChannels
{
    bool color = true; ///< false: alpha alone
    bool alpha = true;
};

/// Of the base format of OpenGL's internal format [OpenGL21, table 3.15 and 3.16]; of the image's
/// pixel format where the internal one is not known.
TextureChannels textureChannels(GLint internalFormat, GLenum pixelFormat);

} // namespace osgRayTrace::engine
