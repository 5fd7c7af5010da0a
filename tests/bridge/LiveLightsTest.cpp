// LiveLightsTest.cpp - edits of lights of all kinds and of transforms above them. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/EnvironmentLight>
#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/TracedLight>

#include <osg/LOD>

#include <cstddef>
#include <functional>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

/// Makes edits one after the other. Each edit must be visible, and look as in a fresh conversion.
class Watched
{
public:
    explicit Watched(osg::Node* root) : _root(root), _view(root) { _view.image(); }

    void edit(const char* what, const std::function<void()>& change)
    {
        INFO(what);
        change();
        const std::vector<float> before = _view.lastImage();
        CHECK(wrongPixels(_view, *_root) <= kRoundedPixels);
        CHECK(_view.passes() == 1); // as before: the noise is the same
        CHECK(differentPixels(_view.lastImage(), before) > kRoundedPixels);
    }

    std::size_t lights() const { return _view.scene()->lights.size(); }
    uint64_t conversions() const { return _view.statistics().conversions; }

private:
    osg::ref_ptr<osg::Node> _root;
    LiveView _view;
};

/// Returns an image of the sphere with another colour in each direction.
osg::ref_ptr<osg::Image> sky()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(8, 4, 1, GL_RGB, GL_FLOAT);
    auto* pixel = reinterpret_cast<float*>(image->data());
    for (int i = 0; i < 3 * 8 * 4; ++i)
        pixel[i] = 0.1f + float(i * 29 % 23) / 23.0f;
    return image;
}

} // namespace

TEST_CASE("live lights: one that a transform moves", "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::MatrixTransform> holder = new osg::MatrixTransform;
    graph.root->removeChild(graph.light);
    holder->addChild(graph.light);
    graph.root->addChild(holder);
    Watched watched(graph.root.get());
    watched.edit("moved", [&] { holder->setMatrix(osg::Matrixd::translate(0.0, 3.0, -2.0)); });
    watched.edit("moved on", [&] { holder->setMatrix(osg::Matrixd::translate(2.0, 0.0, -2.0)); });
    watched.edit("in its place",
                 [&] { graph.light->getLight()->setPosition(osg::Vec4(0.0f, 0.0f, 3.0f, 1.0f)); });
}

TEST_CASE("live lights: one that only rays see", "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<TracedLight> lamp = new TracedLight;
    lamp->setPosition(osg::Vec4(2.0f, 0.0f, 2.0f, 1.0f));
    Watched watched(graph.root.get());
    watched.edit("added",
                 [&]
                 {
                     osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
                     source->setLight(lamp);
                     graph.root->addChild(source);
                 });
    watched.edit("moved", [&] { lamp->setPosition(osg::Vec4(0.0f, 1.0f, 2.0f, 1.0f)); });
    watched.edit("dimmed", [&] { lamp->setDiffuse(osg::Vec4(0.2f, 0.1f, 0.2f, 1.0f)); });
}

TEST_CASE("live lights: the places and edges of area lights", "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::MatrixTransform> holder = new osg::MatrixTransform;
    osg::ref_ptr<AreaLight> lamp = new AreaLight;
    lamp->setCorner(osg::Vec3(0.5f, -0.7f, 0.6f)); // within the picture
    lamp->setEdgeU(osg::Vec3(0.5f, 0.0f, 0.0f));
    lamp->setEdgeV(osg::Vec3(0.0f, 0.4f, 0.0f));
    lamp->setTwoSided(true);
    holder->addChild(lamp);
    graph.root->addChild(holder);
    Watched watched(graph.root.get());
    watched.edit("corner", [&] { lamp->setCorner(osg::Vec3(1.1f, -0.5f, 0.7f)); });
    watched.edit("edge", [&] { lamp->setEdgeU(osg::Vec3(0.9f, 0.0f, 0.1f)); });
    watched.edit("other edge", [&] { lamp->setEdgeV(osg::Vec3(0.1f, 0.7f, 0.0f)); });
    watched.edit("radiance", [&] { lamp->setRadiance(osg::Vec3(4.0f, 2.0f, 1.0f)); });
    watched.edit("one side", [&] { lamp->setTwoSided(false); });
    watched.edit("moved", [&] { holder->setMatrix(osg::Matrixd::translate(-0.5, 0.5, 0.0)); });
}

TEST_CASE("live lights: a sky", "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::MatrixTransform> holder = new osg::MatrixTransform;
    osg::ref_ptr<EnvironmentLight> light = new EnvironmentLight(sky());
    holder->addChild(light);
    graph.root->addChild(holder);
    Watched watched(graph.root.get());
    watched.edit("turned", [&] { light->setRotation(osg::Quat(0.7, osg::Vec3d(0.3, 0.1, 1.0))); });
    watched.edit("brighter", [&] { light->setScale(osg::Vec3(1.5f, 2.0f, 0.5f)); });
    watched.edit("pixels",
                 [&]
                 {
                     auto* pixel = reinterpret_cast<float*>(light->getImage()->data());
                     for (int i = 0; i < 8 * 4; ++i)
                         pixel[3 * i] = 0.0f;
                     light->getImage()->dirty();
                 });
    watched.edit("image", [&] { light->setImage(sky()); });
    watched.edit("turned by a transform",
                 [&] { holder->setMatrix(osg::Matrixd::rotate(1.1, 1.0, 0.0, 0.0)); });
    watched.edit("invisible", [&] { light->setVisible(false); });
}

TEST_CASE("live lights: emission below a level of detail", "[bridge]")
{
    LiveGraph graph;
    const osg::ref_ptr<PhysicalMaterial> emitter = new PhysicalMaterial;
    const osg::ref_ptr<osg::MatrixTransform> lamp = graph.newObject(2, 0.0, 0.0);
    lamp->setMatrix(osg::Matrixd::translate(0.4, 0.3, 1.0));
    lamp->getStateSet()->setAttribute(emitter);
    const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->addChild(lamp, 0.0f, 1e6f);
    graph.root->addChild(levels);
    const osg::ref_ptr<osg::MatrixTransform> lit = graph.newObject(1, 0.0, 0.0);
    lit->setMatrix(osg::Matrixd::translate(1.3, 0.55, 0.6));
    levels->addChild(lit, 0.0f, 1e6f);
    const osg::ref_ptr<osg::LightSource> second = new osg::LightSource;
    second->getLight()->setLightNum(1);
    second->getLight()->setPosition(osg::Vec4(1.5f, 1.0f, 2.0f, 1.0f));
    second->getLight()->setDiffuse(osg::Vec4(0.2f, 0.9f, 0.4f, 1.0f));
    graph.root->addChild(second);
    Watched watched(graph.root.get());
    watched.edit("on", [&] { emitter->setEmission(osg::Vec3(4.0f, 2.0f, 1.0f)); });
    CHECK(watched.lights() == 2);
    watched.edit("recoloured", [&] { emitter->setEmission(osg::Vec3(1.0f, 2.0f, 6.0f)); });
    watched.edit("off", [&] { emitter->setEmission(osg::Vec3()); });
    CHECK(watched.lights() == 1);
    watched.edit("a light that one of them enables",
                 [&] { lit->getStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON); });
    CHECK(watched.lights() == 2);
    CHECK(watched.conversions() == 1);
}
