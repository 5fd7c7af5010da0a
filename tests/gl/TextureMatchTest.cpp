// TextureMatchTest.cpp - textures look as OpenGL draws them: coordinates, wrap modes, environments
// and formats.
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

constexpr std::pair<const char*, osg::Texture::WrapMode> kWrapModes[] = {
    {"repeat", osg::Texture::REPEAT},
    {"mirror", osg::Texture::MIRROR},
    {"clamp", osg::Texture::CLAMP},
    {"clamp-to-edge", osg::Texture::CLAMP_TO_EDGE},
    {"clamp-to-border", osg::Texture::CLAMP_TO_BORDER}};

/// Returns an environment picture whose smooth colours tell in which direction it is looked up.
osg::ref_ptr<osg::Image> environmentPicture(int size)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(size, size, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
        {
            const float s = (x + 0.5f) / size, t = (y + 0.5f) / size;
            image->setColor(osg::Vec4(s, t, 0.5f + 0.5f * std::sin(8.0f * (s + t)), 1.0f), x, y);
        }
    return image;
}

osg::ref_ptr<osg::TextureCubeMap> cubeMap(int size)
{
    osg::ref_ptr<osg::TextureCubeMap> cube = new osg::TextureCubeMap;
    for (unsigned int face = 0; face < 6; ++face)
    {
        const osg::ref_ptr<osg::Image> image = environmentPicture(size);
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
            {
                osg::Vec4 color = image->getColor(x, y);
                color.b() = float(face) / 5.0f;
                image->setColor(color, x, y);
            }
        cube->setImage(face, image);
    }
    cube->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    cube->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    cube->setWrap(osg::Texture::WRAP_R, osg::Texture::CLAMP_TO_EDGE);
    cube->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    cube->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    return cube;
}

void generate(osg::Node& node, unsigned int unit, osg::TexGen* texGen, bool third = false)
{
    osg::StateSet& state = *node.getOrCreateStateSet();
    if (texGen) state.setTextureAttribute(unit, texGen);
    state.setTextureMode(unit, GL_TEXTURE_GEN_S, kOn);
    state.setTextureMode(unit, GL_TEXTURE_GEN_T, kOn);
    if (third) state.setTextureMode(unit, GL_TEXTURE_GEN_R, kOn);
}

osg::ref_ptr<osg::TexGen> linearTexGen(osg::TexGen::Mode mode)
{
    osg::ref_ptr<osg::TexGen> texGen = new osg::TexGen;
    texGen->setMode(mode);
    texGen->setPlane(osg::TexGen::S, osg::Vec4(0.3f, 0.1f, 0.0f, 0.2f));
    texGen->setPlane(osg::TexGen::T, osg::Vec4(0.0f, 0.25f, 0.1f, 0.4f));
    return texGen;
}

osg::ref_ptr<osg::TexGen> texGenOf(osg::TexGen::Mode mode)
{
    osg::ref_ptr<osg::TexGen> texGen = new osg::TexGen;
    texGen->setMode(mode);
    return texGen;
}

/// Returns a sphere so fine that OpenGL's coordinates at vertices equal those at points.
osg::ref_ptr<osg::ShapeDrawable> fineSphere(float radius = 3.0f)
{
    osg::ref_ptr<osg::TessellationHints> hints = new osg::TessellationHints;
    hints->setDetailRatio(8.0f);
    return new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), radius), hints.get());
}

MatchSetup obliquely()
{
    MatchSetup setup;
    setup.view = [](TestViewer& view) { view.look({6.0, 4.0, 7.0}, {}, {0.1, 1.0, 0.2}); };
    return setup;
}

} // namespace

TEST_CASE("match: wrap modes, with border colour", "[gl][coverage]")
{
    for (const auto& [name, mode] : kWrapModes)
        for (const auto filter : {osg::Texture::LINEAR, osg::Texture::NEAREST})
        {
            const auto geometry = unlit(square(3.0f));
            auto& coordinates = static_cast<osg::Vec2Array&>(*geometry->getTexCoordArray(0));
            for (osg::Vec2& c : coordinates)
                c = c * 3.0f - osg::Vec2(1.1f, 0.9f);
            const auto texture = textureOf(patchwork(4, GL_RGB), mode, filter);
            texture->setBorderColor(osg::Vec4d(0.1, 0.9, 0.3, 1.0));
            geometry->getStateSet()->setTextureAttributeAndModes(0, texture);
            CHECK(matches(std::string("wrap-") + name +
                              (filter == osg::Texture::NEAREST ? "-nearest" : ""),
                          geometry));
        }
}

TEST_CASE("match: mips, with one sample a pixel", "[gl][coverage]")
{
    constexpr std::pair<const char*, osg::Texture::FilterMode> kFilters[] = {
        {"linear-linear", osg::Texture::LINEAR_MIPMAP_LINEAR},
        {"linear-nearest", osg::Texture::LINEAR_MIPMAP_NEAREST},
        {"nearest-linear", osg::Texture::NEAREST_MIPMAP_LINEAR},
        {"nearest-nearest", osg::Texture::NEAREST_MIPMAP_NEAREST}};
    for (const auto& [name, filter] : kFilters)
    {
        // Nearly four texels a pixel, and neighbours differ: without mips they would show.
        const auto geometry = unlit(square(3.0f));
        auto& coordinates = static_cast<osg::Vec2Array&>(*geometry->getTexCoordArray(0));
        for (osg::Vec2& c : coordinates)
            c = c * 0.5f;
        const auto texture = textureOf(patchwork(512, GL_RGB));
        texture->setFilter(osg::Texture::MIN_FILTER, filter);
        geometry->getStateSet()->setTextureAttributeAndModes(0, texture);
        MatchSetup setup;
        setup.samples = 1;
        CHECK(matches(std::string("mips-") + name, geometry, setup));
    }
}

TEST_CASE("match: texture matrix, also a projective one", "[gl][coverage]")
{
    osg::Matrixd matrix = osg::Matrixd::scale(2.0, 3.0, 1.0) *
                          osg::Matrixd::rotate(0.4, osg::Vec3d(0, 0, 1)) *
                          osg::Matrixd::translate(0.3, 0.1, 0.0);
    const bool projective = GENERATE(false, true);
    if (projective) matrix(0, 3) = 0.7;
    const auto geometry = unlit(square(3.0f));
    // OpenGL interpolates (s, t, q) over each triangle, so its result is right for large triangles,
    // too.
    geometry->getStateSet()->setTextureAttributeAndModes(0, textureOf(patchwork(8, GL_RGB)));
    geometry->getStateSet()->setTextureAttribute(0, new osg::TexMat(matrix));
    CHECK(matches(projective ? "texture-matrix-projective" : "texture-matrix", geometry));
}

TEST_CASE("match: object and eye linear texture generation", "[gl][coverage]")
{
    const auto mode = GENERATE(osg::TexGen::OBJECT_LINEAR, osg::TexGen::EYE_LINEAR);
    const auto ball = fineSphere(1.5f);
    ball->getOrCreateStateSet()->setTextureAttributeAndModes(0, textureOf(patchwork(8, GL_RGB)));
    generate(*ball, 0, linearTexGen(mode));
    const osg::ref_ptr<osg::Node> root =
        placed(osg::Matrixd::rotate(0.5, osg::Vec3d(1, 1, 0)) *
                   osg::Matrixd::translate(0.5, 0.3, 0.0) * osg::Matrixd::scale(1.0, 1.5, 1.0),
               ball);
    // OpenGL would light with the length that the scale gives to normals; tracing never does.
    root->getOrCreateStateSet()->setMode(GL_NORMALIZE, kOn);
    CHECK(matches(mode == osg::TexGen::OBJECT_LINEAR ? "texgen-object-linear" : "texgen-eye-linear",
                  root, obliquely()));
}

TEST_CASE("match: a TexGenNode places eye linear coordinates", "[gl][coverage]")
{
    const auto ball = fineSphere(1.5f);
    ball->getOrCreateStateSet()->setTextureAttributeAndModes(0, textureOf(patchwork(8, GL_RGB)));
    generate(*ball, 0, nullptr);
    const osg::ref_ptr<osg::TexGenNode> node =
        new osg::TexGenNode(linearTexGen(osg::TexGen::EYE_LINEAR));
    node->setTextureUnit(0);
    const auto root = groupOf(
        {placed(osg::Matrixd::rotate(1.0, osg::Vec3d(0, 0, 1)) * osg::Matrixd::translate(1, 0, 0),
                node),
         placed(osg::Matrixd::translate(-1.0, 0.5, 0.0), ball)});
    SECTION("in the scene")
    {
        CHECK(matches("texgen-node", root, obliquely()));
    }
    SECTION("in eye space, where they move with the view")
    {
        node->setReferenceFrame(osg::TexGenNode::ABSOLUTE_RF);
        CHECK(matches("texgen-node-absolute", root, obliquely()));
    }
}

TEST_CASE("match: sphere, reflection and normal maps follow the view", "[gl][coverage]")
{
    const auto setup = GENERATE(0, 1) == 0 ? MatchSetup() : obliquely();
    const std::string view = setup.view ? "-oblique" : "";
    const auto traced = [&](const char* name, osg::TexGen::Mode mode, osg::Texture* texture)
    {
        const auto ball = fineSphere();
        ball->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
        generate(*ball, 0, texGenOf(mode), mode != osg::TexGen::SPHERE_MAP);
        CHECK(matches(name + view, placed(osg::Matrixd::rotate(0.7, osg::Vec3d(0, 1, 0)), ball),
                      setup));
    };
    traced("texgen-sphere-map", osg::TexGen::SPHERE_MAP, textureOf(environmentPicture(64)));
    traced("texgen-reflection-map", osg::TexGen::REFLECTION_MAP, cubeMap(32));
    traced("texgen-normal-map", osg::TexGen::NORMAL_MAP, cubeMap(32));
}

TEST_CASE("match: texture environments of two units", "[gl][coverage]")
{
    const std::pair<const char*, osg::TexEnv::Mode> modes[] = {{"modulate", osg::TexEnv::MODULATE},
                                                               {"replace", osg::TexEnv::REPLACE},
                                                               {"decal", osg::TexEnv::DECAL},
                                                               {"blend", osg::TexEnv::BLEND},
                                                               {"add", osg::TexEnv::ADD}};
    for (const auto& [name, mode] : modes)
        for (const unsigned int unit : {0u, 1u})
        {
            const auto geometry = square(3.0f, osg::Vec4(0.9f, 0.7f, 0.5f, 1.0f), 1.5f);
            osg::StateSet& state = *geometry->getOrCreateStateSet();
            const osg::ref_ptr<osg::TexEnv> environment = new osg::TexEnv(mode);
            environment->setColor(osg::Vec4(0.2f, 0.9f, 0.4f, 1.0f));
            if (unit == 1) state.setTextureAttributeAndModes(0, textureOf(environmentPicture(32)));
            state.setTextureAttributeAndModes(unit, textureOf(patchwork(8)));
            state.setTextureAttribute(unit, environment);
            CHECK(matches(std::string("texenv-") + name + (unit ? "-unit1" : "-unit0"), geometry));
        }
}

TEST_CASE("match: textured things without coordinates show the corner of the texture",
          "[gl][coverage]")
{
    const auto with = square(1.5f);
    const auto without = square(1.5f);
    without->setTexCoordArray(0, nullptr);
    without->setTexCoordArray(1, nullptr);
    const auto root = groupOf({placed(osg::Matrixd::translate(1.6, 0.0, 0.0), without),
                               placed(osg::Matrixd::translate(-1.6, 0.0, 0.0), with)});
    root->getOrCreateStateSet()->setTextureAttributeAndModes(0, textureOf(patchwork(8, GL_RGB)));
    CHECK(matches("no-coordinates", root));
}

TEST_CASE("match: one-dimensional and rectangle textures", "[gl][coverage]")
{
    const osg::ref_ptr<osg::Image> line = new osg::Image;
    line->allocateImage(16, 1, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int x = 0; x < 16; ++x)
        line->setColor(osg::Vec4(x / 15.0f, 1.0f - x / 15.0f, x % 2 ? 1.0f : 0.5f, 1.0f), x, 0);
    const osg::ref_ptr<osg::Texture1D> one = new osg::Texture1D(line);
    one->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    one->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    const auto stripes = unlit(square(3.0f, {1, 1, 1, 1}, 2.0f));
    stripes->getStateSet()->setTextureAttributeAndModes(0, one);
    CHECK(matches("texture-1d", stripes));

    const auto rectangle = unlit(square(3.0f, {1, 1, 1, 1}, 12.0f));
    rectangle->getStateSet()->setTextureAttributeAndModes(
        0, new osg::TextureRectangle(patchwork(12, GL_RGB)));
    CHECK(matches("texture-rectangle", rectangle));

    const auto scaled = unlit(square(3.0f, {1, 1, 1, 1}, 1.0f));
    scaled->getStateSet()->setTextureAttributeAndModes(
        0, new osg::TextureRectangle(patchwork(12, GL_RGB)));
    osg::ref_ptr<osg::TexMat> matrix = new osg::TexMat;
    matrix->setScaleByTextureRectangleSize(true);
    matrix->setMatrix(osg::Matrix::scale(0.5, 0.7, 1.0) * osg::Matrix::translate(3.0, 2.0, 0.0));
    scaled->getStateSet()->setTextureAttributeAndModes(0, matrix.get());
    CHECK(matches("texture-rectangle-matrix", scaled));
}

namespace
{

/// Returns a volume whose slices have different colours.
osg::ref_ptr<osg::Texture3D> volume(osg::Texture::WrapMode wrap, osg::Texture::FilterMode filter)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 4, GL_RGB, GL_UNSIGNED_BYTE);
    for (int i = 0; i < 64; ++i)
        image->setColor(osg::Vec4(0.2f + 0.25f * float(i % 4), i / 16 % 2 ? 0.2f : 0.9f,
                                  0.1f + 0.2f * float(i / 16) + 0.05f * float(i / 4 % 4), 1.0f),
                        i % 4, i / 4 % 4, i / 16);
    osg::ref_ptr<osg::Texture3D> texture = new osg::Texture3D(image);
    for (const auto direction : {osg::Texture::WRAP_S, osg::Texture::WRAP_T, osg::Texture::WRAP_R})
        texture->setWrap(direction, wrap);
    texture->setFilter(osg::Texture::MIN_FILTER, filter);
    texture->setFilter(osg::Texture::MAG_FILTER, filter);
    texture->setResizeNonPowerOfTwoHint(false);
    texture->setBorderColor(osg::Vec4d(0.1, 0.9, 0.3, 1.0));
    return texture;
}

} // namespace

TEST_CASE("match: 3-D textures, with three coordinates", "[gl][coverage]")
{
    for (const auto& [name, mode] : kWrapModes)
        for (const auto filter : {osg::Texture::LINEAR, osg::Texture::NEAREST})
        {
            const auto geometry = unlit(square(3.0f));
            const auto& flat = static_cast<osg::Vec2Array&>(*geometry->getTexCoordArray(0));
            const osg::ref_ptr<osg::Vec3Array> coordinates = new osg::Vec3Array;
            for (const osg::Vec2& c : flat)
                coordinates->push_back(
                    osg::Vec3(c.x() * 1.3f - 0.1f, c.y(), c.x() + c.y() * 1.7f - 0.6f));
            geometry->setTexCoordArray(0, coordinates);
            geometry->getStateSet()->setTextureAttributeAndModes(0, volume(mode, filter));
            CHECK(matches(std::string("texture-3d-") + name +
                              (filter == osg::Texture::NEAREST ? "-nearest" : ""),
                          geometry));
        }
}

TEST_CASE("match: some coordinates generated, the others of the mesh", "[gl][coverage]")
{
    const osg::ref_ptr<osg::TexGen> texGen = texGenOf(osg::TexGen::OBJECT_LINEAR);
    texGen->setPlane(osg::TexGen::S, osg::Vec4(0.1f, 0.3f, 0.0f, 0.2f));
    texGen->setPlane(osg::TexGen::R, osg::Vec4(0.2f, 0.1f, 0.0f, 0.4f));
    const auto geometry = unlit(square(3.0f));
    osg::StateSet& state = *geometry->getStateSet();
    state.setTextureAttribute(0, texGen);
    SECTION("R of a 3-D texture, below a texture matrix")
    {
        state.setTextureAttributeAndModes(0, volume(osg::Texture::REPEAT, osg::Texture::LINEAR));
        state.setTextureMode(0, GL_TEXTURE_GEN_R, kOn);
        CHECK(matches("texgen-r", geometry));
        state.setTextureAttribute(0,
                                  new osg::TexMat(osg::Matrixd::rotate(0.4, osg::Vec3d(1, 2, 0)) *
                                                  osg::Matrixd::translate(0.1, 0.2, 0.3)));
        CHECK(matches("texgen-r-matrix", geometry));
    }
    SECTION("S of a 2-D texture, in a place of its own")
    {
        state.setTextureAttributeAndModes(0, textureOf(patchwork(8, GL_RGB)));
        state.setTextureMode(0, GL_TEXTURE_GEN_S, kOn);
        CHECK(
            matches("texgen-s", placed(osg::Matrixd::rotate(0.3, osg::Vec3d(0, 0, 1)), geometry)));
    }
    SECTION("S of a sphere map")
    {
        const auto ball = fineSphere(1.5f);
        osg::StateSet& ofBall = *ball->getOrCreateStateSet();
        ofBall.setTextureAttributeAndModes(0, textureOf(patchwork(8, GL_RGB)));
        ofBall.setTextureAttribute(0, texGenOf(osg::TexGen::SPHERE_MAP));
        ofBall.setTextureMode(0, GL_TEXTURE_GEN_S, kOn);
        CHECK(matches("texgen-s-sphere-map", ball, obliquely()));
    }
}

TEST_CASE("match: a cube map with coordinates of the mesh", "[gl][coverage]")
{
    const auto geometry = unlit(square(3.0f));
    const osg::ref_ptr<osg::Vec3Array> coordinates = new osg::Vec3Array;
    for (const osg::Vec2& c : static_cast<osg::Vec2Array&>(*geometry->getTexCoordArray(0)))
        coordinates->push_back(osg::Vec3(c.x() * 2 - 1, c.y() * 2 - 1, 1.2f - c.x()));
    geometry->setTexCoordArray(0, coordinates);
    geometry->getStateSet()->setTextureAttributeAndModes(0, cubeMap(16));
    CHECK(matches("cube-map-own-coordinates", geometry));
}
