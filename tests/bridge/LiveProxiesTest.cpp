// LiveProxiesTest.cpp - proxies of what OSG draws follow the edits of a scene. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osgRayTrace/RayTracedScene>

#include <osg/Depth>
#include <osg/LOD>
#include <osg/Program>
#include <osg/ShapeDrawable>
#include <osg/observer_ptr>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/MorphTransformHardware>

#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

const char* const kProxy = "traced.proxy";

void addProgram(osg::Node& node)
{
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() {}"));
    node.getOrCreateStateSet()->setAttributeAndModes(program);
}

/// Draws a triangle that it tells to functors.
struct Sail : osg::Drawable
{
    META_Node(test, Sail)
    Sail() { setUseDisplayList(false); }
    Sail(const Sail& other, const osg::CopyOp& copy) : osg::Drawable(other, copy) {}

    bool supports(const osg::PrimitiveFunctor&) const override { return true; }
    void accept(osg::PrimitiveFunctor& functor) const override
    {
        functor.setVertexArray(3, corners);
        functor.drawArrays(GL_TRIANGLES, 0, 3);
    }
    osg::BoundingBox computeBoundingBox() const override { return {0, 0, 0, 2, 2, 2}; }
    void drawImplementation(osg::RenderInfo&) const override {}

    osg::Vec3 corners[3] = {{0.2f, 0.2f, 1.0f}, {1.0f, 0.2f, 1.0f}, {0.2f, 1.0f, 1.0f}};
};

/// Returns a morph that OpenGL would pose, of an object of the graph.
osg::ref_ptr<osgAnimation::MorphGeometry> newMorph(LiveGraph& graph)
{
    const osg::ref_ptr<osgAnimation::MorphGeometry> morph =
        new osgAnimation::MorphGeometry(graph.geometry(0));
    morph->setVertexArray(osg::clone(morph->getVertexArray(), osg::CopyOp::DEEP_COPY_ALL));
    morph->addMorphTarget(&graph.geometry(1), 0.5f);
    morph->setMorphTransformImplementation(new osgAnimation::MorphTransformHardware);
    return morph;
}

} // namespace

TEST_CASE("proxies: follow edits of a live scene", "[bridge]")
{
    LiveGraph graph;
    addProgram(*graph.objects[2]);
    LiveView view(graph.root);
    const auto proxies = [&] { return view.statistics().conversion.at(kProxy); };
    REQUIRE(proxies() == 1);
    const uint64_t before = view.statistics().conversions;

    graph.objects[2]->setMatrix(osg::Matrixd::translate(0.4, 0.3, 1.0)); // casts a shadow now
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    graph.deform(2, 0.3f);
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    CHECK(view.statistics().conversions == before); // both were done alone

    RayTracedScene::setHint(graph.objects[2], RayTracedScene::RASTERIZE_ONLY);
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    CHECK(view.statistics().conversion.count(kProxy) == 0);
    RayTracedScene::setHint(graph.objects[2], RayTracedScene::AUTOMATIC);
    view.update();
    CHECK(proxies() == 1);

    const osg::ref_ptr<osg::Depth> depth = new osg::Depth;
    graph.objects[2]->getStateSet()->setAttribute(depth);
    view.update();
    CHECK(proxies() == 1);
    depth->setWriteMask(false);
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    CHECK(view.statistics().conversion.count(kProxy) == 0);
    depth->setWriteMask(true);
    graph.objects[2]->getStateSet()->setRenderBinDetails(1, "RenderBin");
    view.update();
    CHECK(proxies() == 1);
    graph.objects[2]->getStateSet()->setBinNumber(-1);
    view.update();
    CHECK(view.statistics().conversion.count(kProxy) == 0);

    graph.objects[2]->getStateSet()->removeAttribute(osg::StateAttribute::PROGRAM);
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    graph.root->removeChild(graph.group);
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
}

TEST_CASE("proxies: a drawable that tells other triangles casts another shadow", "[bridge]")
{
    LiveGraph graph;
    const osg::ref_ptr<osg::Group> holder = GENERATE(false, true) ? new osg::LOD : new osg::Group;
    const osg::ref_ptr<Sail> sail = new Sail;
    sail->setDataVariance(osg::Object::DYNAMIC); // its triangles are looked at
    holder->addChild(sail);
    if (auto* levels = dynamic_cast<osg::LOD*>(holder.get())) levels->setRange(0, 0.0f, 1e6f);
    graph.root->addChild(holder);
    LiveView view(graph.root);
    REQUIRE(view.statistics().conversion.at(kProxy) == 1);
    for (const float reach : {1.5f, 0.7f, 1.9f})
    {
        const std::vector<float> before = view.image();
        sail->corners[1].x() = sail->corners[2].y() = reach;
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
        CHECK(differentPixels(view.lastImage(), before) > kRoundedPixels);
        CAPTURE(view.statistics().lastConversionReason);
        CHECK(view.statistics().conversions == 1);
    }
}

TEST_CASE("proxies: drawables of a page that expires are let go of without a conversion",
          "[bridge]")
{
    LiveGraph graph;
    const bool posed = GENERATE(false, true);
    CAPTURE(posed);
    const auto newPage = [&]
    {
        const osg::ref_ptr<osg::MatrixTransform> page = new osg::MatrixTransform;
        page->setMatrix(osg::Matrixd::translate(0.5, 0.4, 0.9));
        page->addChild(posed ? osg::ref_ptr<osg::Node>(newMorph(graph)) : new Sail);
        return page;
    };
    const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->addChild(newPage(), 0.0f, 1e6f);
    graph.root->addChild(levels);
    LiveView view(graph.root);
    std::vector<osg::observer_ptr<osg::Node>> gone;
    for (int page = 0; page < 3; ++page)
    {
        gone.push_back(levels->getChild(0)->asGroup()->getChild(0));
        levels->setChild(0, newPage());
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    }
    graph.objects[4]->setMatrix(osg::Matrixd::translate(1.0, 1.0, 0.3));
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    CAPTURE(view.statistics().lastConversionReason);
    CHECK(view.statistics().conversions == 1);
    for (const osg::observer_ptr<osg::Node>& drawable : gone)
        CHECK(!drawable.valid());
}

TEST_CASE("proxies: a dome has one again once something is outside", "[bridge]")
{
    LiveGraph graph;
    graph.light->getLight()->setPosition(osg::Vec4(0.3f, 0.2f, 1.0f, 0.0f));
    const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    const osg::ref_ptr<osg::ShapeDrawable> dome =
        new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(1.0f, 0.5f, 0.0f), 8.0f));
    addProgram(*dome);
    place->addChild(dome);
    const osg::ref_ptr<osg::Group> holder = GENERATE(false, true) ? new osg::LOD : new osg::Group;
    holder->addChild(place);
    if (auto* levels = dynamic_cast<osg::LOD*>(holder.get())) levels->setRange(0, 0.0f, 1e6f);
    graph.root->addChild(holder);
    LiveView view(graph.root);
    const auto check = [&](uint64_t proxies, uint64_t conversions)
    {
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
        CHECK(view.statistics().conversion.count(kProxy) == proxies);
        CAPTURE(view.statistics().lastConversionReason);
        CHECK(view.statistics().conversions == conversions);
    };
    check(0, 1);
    const auto moveDome = [&](double x) { place->setMatrix(osg::Matrixd::translate(x, 0, 0)); };
    for (const double x : {0.5, 1.0}) // as skies follow the eye
    {
        moveDome(x);
        check(0, 1);
    }
    graph.objects[4]->setMatrix(osg::Matrixd::translate(30, 1, 0.1));
    check(1, 2);
    CHECK(view.statistics().lastConversionReason == textOf(ConversionCause::Enclosure));
    for (const double x : {31.0, 29.0})
    {
        moveDome(0.05 * x);
        graph.objects[4]->setMatrix(osg::Matrixd::translate(x, 1, 0.1));
        check(1, 2);
    }
    graph.objects[4]->setMatrix(osg::Matrixd::translate(1, 1, 0.1));
    check(0, 3);
    moveDome(9.0);
    check(1, 4);
    moveDome(1.0);
    check(0, 5);
    // Its first corner is in the box around the dome, and the other one is not.
    graph.objects[4]->setMatrix(osg::Matrixd::translate(11.4, 1, 0.1));
    check(1, 6);
}
