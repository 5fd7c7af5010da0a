// TexturesTest.cpp - texture state, and textures that are not sampled.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/TexturedGraphs.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/Program>
#include <osg/TexEnv>
#include <osg/TexEnvCombine>
#include <osg/Texture1D>
#include <osg/Texture2DArray>
#include <osg/Texture2DMultisample>
#include <osg/Texture3D>
#include <osg/TextureBuffer>
#include <osg/TextureCubeMap>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

constexpr auto kOn = osg::StateAttribute::ON;

} // namespace

TEST_CASE("texture unit 0: attribute, mode, filter, wrap and environment", "[bridge]")
{
    const auto texture = smallTexture();
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::MIRROR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    const auto geometry = texturedGeometry(texture);
    osg::StateSet* state = geometry->getStateSet();

    ConversionResult result = convertGraph(geometry);
    REQUIRE(soleMaterial(result).baseColorTexture == 0);
    const Texture& converted = *result.scene->textures.at(0);
    CHECK(converted.name == "small");
    CHECK(converted.bytes == Bytes{10, 20, 30, 255});
    CHECK(converted.wrapS == TextureWrap::Repeat);
    CHECK(converted.wrapT == TextureWrap::Mirror);
    CHECK_FALSE(converted.linearFilter);
    CHECK_FALSE(converted.decodeSrgb);
    CHECK(soleMaterial(result).textureEnvironment == TextureEnvironment::Modulate);

    state->setTextureAttribute(0, new osg::TexEnv(osg::TexEnv::REPLACE));
    CHECK(soleMaterial(convertGraph(geometry)).textureEnvironment == TextureEnvironment::Replace);
    state->setTextureAttribute(0, new osg::TexEnv(osg::TexEnv::DECAL));
    CHECK(soleMaterial(convertGraph(geometry)).textureEnvironment == TextureEnvironment::Decal);
    state->setTextureAttribute(0, new osg::TexEnvCombine);
    result = convertGraph(geometry);
    CHECK(soleMaterial(result).textureEnvironment == TextureEnvironment::Modulate);
    CHECK(countOf(result, "approximated.texture-environment") == 1);

    state->setTextureMode(0, GL_TEXTURE_2D, osg::StateAttribute::OFF);
    result = convertGraph(geometry);
    CHECK(soleMaterial(result).baseColorTexture == kInvalid);
    CHECK(result.scene->textures.empty());
}

TEST_CASE("textures have mips if their minification filter asks for them, and only then",
          "[bridge]")
{
    const auto texture = smallTexture();
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(8, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::fill_n(image->data(), image->getTotalSizeInBytes(), 100);
    texture->setImage(image);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    const auto geometry = texturedGeometry(texture);
    SceneConverter converter;
    struct Expected
    {
        osg::Texture::FilterMode filter;
        std::size_t mips;
        bool linear, blends;
    };
    for (const Expected& expected :
         {Expected{osg::Texture::LINEAR, 0, true, true},
          Expected{osg::Texture::LINEAR_MIPMAP_LINEAR, 3, true, true},
          Expected{osg::Texture::NEAREST_MIPMAP_LINEAR, 3, false, true},
          Expected{osg::Texture::LINEAR_MIPMAP_NEAREST, 3, true, false},
          Expected{osg::Texture::NEAREST_MIPMAP_NEAREST, 3, false, false},
          Expected{osg::Texture::NEAREST, 0, true, true}})
    {
        texture->setFilter(osg::Texture::MIN_FILTER, expected.filter); // one converter: a live edit
        const ConversionResult result = converter.convert(inputFor(geometry));
        const Texture& converted = *result.scene->textures.at(0);
        CAPTURE(int(expected.filter));
        CHECK(converted.linearFilter); // close to, the other filter decides
        REQUIRE(converted.mips.size() == expected.mips);
        if (converted.mips.empty()) continue;
        CHECK(converted.mips[0].width == 4);
        CHECK(converted.mips[0].height == 1);
        CHECK(converted.mips[0].bytes[0] == 100);
        CHECK(converted.mips[0].linearFilter == expected.linear);
        CHECK(converted.blendsMips == expected.blends);
    }
}

TEST_CASE("textures that are never looked up in mips have none", "[bridge]")
{
    const auto imageOfTexels = [](int height)
    {
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(8, height, 1, GL_RGB, GL_UNSIGNED_BYTE);
        std::fill_n(image->data(), image->getTotalSizeInBytes(), 100);
        return image;
    };
    SECTION("normal maps, unless something else reads them, too")
    {
        const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(imageOfTexels(8));
        const auto geometry = texturedGeometry(texture);
        const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
        material->setTexture(PhysicalMaterial::NORMAL_TEXTURE, texture);
        geometry->getOrCreateStateSet()->setAttribute(material);
        SceneConverter converter;
        const auto mips = [&]
        {
            const ConversionResult result = converter.convert(inputFor(geometry));
            return result.scene->textures.at(soleMaterial(result).detail->textures[kNormalRole])
                ->mips.size();
        };
        CHECK(mips() == 0);
        material->setClearcoat(1.0f);
        material->setTexture(PhysicalMaterial::CLEARCOAT_TEXTURE, texture);
        CHECK(mips() == 3);
        CHECK(mips() == 3);
        material->setTransmission(1.0f);
        material->setTransmissionTexture(texture); // this role comes before that of normals
        texture->getImage()->dirty();
        CHECK(mips() == 3);
    }
    SECTION("1-D textures, as footprints are areas")
    {
        const osg::ref_ptr<osg::Texture1D> texture = new osg::Texture1D(imageOfTexels(1));
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
        const ConversionResult result = convertGraph(texturedGeometry(texture));
        CHECK(result.scene->textures.at(0)->mips.empty());
    }
}

TEST_CASE("textures that cannot be sampled are left out and counted", "[bridge]")
{
    SECTION("no image on the CPU")
    {
        const ConversionResult result = convertGraph(texturedGeometry(new osg::Texture2D));
        CHECK(soleMaterial(result).baseColorTexture == kInvalid);
        CHECK(countOf(result, "approximated.texture-without-image") == 1);
    }
    SECTION("an image whose file was not read")
    {
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->setFileName("bricks.png"); // as osgDB leaves the image
        const ConversionResult result = convertGraph(texturedGeometry(new osg::Texture2D(image)));
        CHECK(soleMaterial(result).baseColorTexture == kInvalid);
        CHECK(countOf(result, "approximated.texture-without-image") == 0);
        CHECK(countOf(result, "missing.texture-image") == 1);
        const auto& files = result.paths.at("missing.texture-image");
        REQUIRE(files.size() == 1);
        CHECK(files[0].find("bricks.png, for ") == 0);
    }
    SECTION("but one without coordinates is looked up at the corner, as in OpenGL")
    {
        const auto geometry = texturedGeometry(smallTexture());
        geometry->setTexCoordArray(0, nullptr);
        const ConversionResult result = convertGraph(geometry);
        CHECK(soleMaterial(result).baseColorTexture == 0);
        CHECK(soleMesh(result).uvs.empty());
    }
    SECTION("generated coordinates that nothing generates")
    {
        const auto geometry = texturedGeometry(smallTexture());
        geometry->getStateSet()->setTextureMode(0, GL_TEXTURE_GEN_S, kOn);
        const ConversionResult result = convertGraph(geometry);
        CHECK(soleMaterial(result).baseColorTexture == kInvalid);
        CHECK(countOf(result, "approximated.no-texture-coordinates") == 1);
    }
    SECTION("a cube without faces")
    {
        const ConversionResult result = convertGraph(texturedGeometry(new osg::TextureCubeMap));
        CHECK(soleMaterial(result).baseColorTexture == kInvalid);
        CHECK(countOf(result, "approximated.texture-without-image") == 1);
    }
    SECTION("higher units")
    {
        const auto geometry = triangleGeometry();
        geometry->getOrCreateStateSet()->setTextureAttributeAndModes(2, smallTexture(), kOn);
        const ConversionResult result = convertGraph(geometry);
        CHECK(soleMaterial(result).baseColorTexture == kInvalid);
        CHECK(countOf(result, "approximated.texture-unit") == 1);
    }
    SECTION("an unknown pixel format is magenta")
    {
        const auto wrong = imageOf<uint16_t>(1, 1, GL_RGBA, GL_UNSIGNED_SHORT_5_6_5, {0});
        const ConversionResult result = convertGraph(texturedGeometry(new osg::Texture2D(wrong)));
        CHECK(countOf(result, "approximated.pixel-format") == 1);
        REQUIRE(soleMaterial(result).baseColorTexture == 0);
        CHECK(result.scene->textures[0]->bytes == Bytes{255, 0, 255, 255});
    }
}

TEST_CASE("textures that only programs read: drawn with one, and nothing without", "[bridge]")
{
    const osg::ref_ptr<osg::Texture2DArray> array = new osg::Texture2DArray;
    array->setTextureSize(1, 1, 2);
    for (unsigned int layer : {0u, 1u})
        array->setImage(layer, imageOf<uint8_t>(1, 1, GL_RGB, GL_UNSIGNED_BYTE, {10, 20, 30}));
    const std::pair<osg::ref_ptr<osg::Texture>, GLenum> textures[] = {
        {array, GL_TEXTURE_2D_ARRAY_EXT},
        {new osg::TextureBuffer(
             imageOf<uint8_t>(2, 1, GL_RGBA, GL_UNSIGNED_BYTE, {1, 2, 3, 4, 5, 6, 7, 8})),
         GL_TEXTURE_BUFFER_ARB},
        {new osg::Texture2DMultisample(4, false), GL_TEXTURE_2D_MULTISAMPLE}};
    for (const auto& [texture, target] : textures)
    {
        const auto geometry = triangleGeometry();
        osg::StateSet& state = *geometry->getOrCreateStateSet();
        state.setTextureAttribute(0, texture);
        CHECK(texture->getTextureTarget() == target);
        ConversionInput input = inputFor(geometry);
        input.rasterizesRest = true;
        SceneConverter converter;
        const ConversionResult without = converter.convert(input);
        CHECK(soleMaterial(without).baseColorTexture == kInvalid); // as the fixed function draws it
        CHECK(without.scene->textures.empty());
        const osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() {}"));
        state.setAttribute(program);
        const ConversionResult with = converter.convert(input);
        CHECK(countOf(with, "rasterized.shader-program") == 1);
        CHECK(countOf(with, "converted.geometry") == 0);
    }
}

TEST_CASE("textures of a linear scene: colours are decoded, data and floats are not", "[bridge]")
{
    osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
    const auto color = smallTexture();
    physical->setBaseColorTexture(color);
    physical->setMetallicRoughnessTexture(color);
    physical->setEmissionTexture(color);
    osg::ref_ptr<osg::Texture2D> wide =
        new osg::Texture2D(imageOf<float>(1, 1, GL_RED, GL_FLOAT, {0.5f}));
    physical->setTransmissionTexture(wide);
    const auto geometry = triangleGeometry();
    geometry->setTexCoordArray(0, new osg::Vec2Array(3));
    geometry->getOrCreateStateSet()->setAttribute(physical);

    const ConversionResult result = convertGraph(geometry);
    const Material& material = soleMaterial(result);
    const auto& textures = result.scene->textures;
    REQUIRE(textures.size() == 3);
    CHECK(textures.at(material.baseColorTexture)->decodeSrgb);
    CHECK(material.emissionTexture == material.baseColorTexture);
    CHECK_FALSE(textures.at(material.metallicRoughnessTexture)->decodeSrgb);
    CHECK_FALSE(textures.at(material.transmissionTexture)->decodeSrgb);
    CHECK(textures.at(material.transmissionTexture)->floats == Floats{0.5f, 0, 0, 1});
}

TEST_CASE("a texture whose image was given up stays what its image's format made of it", "[bridge]")
{
    const auto image = imageOf<uint8_t>(1, 1, GL_RGB, GL_UNSIGNED_BYTE, {10, 20, 30});
    image->setInternalTextureFormat(GL_SRGB8);
    const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    const auto geometry = texturedGeometry(texture);
    SceneConverter converter;
    CHECK(converter.convert(inputFor(geometry)).scene->textures.at(0)->decodeSrgb);
    texture->setImage(nullptr);
    const ConversionResult result = converter.convert(inputFor(geometry));
    REQUIRE(soleMaterial(result).baseColorTexture == 0);
    CHECK(result.scene->textures.at(0)->decodeSrgb);
    CHECK(result.scene->textures.at(0)->bytes == Bytes{10, 20, 30, 255});
}

TEST_CASE("texture modes that compress: the base format is OpenGL's", "[bridge]")
{
    const auto converted = [](osg::Texture::InternalFormatMode mode)
    {
        const osg::ref_ptr<osg::Texture2D> texture =
            new osg::Texture2D(imageOf<uint8_t>(1, 1, GL_RGBA, GL_UNSIGNED_BYTE, {10, 20, 30, 40}));
        texture->setInternalFormatMode(mode);
        return convertGraph(texturedGeometry(texture)).scene->textures.at(0)->bytes;
    };
    CHECK(converted(osg::Texture::USE_S3TC_DXT1_COMPRESSION) == Bytes{10, 20, 30, 40});
    CHECK(converted(osg::Texture::USE_S3TC_DXT5_COMPRESSION) == Bytes{10, 20, 30, 40});
    CHECK(converted(osg::Texture::USE_S3TC_DXT1c_COMPRESSION) == Bytes{10, 20, 30, 255});
}

TEST_CASE("3-D textures: all slices, and the third coordinate of the mesh", "[bridge]")
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 2, 3, GL_LUMINANCE, GL_UNSIGNED_BYTE);
    for (int i = 0; i < 6; ++i)
        *image->data(0, i % 2, i / 2) = static_cast<unsigned char>(10 * i);
    const osg::ref_ptr<osg::Texture3D> volume = new osg::Texture3D(image);
    volume->setWrap(osg::Texture::WRAP_R, osg::Texture::MIRROR);
    const auto geometry = texturedGeometry(volume);
    const osg::ref_ptr<osg::Vec3Array> coordinates = new osg::Vec3Array(3);
    (*coordinates)[1] = osg::Vec3(1, 2, 3);
    geometry->setTexCoordArray(0, coordinates);
    SceneConverter converter;
    ConversionResult result = converter.convert(inputFor(geometry));
    const Texture& texture = *result.scene->textures.at(0);
    CHECK((texture.width == 1 && texture.height == 2 && texture.depth == 3));
    REQUIRE(texture.bytes.size() == 24);
    CHECK(texture.bytes[4 * 5] == 50);
    CHECK(texture.wrapR == TextureWrap::Mirror);
    CHECK(soleMesh(result).uvs[1] == Vec2(1, 2));
    REQUIRE(soleMesh(result).rs.size() == 3);
    CHECK(soleMesh(result).rs[1] == 3);
    CHECK(soleMesh(result).rs1.empty());

    volume->setWrap(osg::Texture::WRAP_R, osg::Texture::REPEAT);
    result = converter.convert(inputFor(geometry));
    CHECK(result.scene->textures.at(0)->wrapR == TextureWrap::Repeat);
    // Homogeneous coordinates are divided; if r is 0 throughout, the mesh has no third coordinates.
    const osg::ref_ptr<osg::Vec4Array> projective = new osg::Vec4Array(3);
    (*projective)[0].set(0, 0, 6, 2);
    (*projective)[1].w() = (*projective)[2].w() = 1;
    geometry->setTexCoordArray(0, projective);
    CHECK(soleMesh(converter.convert(inputFor(geometry))).rs[0] == 3);
    (*projective)[0].z() = 0;
    projective->dirty();
    CHECK(soleMesh(converter.convert(inputFor(geometry))).rs.empty());
}
