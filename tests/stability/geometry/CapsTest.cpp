// CapsTest.cpp - objects that are too large are refused with a message, and are not read. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/stability/geometry/Pictured.h"

#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include <osgRayTrace/Renderer>

#include <osg/Texture2D>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a triangle below this many transforms.
osg::ref_ptr<osg::Node> chain(std::size_t length)
{
    osg::ref_ptr<osg::Node> node = triangleGeometry();
    for (std::size_t i = 0; i < length; ++i)
    {
        osg::ref_ptr<osg::MatrixTransform> transform =
            new osg::MatrixTransform(osg::Matrixd::rotate(0.001, osg::Vec3d(0.0, 0.0, 1.0)));
        transform->getOrCreateStateSet()->setMode(GL_LIGHTING, i % 4 == 0);
        transform->addChild(node);
        node = transform;
    }
    node->setName("top");
    return node;
}

osg::ref_ptr<osg::Geometry> textured(osg::Image* image)
{
    const auto geometry = triangleGeometry();
    geometry->setTexCoordArray(0, new osg::Vec2Array(3));
    geometry->getOrCreateStateSet()->setTextureAttributeAndModes(0, new osg::Texture2D(image));
    return geometry;
}

/// Returns an image that claims a size but has one byte. Nobody may read it.
osg::ref_ptr<osg::Image> claimed(int width, int height, GLenum format, GLenum type)
{
    static unsigned char byte = 0;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setImage(width, height, 1, static_cast<GLint>(format), format, type, &byte,
                    osg::Image::NO_DELETE);
    image->setFileName("huge.png");
    return image;
}

} // namespace

TEST_CASE("caps: a path of 5000 nodes is traced, what is deeper is skipped and named",
          "[stability]")
{
    const ConversionResult deepest = convertGraph(chain(kDeepestPath - 1)); // and the triangle
    CHECK(deepest.scene->instances.size() == 1);
    CHECK(countOf(deepest, "skipped.too-deep") == 0);

    forgetKindsOfWarnings();
    const Messages messages;
    const auto tooDeep = chain(kDeepestPath);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(tooDeep);
    root->addChild(triangleGeometry());
    const ConversionResult result = convertGraph(root);
    CHECK(result.scene->instances.size() == 1); // the rest is converted
    CHECK(countOf(result, "skipped.too-deep") == 1);
    CHECK(messages.timesSaid("lies below 4999 others, its children are skipped") == 1);
    CHECK(graphHash(*root, {}) == graphHash(*root, {}));
}

TEST_CASE("caps: a texture of more than 2^28 texels or 4 GiB is magenta, and named", "[stability]")
{
    forgetKindsOfWarnings();
    const Messages messages;
    for (const auto& image : {claimed(1 << 15, (1 << 13) + 1, GL_LUMINANCE, GL_UNSIGNED_BYTE),
                              claimed(1 << 14, 1 << 14, GL_RGBA, GL_FLOAT),
                              claimed(2147483647, 2147483647, GL_ALPHA, GL_UNSIGNED_BYTE)})
    {
        const ConversionResult result = convertGraph(textured(image));
        CHECK(countOf(result, "approximated.texture-size") == 1);
        REQUIRE(result.scene->textures.size() == 1);
        CHECK(result.scene->textures[0]->bytes == std::vector<uint8_t>{255, 0, 255, 255});
    }
    CHECK(messages.timesSaid("texture 'huge.png': more than 2^28 texels or 4 GiB") == 1);
}

TEST_CASE("caps: an image of more than 2^28 pixels is refused with a message", "[stability]")
{
    osg::ref_ptr<osgRayTrace::Renderer> renderer = new osgRayTrace::Renderer;
    renderer->setScene(triangleGeometry());
    renderer->setSize(1 << 15, (1 << 13) + 1);
    CHECK_FALSE(renderer->render());
    CHECK(renderer->getStatistics().message == "the image has more than 2^28 pixels");
    renderer->setSize(8, 8);
    renderer->getSettings()->setMaxPasses(1);
    CHECK(renderer->render());
}
