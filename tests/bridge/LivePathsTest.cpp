// LivePathsTest.cpp - nodes that come and go: on which of several paths, how many, and with which
// state. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/BlendFunc>
#include <osg/LOD>
#include <osg/Switch>
#include <osg/TexGenNode>

#include <algorithm>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

/// How an update was made, once its picture is that of a fresh conversion.
struct Made
{
    uint64_t conversions, patches;
};

bool operator==(const Made& a, const Made& b)
{
    return a.conversions == b.conversions && a.patches == b.patches;
}

std::ostream& operator<<(std::ostream& stream, const Made& made)
{
    return stream << "conversions " << made.conversions << " patches " << made.patches;
}

constexpr Made kPatched{0, 1}, kConverted{1, 0};

Made updateOf(LiveView& view, const osg::Node& root)
{
    const Statistics before = view.statistics();
    CHECK(wrongPixels(view, root) <= kRoundedPixels);
    const Statistics after = view.statistics();
    return {after.conversions - before.conversions, after.patches - before.patches};
}

osg::ref_ptr<osg::MatrixTransform> pathTo(osg::Node* node, const osg::Matrixd& matrix)
{
    osg::ref_ptr<osg::MatrixTransform> path = new osg::MatrixTransform(matrix);
    path->addChild(node);
    return path;
}

osg::Matrixd at(double x, double y)
{
    return osg::Matrixd::translate(x, y, 0.2);
}

std::ptrdiff_t meshesWithTriangles(const Scene& scene)
{
    return std::count_if(scene.meshes.begin(), scene.meshes.end(),
                         [](const auto& mesh) { return mesh && !mesh->triangles.empty(); });
}

} // namespace

TEST_CASE("live paths: of several to one tile that one goes that was taken away", "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::MatrixTransform> object = graph.newObject(1, 0.0, 0.0);
    osg::Node* tile = object->getChild(0);
    // Each path has a colour of its own, and all paths are beside each other.
    const auto addPath = [&](osg::Group& parent, const osg::Matrixd& matrix, std::size_t material)
    {
        osg::ref_ptr<osg::MatrixTransform> path = pathTo(tile, matrix);
        path->getOrCreateStateSet()->setAttributeAndModes(graph.materials[material]);
        parent.addChild(path);
        return path;
    };
    osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    const auto addLevels = [&]
    {
        levels->addChild(pathTo(tile, at(2.0, -0.9)), 0.0f, 1e6f);
        graph.root->addChild(levels);
    };
    osg::ref_ptr<osg::MatrixTransform> taken;
    SECTION("another is in a level of detail")
    {
        addLevels();
        taken = addPath(*graph.root, at(0.0, -0.9), 1);
    }
    SECTION("another is in a level of detail, and one more has no place")
    {
        addLevels();
        taken = addPath(*graph.root, at(0.0, -0.9), 1);
        addPath(*graph.root, osg::Matrixd::scale(0.0, 0.0, 1.0), 2);
    }
    SECTION("another before it is left to OpenGL")
    {
        addPath(*graph.root, at(2.0, -0.9), 0)
            ->getStateSet()
            ->setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE));
        taken = addPath(*graph.root, at(0.0, -0.9), 1);
        addPath(*graph.root, at(1.0, -0.9), 2);
    }
    for (int way = 0; way < 3; ++way)
    {
        CAPTURE(way);
        LiveView view(graph.root.get());
        view.image();
        if (way == 0) taken->setMatrix(at(0.1, -1.0));
        if (way == 1) taken->setNodeMask(0);
        if (way == 2)
        {
            taken->setNodeMask(0xffffffffu);
            view.update();
            graph.root->removeChild(taken);
        }
        (void)updateOf(view, *graph.root);
    }
}

TEST_CASE("live paths: what cannot be an instance has no mesh too many, and stays where it is",
          "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::MatrixTransform> placed = graph.newObject(1, 0.0, -0.9);
    // The object is so flat that it cannot be an instance: its mesh is in the coordinates of the
    // scene.
    osg::ref_ptr<osg::MatrixTransform> flat =
        pathTo(placed->getChild(0), osg::Matrixd::scale(1.0, 1.0, 1e-9) * at(2.0, -0.9));
    graph.root->addChild(placed);
    graph.root->addChild(flat);
    LiveView view(graph.root.get());
    view.image();
    CHECK(meshesWithTriangles(*view.scene()) == LiveGraph::kObjects + 2);
    graph.root->removeChild(placed);
    (void)updateOf(view, *graph.root);
    CHECK(meshesWithTriangles(*view.scene()) == LiveGraph::kObjects + 1);
    deformTile(*flat->getChild(0)->asGeometry(), 0.1f); // the mesh keeps its place
    (void)updateOf(view, *graph.root);
    graph.root->removeChild(flat);
    (void)updateOf(view, *graph.root);
    CHECK(meshesWithTriangles(*view.scene()) == LiveGraph::kObjects);
}

TEST_CASE("live paths: so many that come or go that one by one they would take longer convert",
          "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::Switch> few = new osg::Switch, many = new osg::Switch;
    for (int i = 0; i < 100; ++i)
        few->addChild(new osg::Group);
    for (int i = 0; i < 1000; ++i)
        many->addChild(new osg::Group);
    graph.root->addChild(few);
    graph.root->addChild(many);
    LiveView view(graph.root.get());
    view.image();
    few->setAllChildrenOff();
    CHECK(updateOf(view, *graph.root) == kPatched);
    few->setAllChildrenOn();
    CHECK(updateOf(view, *graph.root) == kPatched);
    many->setAllChildrenOff();
    CHECK(updateOf(view, *graph.root) == kConverted);
    many->setAllChildrenOn();
    CHECK(updateOf(view, *graph.root) == kConverted);
    for (unsigned int i = 0; i < many->getNumChildren(); ++i)
        many->getChild(i)->setNodeMask(0);
    CHECK(updateOf(view, *graph.root) == kConverted);
    graph.deform(0, 0.1f); // the whole graph is watched again
    CHECK(updateOf(view, *graph.root) == kPatched);
}

TEST_CASE("live paths: a transform that has lost what only a conversion moves is patched again",
          "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::MatrixTransform> holder = graph.newObject(2, 0.0, -0.9);
    osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->addChild(pathTo(graph.newObject(1, 0.0, 0.0), at(1.0, 0.0)), 0.0f, 1e6f);
    holder->addChild(levels);
    graph.root->addChild(holder);
    LiveView view(graph.root.get());
    view.image();
    holder->setMatrix(at(0.1, -0.9));
    CHECK(updateOf(view, *graph.root) == kPatched);
    holder->removeChild(levels);
    CHECK(updateOf(view, *graph.root) == kConverted);
    holder->setMatrix(at(0.2, -0.9));
    CHECK(updateOf(view, *graph.root) == kPatched);
}

TEST_CASE("live paths: a physical material makes the scene linear, and the last one leaves it",
          "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::MatrixTransform> physical = graph.newObject(2, 0.0, -0.9);
    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setBaseColor(osg::Vec3(0.2f, 0.5f, 0.3f));
    material->setRoughness(0.6f);
    physical->getOrCreateStateSet()->setAttributeAndModes(material);
    LiveView view(graph.root.get());
    view.image();
    CHECK(view.scene()->displayReferred);
    graph.root->addChild(physical);
    (void)updateOf(view, *graph.root);
    CHECK_FALSE(view.scene()->displayReferred);
    graph.root->removeChild(physical);
    (void)updateOf(view, *graph.root);
    CHECK(view.scene()->displayReferred);
}

TEST_CASE("live paths: what comes has the texture coordinates that are generated for all",
          "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::TexGenNode> texGenNode = new osg::TexGenNode;
    texGenNode->getTexGen()->setMode(osg::TexGen::EYE_LINEAR);
    texGenNode->getTexGen()->setPlane(osg::TexGen::S, osg::Plane(1.3, 0.9, 0.0, 0.1));
    texGenNode->getTexGen()->setPlane(osg::TexGen::T, osg::Plane(0.2, 1.1, 0.0, 0.0));
    graph.root->addChild(texGenNode);
    LiveView view(graph.root.get());
    view.image();
    osg::ref_ptr<osg::MatrixTransform> added = graph.newObject(1, 0.0, -0.9); // textured
    added->getStateSet()->setTextureMode(0, GL_TEXTURE_GEN_S, osg::StateAttribute::ON);
    added->getStateSet()->setTextureMode(0, GL_TEXTURE_GEN_T, osg::StateAttribute::ON);
    graph.root->addChild(added);
    CHECK(updateOf(view, *graph.root) == kPatched);
}
