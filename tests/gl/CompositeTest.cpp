// CompositeTest.cpp - ray traced and rasterized parts in one picture. Layer: tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/BlendFunc>
#include <osg/ClearNode>
#include <osg/Depth>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/Texture2D>

#include <optional>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

const osg::Vec4 kRed(1.0f, 0.0f, 0.0f, 1.0f);
const osg::Vec4 kGreen(0.0f, 1.0f, 0.0f, 1.0f);
constexpr int kSize = 256;

osg::ref_ptr<osg::Node> rasterizedSphere(const osg::Vec3& center, float radius)
{
    osg::ref_ptr<osg::ShapeDrawable> drawable = sphere(center, radius, kRed);
    drawable->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return drawable;
}

/// Holds the ray through the point (x, y) of the picture, from the near to the far plane.
struct PixelRay
{
    PixelRay(const osg::Camera& camera, double x, double y)
    {
        const osg::Matrixd worldFromWindow =
            osg::Matrixd::inverse(camera.getViewMatrix() * camera.getProjectionMatrix() *
                                  camera.getViewport()->computeWindowMatrix());
        begin = osg::Vec3d(x, y, 0.0) * worldFromWindow;
        end = osg::Vec3d(x, y, 1.0) * worldFromWindow;
    }

    std::optional<double> hitSphere(double radius) const
    {
        const osg::Vec3d d = end - begin;
        const double a = d * d, b = begin * d, c = begin * begin - radius * radius;
        const double discriminant = b * b - a * c;
        if (discriminant < 0.0) return std::nullopt;
        return (-b - std::sqrt(discriminant)) / a;
    }

    double hitPlaneZ0() const { return begin.z() / (begin.z() - end.z()); }

    osg::Vec3d begin, end;
};

enum class Seen
{
    Background,
    Sphere,
    Wall
};

/// Returns what is nearest at a point of the picture: the sphere around the origin, the unlit
/// square or the background.
Seen expected(const osg::Camera& camera, double x, double y, double radius, double half)
{
    const PixelRay ray(camera, x, y);
    const double plane = ray.hitPlaneZ0();
    const osg::Vec3d point = ray.begin + (ray.end - ray.begin) * plane;
    const bool wall = std::abs(point.x()) < half && std::abs(point.y()) < half;
    const std::optional<double> ball = ray.hitSphere(radius);
    if (ball && (!wall || *ball < plane)) return Seen::Sphere;
    return wall ? Seen::Wall : Seen::Background;
}

/// Returns what the pixel sees if its corners, with a margin for the sphere's tessellation, see the
/// same as its centre.
std::optional<Seen> certain(const osg::Camera& camera, int x, int y, double radius, double half)
{
    const Seen seen = expected(camera, x + 0.5, y + 0.5, radius, half);
    for (double dx : {-0.75, 0.75})
        for (double dy : {-0.75, 0.75})
            if (expected(camera, x + 0.5 + dx, y + 0.5 + dy, radius, half) != seen)
                return std::nullopt;
    return seen;
}

osg::Vec4 colorOf(Seen seen)
{
    switch (seen)
    {
    case Seen::Sphere:
        return osg::Vec4(255, 0, 0, 255);
    case Seen::Wall:
        return osg::Vec4(0, 255, 0, 255);
    case Seen::Background:
        break;
    }
    return osg::Vec4(0, 0, 0, 255);
}

} // namespace

TEST_CASE("composite: a rasterized sphere in a ray traced wall shows exactly its front half",
          "[gl]")
{
    const float radius = 1.0f, half = 2.0f;
    osg::ref_ptr<RayTracedScene> traced = tracedScene(unlitSquare(half, kGreen).get());
    osg::ref_ptr<osg::Group> root = new osg::Group;
    // The sphere is drawn before or after the wall: the order in the graph must not matter.
    const bool first = GENERATE(true, false);
    if (first) root->addChild(rasterizedSphere(osg::Vec3(), radius));
    root->addChild(traced);
    if (!first) root->addChild(rasterizedSphere(osg::Vec3(), radius));

    const auto create = GENERATE(createOSMesaContext, createEGLContext);
    const osg::ref_ptr<osg::GraphicsContext> context = create(kSize, kSize, nullptr);
    if (!context)
    {
        WARN("skipped: no such context here");
        return;
    }
    TestViewer view(kSize, kSize, root.get(), context);
    const bool orthographic = GENERATE(false, true);
    if (orthographic) view.camera().setProjectionMatrixAsOrtho(-2.5, 2.5, -2.5, 2.5, 1.0, 100.0);
    const osg::Vec3d eye =
        GENERATE(osg::Vec3d(0.0, 0.0, 8.0), osg::Vec3d(6.0, 1.0, 4.0), osg::Vec3d(-5.0, -5.0, 2.0));
    view.look(eye);
    const osg::ref_ptr<osg::Image> picture = view.frames(2);
    REQUIRE(traced->getDrawable()->getStatistics().ok);

    int counts[3] = {0, 0, 0};
    int wrong = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
        {
            const std::optional<Seen> seen = certain(view.camera(), x, y, radius, half);
            if (!seen) continue;
            ++counts[static_cast<int>(*seen)];
            if (pixel(*picture, x, y) != colorOf(*seen)) ++wrong;
        }
    CHECK(wrong == 0);
    CHECK(counts[static_cast<int>(Seen::Sphere)] > 1000);
    CHECK(counts[static_cast<int>(Seen::Wall)] > 1000);
    CHECK(counts[static_cast<int>(Seen::Background)] > 1000);
}

TEST_CASE("composite: depth is the rasterizer's", "[gl]")
{
    osg::ref_ptr<RayTracedScene> traced = tracedScene(unlitSquare(2.0f, kGreen).get());
    TestViewer view(kSize, kSize, traced.get());
    view.look(osg::Vec3d(5.0, 2.0, 6.0));

    SECTION("full range") {}
    SECTION("glDepthRange")
    {
        traced->getOrCreateStateSet()->setAttribute(new osg::Depth(osg::Depth::LESS, 0.25, 0.5));
    }

    view.frames();
    osg::ref_ptr<osg::Image> depths =
        new osg::Image(*view.capture->getDepthImage(), osg::CopyOp::DEEP_COPY_ALL);
    traced->setEnabled(false);
    view.frames();

    int compared = 0;
    double worst = 0.0;
    for (int y = 1; y < kSize - 1; ++y)
        for (int x = 1; x < kSize - 1; ++x)
        {
            bool inside = true;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    inside = inside && view.depth(x + dx, y + dy) < 1.0f;
            if (!inside) continue;
            const float tracedDepth = *reinterpret_cast<const float*>(depths->data(x, y));
            worst = std::max(worst, double(std::abs(tracedDepth - view.depth(x, y))));
            ++compared;
        }
    CHECK(compared > 5000);
    CHECK(worst < 4.0 / (1 << 24));
}

TEST_CASE("composite: what is see-through blends over the ray traced picture", "[gl]")
{
    osg::ref_ptr<osg::Geometry> pane = unlitSquare(1.0f, osg::Vec4(1.0f, 0.0f, 0.0f, 0.5f));
    pane->getOrCreateStateSet()->setAttributeAndModes(new osg::BlendFunc);
    pane->getOrCreateStateSet()->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    osg::ref_ptr<osg::MatrixTransform> inFront =
        new osg::MatrixTransform(osg::Matrix::translate(0, 0, 1));
    inFront->addChild(pane);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(inFront);
    root->addChild(tracedScene(unlitSquare(2.0f, kGreen).get()));

    TestViewer view(64, 64, root.get());
    const osg::Vec4 middle = pixel(*view.frames(), 32, 32);
    CHECK(middle.r() == Approx(127.5).margin(1.0));
    CHECK(middle.g() == Approx(127.5).margin(1.0));
}

TEST_CASE("composite: edges lie between their two sides", "[gl]")
{
    // The test has a linear scene, whose display values are encoded: a grey square on a background
    // that is brighter in blue and darker in red and green. The square is turned a little, so that
    // all kinds of coverage occur.
    osg::ref_ptr<osg::MatrixTransform> turned =
        new osg::MatrixTransform(osg::Matrix::rotate(0.3, osg::Vec3d(0, 0, 1)));
    turned->addChild(unlitSquare(1.0f, osg::Vec4(0.5f, 0.5f, 0.5f, 1.0f)));
    osg::ref_ptr<RayTracedScene> traced = tracedScene(turned.get());
    traced->getSettings()->setColorRule(
        GENERATE(RayTraceSettings::LINEAR, RayTraceSettings::DISPLAY_REFERRED));
    traced->getSettings()->setPassesPerFrame(16);
    TestViewer view(kSize, kSize, traced.get());
    view.camera().setClearColor(osg::Vec4(0.2f, 0.2f, 0.8f, 1.0f));
    const osg::ref_ptr<osg::Image> picture = view.frames();

    const osg::Vec4 inside = pixel(*picture, kSize / 2, kSize / 2), outside = pixel(*picture, 1, 1);
    int edges = 0, wrong = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
        {
            const osg::Vec4 color = pixel(*picture, x, y);
            edges += color != inside && color != outside;
            for (int c = 0; c < 3; ++c)
                wrong += color[c] < std::min(inside[c], outside[c]) - 2.0f ||
                         color[c] > std::max(inside[c], outside[c]) + 2.0f;
        }
    CHECK(edges > 50);
    CHECK(wrong == 0);
}

TEST_CASE("composite: the drawable leaves OSG's state as it was", "[gl]")
{
    // Quads that need textures, lighting and a material stand to the left and the right, before and
    // after the traced scene.
    osg::ref_ptr<osg::Image> checks = new osg::Image;
    checks->allocateImage(8, 8, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int i = 0; i < 64; ++i)
        std::memset(checks->data(i % 8, i / 8), (i + i / 8) % 2 ? 255 : 80, 3);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(checks.get());
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.9f, 0.6f, 0.3f, 1.0f));

    // The three ways in which OSG can draw a geometry.
    const bool bufferObjects = GENERATE(true, false);
    const bool displayLists = bufferObjects ? false : GENERATE(true, false);
    const auto quadAt = [&](float x, bool lit, bool textured)
    {
        osg::ref_ptr<osg::Geometry> quad = osg::createTexturedQuadGeometry(
            osg::Vec3(x, -1.0f, 1.0f), osg::Vec3(0.8f, 0, 0), osg::Vec3(0, 2.0f, 0));
        quad->setUseVertexBufferObjects(bufferObjects);
        quad->setUseDisplayList(displayLists);
        osg::StateSet* stateSet = quad->getOrCreateStateSet();
        if (textured) stateSet->setTextureAttributeAndModes(0, texture);
        if (lit) stateSet->setAttribute(material);
        if (!lit) stateSet->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        return quad;
    };

    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::Group> before = new osg::Group, after = new osg::Group;
    int column = 0;
    for (osg::Group* group : {before.get(), after.get()})
        for (bool lit : {false, true})
            for (bool textured : {false, true})
                group->addChild(quadAt(-4.0f + float(column++), lit, textured));
    // Bins are drawn in order, so these quads really come before and after; the last quad has no
    // state of its own.
    before->getOrCreateStateSet()->setRenderBinDetails(-1, "RenderBin");
    after->getOrCreateStateSet()->setRenderBinDetails(2, "RenderBin");
    osg::ref_ptr<osg::Geometry> plain = osg::createTexturedQuadGeometry(
        osg::Vec3(-4.0f, 1.5f, 1.0f), osg::Vec3(8.0f, 0, 0), osg::Vec3(0, 0.5f, 0));
    after->addChild(plain);
    root->addChild(before);
    // The traced square is hidden behind the quads or out of their way, so that the pictures differ
    // in this square alone.
    osg::ref_ptr<RayTracedScene> traced = tracedScene(unlitSquare(1.0f, kGreen).get());
    osg::ref_ptr<osg::MatrixTransform> below =
        new osg::MatrixTransform(osg::Matrix::translate(0, -2.3, 0));
    below->addChild(traced);
    root->addChild(below);
    root->addChild(after);

    TestViewer view(kSize, kSize, root.get());
    const bool vertexArrayObjects = GENERATE(false, true);
    if (vertexArrayObjects)
        osg::DisplaySettings::instance()->setVertexBufferHint(
            osg::DisplaySettings::VERTEX_ARRAY_OBJECT);
    view.viewer.setDisplaySettings(osg::DisplaySettings::instance().get());
    const osg::ref_ptr<osg::Image> with = view.frames(3);
    CHECK(glGetError() == GL_NO_ERROR);
    below->setNodeMask(0);
    const osg::ref_ptr<osg::Image> without = view.frames(3);
    osg::DisplaySettings::instance()->setVertexBufferHint(osg::DisplaySettings::NO_PREFERENCE);

    int traceable = 0, different = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
        {
            const bool green = pixel(*with, x, y) == osg::Vec4(0, 255, 0, 255);
            const bool edge = pixel(*with, x, y).g() > pixel(*with, x, y).r();
            traceable += green;
            different += !edge && pixel(*with, x, y) != pixel(*without, x, y);
        }
    CHECK(traceable > 1000);
    CHECK(different == 0);
}

// A mirror that shows the background must show the one that the picture has.
TEST_CASE("composite: a ClearNode in the scene is the background, also of mirrors", "[gl]")
{
    osg::ref_ptr<osg::ClearNode> clear = new osg::ClearNode;
    clear->setClearColor(osg::Vec4(0.2f, 0.6f, 0.4f, 1.0f));
    osg::ref_ptr<osg::Geometry> mirror = unlitSquare(1.0f, osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    osg::ref_ptr<PhysicalMaterial> metal = new PhysicalMaterial;
    metal->setMetallic(1.0f);
    metal->setRoughness(0.0f);
    metal->setBaseColor(osg::Vec3(1.0f, 1.0f, 1.0f));
    mirror->getOrCreateStateSet()->setAttribute(metal);
    clear->addChild(mirror); // a ClearNode is a group like others
    TestViewer viewer(kSize, kSize, tracedScene(clear));
    viewer.camera().setClearColor(osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f));
    const osg::ref_ptr<osg::Image> picture = viewer.frames(3);
    for (const int x : {4, kSize / 2})
    {
        CAPTURE(x);
        const osg::Vec4 color = pixel(*picture, x, kSize / 2);
        CHECK(color.x() == Approx(51.0f).margin(2.0f));
        CHECK(color.y() == Approx(153.0f).margin(2.0f));
        CHECK(color.z() == Approx(102.0f).margin(2.0f));
    }
}
