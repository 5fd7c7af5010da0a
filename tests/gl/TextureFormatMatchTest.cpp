// TextureFormatMatchTest.cpp - textures of all pixel formats, beside OpenGL's. Layer: tests.
// SPDX-License-Identifier: MIT
// SPDX-License-Identifier: MIT
#include "StateScenes.h"

#include <osg/TexEnv>
#include <osg/TexGen>
#include <osg/TexGenNode>
#include <osg/TexMat>
#include <osg/Texture1D>
#include <osg/Texture3D>
#include <osg/TextureCubeMap>
#include <osg/TextureRectangle>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// Returns an image of any format with bytes made by a hash: whatever they mean, OpenGL and tracing
/// must agree.
osg::ref_ptr<osg::Image> anyImage(GLenum format, GLenum type)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(8, 8, 1, format, type);
    unsigned char* bytes = image->data();
    uint32_t x = 12345;
    for (unsigned int i = 0; i < image->getTotalSizeInBytes(); ++i)
    {
        x = x * 1664525u + 1013904223u;
        bytes[i] = static_cast<unsigned char>(x >> 24);
    }
    if (type == GL_FLOAT)
        for (unsigned int i = 0; i < image->getTotalSizeInBytes() / 4; ++i)
            reinterpret_cast<float*>(bytes)[i] = float(bytes[4 * i]) / 255.0f;
    if (type == GL_HALF_FLOAT)
        for (unsigned int i = 0; i < image->getTotalSizeInBytes() / 2; ++i)
            reinterpret_cast<uint16_t*>(bytes)[i] &= 0x3bffu; // 0 to 1
    return image;
}

/// Returns a square with a texture whose alpha shows, too: a background of another colour.
osg::ref_ptr<osg::Group> blended(osg::Texture* texture)
{
    const auto front = unlit(square(3.0f, {1, 1, 1, 1}, 1.0f, 0.1f));
    osg::StateSet& state = *front->getStateSet();
    state.setTextureAttributeAndModes(0, texture);
    state.setMode(GL_BLEND, kOn);
    state.setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    return groupOf({unlit(square(3.5f, osg::Vec4(0.2f, 0.5f, 0.8f, 1.0f))), front});
}

} // namespace

TEST_CASE("match: pixel formats, packed, wide and compressed", "[gl][coverage]")
{
    struct Format
    {
        const char* name;
        GLenum format, type;
    };
    const Format formats[] = {{"rgba", GL_RGBA, GL_UNSIGNED_BYTE},
                              {"bgra", GL_BGRA, GL_UNSIGNED_BYTE},
                              {"luminance", GL_LUMINANCE, GL_UNSIGNED_BYTE},
                              {"luminance-alpha", GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE},
                              {"alpha", GL_ALPHA, GL_UNSIGNED_BYTE},
                              {"red", GL_RED, GL_UNSIGNED_BYTE},
                              {"rgb-short", GL_RGB, GL_UNSIGNED_SHORT},
                              {"rgb-float", GL_RGB, GL_FLOAT},
                              {"rgb-half", GL_RGB, GL_HALF_FLOAT},
                              {"5-6-5", GL_RGB, GL_UNSIGNED_SHORT_5_6_5},
                              {"3-3-2", GL_RGB, GL_UNSIGNED_BYTE_3_3_2},
                              {"4-4-4-4", GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4},
                              {"4-4-4-4-rev", GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4_REV},
                              {"5-5-5-1", GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1},
                              {"1-5-5-5-rev-bgra", GL_BGRA, GL_UNSIGNED_SHORT_1_5_5_5_REV},
                              {"8-8-8-8", GL_RGBA, GL_UNSIGNED_INT_8_8_8_8},
                              {"2-10-10-10-rev", GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV},
                              {"dxt1", GL_COMPRESSED_RGB_S3TC_DXT1_EXT, GL_UNSIGNED_BYTE},
                              {"dxt1a", GL_COMPRESSED_RGBA_S3TC_DXT1_EXT, GL_UNSIGNED_BYTE},
                              {"dxt3", GL_COMPRESSED_RGBA_S3TC_DXT3_EXT, GL_UNSIGNED_BYTE},
                              {"dxt5", GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, GL_UNSIGNED_BYTE},
                              {"rgtc1", GL_COMPRESSED_RED_RGTC1_EXT, GL_UNSIGNED_BYTE},
                              {"rgtc2", GL_COMPRESSED_RED_GREEN_RGTC2_EXT, GL_UNSIGNED_BYTE}};
    for (const Format& format : formats)
    {
        const auto image = anyImage(format.format, format.type);
        if (format.format == GL_BGRA) image->setInternalTextureFormat(GL_RGBA);
        const auto texture = textureOf(image, osg::Texture::REPEAT, osg::Texture::NEAREST);
        CHECK(matches(std::string("format-") + format.name, blended(texture)));
    }
}

/// Returns four blocks of one colour each, which compression keeps.
static osg::ref_ptr<osg::Image> blocks(GLenum format)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(8, 8, 1, format, GL_UNSIGNED_BYTE);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            image->setColor(osg::Vec4(x < 4 ? 1.0f : 0.0f, y < 4 ? 1.0f : 0.0f, 1.0f,
                                      (x < 4) == (y < 4) ? 0.25f : 1.0f),
                            x, y);
    return image;
}

TEST_CASE("match: textures that OpenGL compresses", "[gl]")
{
    using osg::Texture;
    struct Mode
    {
        const char* name;
        Texture::InternalFormatMode mode;
        GLenum format;
    };
    const Mode modes[] = {{"arb", Texture::USE_ARB_COMPRESSION, GL_RGB},
                          {"dxt1", Texture::USE_S3TC_DXT1_COMPRESSION, GL_RGB},
                          {"dxt1c", Texture::USE_S3TC_DXT1c_COMPRESSION, GL_RGBA},
                          {"dxt3", Texture::USE_S3TC_DXT3_COMPRESSION, GL_RGB},
                          {"dxt5", Texture::USE_S3TC_DXT5_COMPRESSION, GL_RGBA}};
    for (const Mode& mode : modes)
    {
        const auto texture = textureOf(blocks(mode.format), Texture::REPEAT, Texture::NEAREST);
        texture->setInternalFormatMode(mode.mode);
        CHECK(matches(std::string("compressed-") + mode.name, blended(texture)));
    }
}
