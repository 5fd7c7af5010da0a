// LiveSceneTest.cpp - what is redone for each kind of edit, and that the picture is that of a fresh
// conversion.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/update/RenderOptionsFromSettings.h"
#include "osgRayTrace/session/history/SceneChange.h"
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osg/LOD>
#include <osg/LightSource>
#include <osg/PositionAttitudeTransform>
#include <osg/Switch>

#include <functional>
#include <optional>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

/// Counts what an update did: one walk and nothing else, unless a function says more. Whole counts
/// are compared, because an edit must not make anything else be redone.
struct Done
{
    uint64_t walks = 1, conversions = 0, patches = 0, meshes = 0, built = 0, refit = 0, flat = 0,
             commits = 0;

    Done& convertedMeshes(uint64_t count) { return meshes = count, *this; }
    Done& builtMeshes(uint64_t count) { return built = count, *this; }
    Done& refitMeshes(uint64_t count) { return refit = count, *this; }
    Done& staticBuilds(uint64_t count) { return flat = count, *this; }
    Done& embreeCommits(uint64_t count) { return commits = count, *this; }
};

Done nothing()
{
    return {};
}

Done patched()
{
    Done done;
    done.patches = 1;
    return done;
}

bool operator==(const Done& a, const Done& b)
{
    return a.walks == b.walks && a.conversions == b.conversions && a.patches == b.patches &&
           a.meshes == b.meshes && a.built == b.built && a.refit == b.refit && a.flat == b.flat &&
           a.commits == b.commits;
}

std::ostream& operator<<(std::ostream& stream, const Done& d)
{
    return stream << "walks " << d.walks << " conversions " << d.conversions << " patches "
                  << d.patches << " meshes " << d.meshes << " built " << d.built << " refit "
                  << d.refit << " flat " << d.flat << " commits " << d.commits;
}

/// Updates the view, and checks that its image is that of a scene that was never another.
Done updateOf(LiveView& view, const osg::Node& root)
{
    const Statistics a = view.statistics();
    view.update();
    const Statistics b = view.statistics();
    CHECK(b.ok);
    const std::vector<float> image = view.image();
    const int different = differentPixels(image, freshImage(root, view.passes()));
    CHECK(different >= 0);
    CHECK(different <= kRoundedPixels);
    return {b.walks - a.walks,
            b.conversions - a.conversions,
            b.patches - a.patches,
            b.convertedMeshes - a.convertedMeshes,
            b.builtMeshes - a.builtMeshes,
            b.refitMeshes - a.refitMeshes,
            b.staticBuilds - a.staticBuilds,
            b.embreeCommits - a.embreeCommits};
}

} // namespace

TEST_CASE("live scene: nothing is redone for nothing, and the accumulated image goes on",
          "[bridge]")
{
    LiveGraph graph;
    LiveView view(graph.root.get());
    (void)updateOf(view, *graph.root);
    const auto scene = view.scene();
    const int passes = view.passes();
    CHECK(updateOf(view, *graph.root) == nothing());

    // Neither for what no ray meets: hidden nodes, bits of masks that hide nothing, a camera that
    // moves.
    graph.hidden->setMatrix(osg::Matrixd::translate(1.0, 2.0, 3.0));
    graph.objects[0]->setNodeMask(0x7fffffffu);
    graph.objects[1]->setMatrix(graph.objects[1]->getMatrix());
    view.recordEye(osg::Vec3d(1.3, -1.4, 4.1));
    CHECK(updateOf(view, *graph.root) == nothing());
    CHECK(view.scene() == scene);
    CHECK(view.passes() > passes);
}

TEST_CASE("live scene: what moves leaves the flat BVH once, then it is an instance", "[bridge]")
{
    LiveGraph graph;
    LiveView view(graph.root.get());
    const auto lift = [&](double z)
    { graph.objects[2]->setMatrix(osg::Matrixd::translate(0.5, 1.0, z)); };

    lift(0.25);
    // The mesh in its own coordinates; its BVH, the one without it, and the top level.
    CHECK(updateOf(view, *graph.root) == patched()
                                             .convertedMeshes(1)
                                             .builtMeshes(LiveGraph::kObjects)
                                             .staticBuilds(1)
                                             .embreeCommits(3));
    for (const double z : {0.5, 0.75, 0.25})
    {
        lift(z);
        CHECK(updateOf(view, *graph.root) == patched().embreeCommits(1));
    }
    graph.group->setPosition(osg::Vec3d(0.1, 0.0, 0.0)); // all objects are below it
    const Done all = updateOf(view, *graph.root);
    CHECK(all.patches == 1);
    CHECK(all.meshes == LiveGraph::kObjects - 1);
    graph.group->setPosition(osg::Vec3d(0.2, 0.0, 0.0));
    CHECK(updateOf(view, *graph.root) == patched().embreeCommits(1));
}

TEST_CASE("live scene: vertices that move are refitted in two copies in turn", "[bridge]")
{
    LiveGraph graph;
    LiveView view(graph.root.get());
    // Out of the static BVH; a copy for the versions in turn; from then on no mesh is built.
    graph.deform(3, 0.1f);
    CHECK(updateOf(view, *graph.root) == patched()
                                             .convertedMeshes(1)
                                             .builtMeshes(LiveGraph::kObjects)
                                             .staticBuilds(1)
                                             .embreeCommits(3));
    graph.deform(3, 0.2f);
    CHECK(updateOf(view, *graph.root).built <= 1);
    graph.deform(3, 0.3f);
    CHECK(updateOf(view, *graph.root).built <= 1);
    for (const float height : {0.2f, 0.1f, 0.3f, 0.0f})
    {
        graph.deform(3, height);
        CHECK(updateOf(view, *graph.root) ==
              patched().convertedMeshes(1).refitMeshes(1).embreeCommits(2));
    }
}

TEST_CASE("live scene: a BVH that a refit would spoil is built", "[bridge]")
{
    LiveGraph graph;
    LiveView view(graph.root.get());
    for (int i = 0; i < 5; ++i)
    {
        graph.deform(3, 0.05f * float(i));
        view.update();
    }
    graph.shuffle(3); // neighbours part
    CHECK(updateOf(view, *graph.root) ==
          patched().convertedMeshes(1).builtMeshes(1).embreeCommits(2));
}

TEST_CASE("live scene: other triangles make one new mesh", "[bridge]")
{
    LiveGraph graph;
    LiveView view(graph.root.get());
    for (int i = 0; i < 4; ++i)
    {
        graph.deform(3, 0.05f * float(i));
        view.update();
    }
    graph.dropTriangle(3);
    CHECK(updateOf(view, *graph.root) ==
          patched().convertedMeshes(1).builtMeshes(1).embreeCommits(2));
}

TEST_CASE("live scene: materials, lights and textures need no work of Embree's", "[bridge]")
{
    LiveGraph graph;
    LiveView view(graph.root.get());
    SECTION("a material's colour")
    {
        graph.materials[0]->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 0, 0, 1));
        CHECK(updateOf(view, *graph.root) == patched());
    }
    SECTION("another state set")
    {
        graph.objects[0]->setStateSet(graph.objects[1]->getStateSet());
        CHECK(updateOf(view, *graph.root) == patched());
    }
    SECTION("a light")
    {
        graph.light->getLight()->setDiffuse(osg::Vec4(0.1f, 0.9f, 0.2f, 1.0f));
        CHECK(updateOf(view, *graph.root) == patched());
    }
    SECTION("a texture's image")
    {
        graph.paint(200);
        CHECK(updateOf(view, *graph.root) == patched());
    }
}

TEST_CASE("live scene: what is added or removed leaves the other meshes alone", "[bridge]")
{
    LiveGraph graph;
    LiveView view(graph.root.get());
    osg::ref_ptr<osg::MatrixTransform> added = graph.newObject(77, 2.0, 2.0);
    graph.group->insertChild(0, added);
    // A mesh and its BVH, the flat one as it was, the top level.
    CHECK(updateOf(view, *graph.root) ==
          patched().convertedMeshes(1).builtMeshes(1).embreeCommits(2));
    osg::observer_ptr<osg::Geometry> gone = added->getChild(0)->asGeometry();
    osg::observer_ptr<osg::Array> array = gone->getVertexArray();
    graph.group->removeChild(added);
    added = nullptr;
    // The static BVH alone is left.
    CHECK(updateOf(view, *graph.root) == patched());
    CHECK(!gone.valid());
    CHECK(!array.valid());
}

TEST_CASE("live scene: switches, levels of detail and nodes of other classes", "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::Switch> choice = new osg::Switch;
    osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    osg::ref_ptr<osg::MatrixTransform> inLevel = graph.newObject(5, 2.5, 0.0);
    choice->addChild(graph.newObject(6, -1.5, 0.0), true);
    levels->addChild(inLevel, 0.0f, 1e6f);
    graph.root->addChild(choice);
    graph.root->addChild(levels);
    LiveView view(graph.root.get());
    (void)updateOf(view, *graph.root);
    choice->setAllChildrenOff();
    CHECK(updateOf(view, *graph.root).patches == 1);
    choice->setAllChildrenOn();
    CHECK(updateOf(view, *graph.root).patches == 1);
    inLevel->setMatrix(osg::Matrixd::translate(2.5, 0.0, 0.5));
    CHECK(updateOf(view, *graph.root).patches == 1);
    inLevel->setMatrix(osg::Matrixd::translate(2.5, 0.0, 0.25));
    CHECK(updateOf(view, *graph.root).built == 0); // an instance by now
    levels->setRange(0, 0.0f, 1e-3f);
    CHECK(updateOf(view, *graph.root).patches == 1);
}

TEST_CASE("live scene: two views of it restart with it, views of another do not", "[bridge]")
{
    LiveGraph graph, other;
    LiveView first(graph.root.get()), unrelated(other.root.get());
    first.update();
    unrelated.update();
    first.image();
    unrelated.image();
    const int passes = unrelated.passes();
    graph.objects[0]->setMatrix(osg::Matrixd::translate(0.0, 0.0, 0.5));
    first.update();
    unrelated.update();
    first.image();
    unrelated.image();
    CHECK(first.passes() == 1);
    CHECK(unrelated.passes() == passes + 1);
}

TEST_CASE("live scene: edits of single objects differ from the last version by these objects",
          "[bridge]")
{
    LiveGraph graph;
    LiveView view(graph.root);
    const auto changeBy = [&](const std::function<void()>& edit)
    {
        const Scene before = *view.scene();
        edit();
        view.update();
        return sceneChange(before, *view.scene());
    };
    const auto changed = [](const std::optional<SceneChange>& change)
    { return change ? static_cast<int>(change->instances.size()) : -1; };
    const auto move = [&] { graph.objects[1]->setMatrix(osg::Matrixd::translate(0.3, 0.2, 0.1)); };
    CHECK(changed(changeBy(move)) == 1); // it leaves the static BVH
    const auto moveOn = [&]
    { graph.objects[1]->setMatrix(osg::Matrixd::translate(0.6, 0.2, 0.1)); };
    CHECK(changed(changeBy(moveOn)) == 1);
    CHECK(changed(changeBy([&] { graph.deform(2, 0.4f); })) == 1);
    const osg::ref_ptr<osg::MatrixTransform> more = graph.newObject(7, 1.0, 1.0);
    CHECK(changed(changeBy([&] { graph.root->addChild(more); })) == 1);
    CHECK(changed(changeBy([&] { graph.root->removeChild(more); })) == 1);
    CHECK(changed(changeBy([] {})) == 0);
    CHECK(changed(changeBy([&] { graph.light->getLight()->setDiffuse(osg::Vec4(1, 0, 0, 1)); })) ==
          -1);
}

TEST_CASE("live scene: views keep what has not changed unless the settings say otherwise",
          "[bridge]")
{
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    ViewInputs inputs;
    setInputs(inputs, *settings);
    CHECK(inputs.keepsUnchanged);
    settings->setKeepUnchanged(false);
    setInputs(inputs, *settings);
    CHECK_FALSE(inputs.keepsUnchanged);
}
