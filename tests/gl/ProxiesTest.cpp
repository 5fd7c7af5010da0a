// ProxiesTest.cpp - what OSG draws casts shadows and stands in mirrors. Layer: tests.
// SPDX-License-Identifier: MIT
#include "CullNodes.h"
#include "TestViewer.h"
#include "tests/Catch.h"

#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/RayIntersector>

#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osg/Program>
#include <osgDB/WriteFile>
#include <osgUtil/LineSegmentIntersector>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kSize = 192;
const osg::Vec3d kBox(0.3, 0.4, 1.2); ///< centre
constexpr double kHalf = 0.5;         ///< half the side of the box
const osg::Vec3d kSun(0.6, 0.2, 1.0); ///< direction towards the light
constexpr float kFloor = 3.0f;        ///< half the side of the floor, in the plane z = 0

/// Draws green. Traced, the box is red.
void addProgram(osg::Node& node)
{
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                       "void main() { gl_FragColor = vec4(0.0, 1.0, 0.0, 1.0); }"));
    node.getOrCreateStateSet()->setAttributeAndModes(program);
}

osg::ref_ptr<osg::ShapeDrawable> box()
{
    const osg::ref_ptr<osg::ShapeDrawable> drawable =
        new osg::ShapeDrawable(new osg::Box(osg::Vec3(), float(2.0 * kHalf)));
    drawable->setColor(osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f));
    return drawable;
}

/// Draws a box in its own way, and tells its triangles to functors.
class ForeignBox : public osg::Drawable
{
public:
    ForeignBox() : _box(box()) { setSupportsDisplayList(false); }
    ForeignBox(const ForeignBox& other, const osg::CopyOp& copy) : osg::Drawable(other, copy) {}
    META_Node(test, ForeignBox)

    bool supports(const osg::PrimitiveFunctor&) const override { return true; }
    void accept(osg::PrimitiveFunctor& functor) const override { _box->accept(functor); }
    osg::BoundingBox computeBoundingBox() const override { return _box->getBoundingBox(); }
    void drawImplementation(osg::RenderInfo& info) const override
    {
        _box->drawImplementation(info);
    }

private:
    osg::ref_ptr<osg::Drawable> _box;
};

/// Holds a floor that is traced, a light, and a box that OSG draws in green.
struct Stage
{
    explicit Stage(osg::ref_ptr<osg::Drawable> drawn = box())
        : root(new osg::Group), place(new osg::MatrixTransform), floor(new osg::Geode)
    {
        const osg::ref_ptr<osg::LightSource> light =
            new osg::LightSource; // in place of the viewer's
        light->getLight()->setPosition(osg::Vec4(kSun, 0.0));
        light->getLight()->setDiffuse(osg::Vec4(1, 1, 1, 1));
        root->addChild(light);
        floor->addDrawable(osg::createTexturedQuadGeometry(osg::Vec3(-kFloor, -kFloor, 0.0f),
                                                           osg::Vec3(2.0f * kFloor, 0.0f, 0.0f),
                                                           osg::Vec3(0.0f, 2.0f * kFloor, 0.0f)));
        root->addChild(floor);
        place->setMatrix(osg::Matrix::translate(kBox));
        addProgram(*place);
        place->addChild(drawn);
        root->addChild(place);
        scene = tracedScene(root);
        scene->getSettings()->setShadows(true);
    }

    osg::ref_ptr<osg::Group> root;
    osg::ref_ptr<osg::MatrixTransform> place;
    osg::ref_ptr<osg::Geode> floor;
    osg::ref_ptr<RayTracedScene> scene;
};

struct StageView
{
    explicit StageView(Stage& stage) : scene(stage.scene), viewer(kSize, kSize, stage.scene)
    {
        viewer.look(osg::Vec3d(1.0, -6.0, 7.0), osg::Vec3d(), osg::Vec3d(0.0, 0.0, 1.0));
    }

    const Statistics statistics() { return scene->getDrawable()->getStatistics(); }

    osg::ref_ptr<RayTracedScene> scene;
    TestViewer viewer;
};

/// Returns where a ray meets the box around a centre, in multiples of the direction.
std::optional<double> meetBox(const osg::Vec3d& from, const osg::Vec3d& along,
                              const osg::Vec3d& centre, double half)
{
    double first = 0.0, last = 1e9;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double a = (centre[axis] - half - from[axis]) / along[axis];
        const double b = (centre[axis] + half - from[axis]) / along[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first < last ? std::optional<double>(first) : std::nullopt;
}

/// Writes a picture to look at, into the folder that the environment names.
void keep(const osg::Image& image, const std::string& name)
{
    const char* const folder = std::getenv("OSGRAYTRACE_PICTURES");
    if (folder) osgDB::writeImageFile(image, std::string(folder) + "/" + name + ".png");
}

struct Seen
{
    long box = 0, shadow = 0, lit = 0, wrong = 0;
    float farthestDepth = 0.0f; ///< largest error of the depths of the box
};

/// Compares each pixel with what is to be seen there, but for those near an edge: the box in OSG's
/// green at its depth, the floor bright or, if shadows is true, dark where the box hides the light.
Seen examine(StageView& view, const osg::Image& image, const osg::Vec3d& centre, bool shadows)
{
    const osg::Matrixd clip =
        view.viewer.camera().getViewMatrix() * view.viewer.camera().getProjectionMatrix();
    const osg::Matrixd back = osg::Matrixd::inverse(clip);
    Seen seen;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
        {
            const double u = (2.0 * x + 1.0) / kSize - 1.0, v = (2.0 * y + 1.0) / kSize - 1.0;
            const osg::Vec3d from = osg::Vec3d(u, v, -1.0) * back;
            const osg::Vec3d along = osg::Vec3d(u, v, 1.0) * back - from;
            const osg::Vec4 color = pixel(image, x, y);
            if (meetBox(from, along, centre, kHalf - 0.05))
            {
                ++seen.box;
                seen.wrong += color != osg::Vec4(0, 255, 0, 255);
                const osg::Vec3d p = from + along * *meetBox(from, along, centre, kHalf);
                const float depth = static_cast<float>(0.5 + 0.5 * (p * clip).z());
                seen.farthestDepth =
                    std::max(seen.farthestDepth, std::fabs(depth - view.viewer.depth(x, y)));
                continue;
            }
            const osg::Vec3d p = from - along * (from.z() / along.z());
            const bool onFloor = std::max(std::fabs(p.x()), std::fabs(p.y())) < kFloor - 0.1;
            if (!onFloor || meetBox(from, along, centre, kHalf + 0.05)) continue;
            const bool dark = shadows && meetBox(p, kSun, centre, kHalf - 0.08).has_value();
            if (!dark && shadows && meetBox(p, kSun, centre, kHalf + 0.08)) continue;
            ++(dark ? seen.shadow : seen.lit);
            seen.wrong += (color.r() < 90.0f) != dark;
        }
    return seen;
}

void checkShadow(StageView& view, const osg::Vec3d& centre, const char* name)
{
    const osg::ref_ptr<osg::Image> image = view.viewer.frames(2);
    keep(*image, name);
    const Seen seen = examine(view, *image, centre, true);
    CAPTURE(name, seen.box, seen.shadow, seen.lit, seen.wrong);
    CHECK(seen.box > 500);
    CHECK(seen.shadow > 500);
    CHECK(seen.lit > 5000);
    CHECK(seen.wrong == 0);
    CHECK(seen.farthestDepth < 1e-4f);
}

void checkNoShadow(StageView& view, const char* name)
{
    const osg::ref_ptr<osg::Image> image = view.viewer.frames(2);
    keep(*image, name);
    const Seen seen = examine(view, *image, kBox, false);
    CAPTURE(name, seen.box, seen.lit, seen.wrong);
    CHECK(seen.box > 500);
    CHECK(seen.wrong == 0);
}

} // namespace

TEST_CASE("proxies: a box that a shader draws casts its shadow, at OSG's depth and colour", "[gl]")
{
    Stage stage;
    StageView view(stage);
    checkShadow(view, kBox, "proxy-box");
    CHECK(view.statistics().conversion.at("traced.proxy") == 1);

    const osg::Vec3d other(-0.8, -0.5, 1.5);
    stage.place->setMatrix(osg::Matrix::translate(other));
    checkShadow(view, other, "proxy-box-moved");
    CHECK(view.statistics().conversions == 1); // it was moved alone

    stage.place->setMatrix(osg::Matrix::translate(kBox));
    RayTracedScene::setHint(stage.place, RayTracedScene::RASTERIZE_ONLY);
    checkNoShadow(view, "proxy-box-rasterize-only");
}

TEST_CASE("proxies: a drawable of another class that tells its triangles casts a shadow", "[gl]")
{
    Stage stage(new ForeignBox);
    StageView view(stage);
    checkShadow(view, kBox, "proxy-foreign");
}

TEST_CASE("proxies: what a captured subtree leaves to OSG casts its shadow", "[gl][cull]")
{
    osg::ref_ptr<osg::Drawable> drawn = box();
    SECTION("a box that a shader draws") {}
    SECTION("a rig")
    {
        const osg::ref_ptr<osg::ShapeDrawable> shape = box();
        drawn = new application::RigDrawable(*shape);
    }
    SECTION("a drawable of another class")
    {
        drawn = new ForeignBox;
    }
    Stage stage(drawn);
    std::array<osg::ref_ptr<osg::StateSet>, 2> pushed;
    for (osg::ref_ptr<osg::StateSet>& state : pushed)
    {
        state = new osg::StateSet;
        state->addUniform(new osg::Uniform("time", float(&state - pushed.data())));
    }
    stage.place->setCullCallback(new application::StatePusher(pushed[0], pushed[1]));
    StageView view(stage);
    checkShadow(view, kBox, "proxy-captured");
    CHECK(view.statistics().conversion.at("rasterized.cull-callback") == 1);
    CHECK(view.statistics().conversion.at("traced.proxy") == 1);

    const uint64_t conversions = view.statistics().conversions;
    const osg::Vec3d other(-0.8, -0.5, 1.5);
    stage.place->setMatrix(osg::Matrix::translate(other));
    checkShadow(view, other, "proxy-captured-moved");
    CHECK(view.statistics().conversions == conversions);

    stage.place->setMatrix(osg::Matrix::translate(kBox));
    RayTracedScene::setHint(stage.place, RayTracedScene::RASTERIZE_ONLY);
    checkNoShadow(view, "proxy-captured-rasterize-only");
}

TEST_CASE("proxies: the dome of a sky with a program leaves the floor its light", "[gl]")
{
    Stage stage;
    const osg::ref_ptr<osg::ShapeDrawable> dome =
        new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 60.0f));
    addProgram(*dome);
    stage.root->addChild(dome);
    StageView view(stage);
    checkShadow(view, kBox, "proxy-dome");
}

TEST_CASE("proxies: a mirror shows the box as it would be traced", "[gl]")
{
    Stage stage;
    const osg::ref_ptr<PhysicalMaterial> mirror = new PhysicalMaterial;
    mirror->setMetallic(1.0f);
    mirror->setRoughness(0.0f);
    stage.floor->getOrCreateStateSet()->setAttribute(mirror);
    StageView view(stage);
    const osg::ref_ptr<osg::Image> image = view.viewer.frames(4);
    keep(*image, "proxy-mirror");
    const osg::Matrixd clip =
        view.viewer.camera().getViewMatrix() * view.viewer.camera().getProjectionMatrix();
    const osg::Vec3d eye = osg::Vec3d() * view.viewer.camera().getInverseViewMatrix();
    const osg::Vec3d image3(kBox.x(), kBox.y() - kHalf + 0.1, -kBox.z()); // in the mirror's world
    const osg::Vec3d seen = image3 * clip;
    const osg::Vec4 color = pixel(*image, static_cast<int>((0.5 + 0.5 * seen.x()) * kSize),
                                  static_cast<int>((0.5 + 0.5 * seen.y()) * kSize));
    CAPTURE(color.r(), color.g(), eye.z());
    CHECK(color.r() > 60.0f); // the traced red; OSG draws green
    CHECK(color.g() < 30.0f);
}

TEST_CASE("proxies: a pick finds what OSG draws once", "[gl]")
{
    Stage stage;
    StageView view(stage);
    view.viewer.frames(1);
    const auto hits = [&](osgUtil::LineSegmentIntersector* segment)
    {
        osgUtil::IntersectionVisitor visitor(segment);
        stage.scene->accept(visitor);
        std::vector<const osg::Drawable*> drawables;
        for (const auto& hit : segment->getIntersections())
            drawables.push_back(hit.drawable);
        return drawables;
    };
    const osg::Vec3d start = kBox + osg::Vec3d(0.1, 0.2, 5.0), end = start - osg::Vec3d(0, 0, 9);
    const bool visibleOnly = GENERATE(false, true);
    const osg::ref_ptr<RayIntersector> ray = new RayIntersector(start, end);
    ray->setVisibleOnly(visibleOnly);
    ray->setIntersectionLimit(osgUtil::Intersector::NO_LIMIT);
    const osg::ref_ptr<osgUtil::LineSegmentIntersector> segment =
        new osgUtil::LineSegmentIntersector(start, end);
    const auto found = hits(ray), wanted = hits(segment);
    CHECK(found.size() == 3); // the box twice, the floor
    CHECK(found == wanted);
}
