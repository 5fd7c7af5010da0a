// TextureDecoder.h - decodes the texels, wrap and filter modes of an osg::Texture. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

#include <osg/Texture>

#include <string>

namespace osgRayTrace::engine
{

TextureWrap wrapOf(const osg::Texture& texture, osg::Texture::WrapParameter direction);

/// Returns the border colour: finite, and in [0, 1] as OpenGL clamps it for textures of fixed-point
/// formats.
Vec4 borderOf(const osg::Texture& texture);

bool isSrgbFormat(GLint internalFormat);

/// Returns whether a look-up takes one texel of its image or mip, not the mean of four.
bool isNearest(osg::Texture::FilterMode mode);

/// Returns whether the texture is looked up in mips if it is minified, as in OpenGL. 1-D textures
/// are not: footprints are areas, and lines of texels have none.
bool wantsMips(const osg::Texture& texture);

/// Returns whether OpenGL blends two mips; false: it takes the nearest one.
bool blendsMips(osg::Texture::FilterMode minification);

bool isVolume(const osg::Texture& texture);

unsigned int imageCount(const osg::Texture& texture);

std::string nameOf(const osg::Texture& texture, const osg::Image& image);

/// Returns whether the image has more texels than the engine takes, or than osg::Image can address
/// in the 32 bits of its offsets.
bool isTooLarge(const osg::Image& image, int slices);

void fillMagenta(Texture& texture);

/// Sets the channels of the texture. Channels that OpenGL's base format lacks never reach the
/// texture environment [OpenGL21, table 3.22].
void setChannels(GLint internalFormat, GLenum pixelFormat, Texture& texture);

bool decodeTexture(const osg::Texture& source, Texture& texture);

} // namespace osgRayTrace::engine
