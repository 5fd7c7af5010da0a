// NodesTest.cpp - nodes that depend on the view or belong to other kits, and poses. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/bridge/changes/GraphWatch.h"
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osgRayTrace/RayTracedScene>

#include <osg/AutoTransform>
#include <osg/Billboard>
#include <osg/ClipNode>
#include <osg/ConvexPlanarOccluder>
#include <osg/LOD>
#include <osg/OccluderNode>
#include <osg/OcclusionQueryNode>
#include <osg/PagedLOD>
#include <osg/PrimitiveSetIndirect>
#include <osg/ProxyNode>
#include <osgAnimation/Bone>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/MorphTransformHardware>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/RigTransformHardware>
#include <osgAnimation/Skeleton>
#include <osgFX/Scribe>
#include <osgShadow/ShadowMap>
#include <osgShadow/ShadowedScene>
#include <osgSim/Impostor>
#include <osgSim/LightPointNode>
#include <osgSim/OverlayNode>
#include <osgSim/VisibilityGroup>
#include <osgVolume/VolumeTile>

#include <cmath>

using namespace osgRayTrace::engine;

namespace
{

ConversionInput viewedFrom(osg::Node* root, const osg::Vec3d& eye,
                           const osg::Vec3d& up = osg::Vec3d(0, 0, 1))
{
    ConversionInput input = inputFor(root);
    input.eye = eye;
    input.view = ReferenceView{osg::Matrixd::lookAt(eye, osg::Vec3d(), up),
                               osg::Matrixd::perspective(40.0, 1.0, 1.0, 1000.0), 500.0, 500.0};
    return input;
}

ConversionResult convertFrom(const ConversionInput& input)
{
    SceneConverter converter;
    return converter.convert(input);
}

ViewingConditions conditionsOf(const ConversionInput& input)
{
    ViewingConditions conditions;
    conditions.eye = input.eye;
    conditions.view = input.view;
    return conditions;
}

/// Returns whether the watch of a graph with the node in it has the graph converted again, if the
/// graph is viewed under two conditions and changed in between. Once the change is recorded, the
/// next look must find nothing.
template <class Change>
bool watchSees(osg::Node* node, const ViewingConditions& before, const ViewingConditions& after,
               const Change& change)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrix::rotate(0.3, 1, 0, 0));
    root->addChild(place);
    place->addChild(node);
    GraphWatch watch;
    watch.record(*root, before);
    CHECK(watch.look(*root, before).none());
    change();
    const bool seen = !watch.look(*root, after).none();
    watch.record(*root, after);
    CHECK(watch.look(*root, after).none());
    return seen;
}

constexpr auto kNoChange = [] {};

osg::ref_ptr<osgAnimation::Bone> boneAt(const std::string& name, const osg::Matrix& bound,
                                        const osg::Matrix& posed)
{
    osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(name);
    bone->setInvBindMatrixInSkeletonSpace(osg::Matrix::inverse(bound));
    bone->setMatrixInSkeletonSpace(posed);
    bone->setMatrix(posed);
    return bone;
}

struct Rigged
{
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    osg::ref_ptr<osgAnimation::Bone> bone =
        boneAt("arm", osg::Matrix(), osg::Matrix::translate(0.0, 0.0, 2.0));
    osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;

    explicit Rigged(unsigned int vertices = 3)
    {
        skeleton->addChild(bone);
        rig->setSourceGeometry(triangleGeometry());
        osg::ref_ptr<osgAnimation::VertexInfluenceMap> influences =
            new osgAnimation::VertexInfluenceMap;
        for (unsigned int i = 0; i < vertices; ++i)
            (*influences)["arm"].push_back(osgAnimation::VertexIndexWeight(i, 1.0f));
        rig->setInfluenceMap(influences);
        skeleton->addChild(rig);
    }
};

} // namespace

TEST_CASE("nodes: a billboard of the eye stands upright in the view", "[bridge]")
{
    osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
    billboard->setMode(osg::Billboard::POINT_ROT_EYE);
    billboard->addDrawable(osg::createTexturedQuadGeometry({-1, 0, 0}, {2, 0, 0}, {0, 0, 2}),
                           osg::Vec3());
    const osg::Vec3d up(0.3, 0.9, 0.1);
    const ConversionInput input = viewedFrom(billboard, {5.0, 6.0, 7.0}, up);
    const ConversionResult result = convertFrom(input);
    CHECK(countOf(result, "approximated.billboard") == 0);
    const Mesh& mesh = soleMesh(result);
    for (const Vec3& p : mesh.positions)
    {
        const osg::Vec3d v =
            osg::Matrixd::transform3x3(osg::Vec3d(p.x, p.y, p.z), input.view->viewFromWorld);
        CHECK(std::fabs(std::fabs(v.x()) - 1.0) < 1e-5);
        CHECK((std::fabs(v.y()) < 1e-5 || std::fabs(v.y() - 2.0) < 1e-5));
        CHECK(std::fabs(v.z()) < 1e-5);
    }
    CHECK(countOf(convertGraph(billboard), "approximated.billboard") == 1);
}

TEST_CASE("nodes: levels by size in pixels, with OSG's scale", "[bridge]")
{
    osg::ref_ptr<osg::LOD> lod = new osg::LOD;
    lod->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN);
    lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
    lod->setRadius(1.0f);
    lod->addChild(triangleGeometry(), 0.0f, 50.0f);
    lod->addChild(curveGeometry(4, new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 4)), 50.0f, 1e6f);
    const auto corners = [&](double distance, float scale)
    {
        ConversionInput input = viewedFrom(lod, {0.0, -distance, 0.0});
        input.view->lodScale = scale;
        return soleMesh(convertFrom(input)).positions.size();
    };
    CHECK(corners(5.0, 1.0f) == 4);  // 500 pixels are 3.6 units wide
    CHECK(corners(60.0, 1.0f) == 3); // 500 pixels are 44 units wide
    CHECK(corners(5.0, 20.0f) == 3);

    const auto watched = [&](double distance, float scale)
    {
        ConversionInput input = viewedFrom(lod, {0.0, -distance, 0.0});
        input.view->lodScale = scale;
        return conditionsOf(input);
    };
    CHECK(watchSees(lod, watched(5.0, 1.0f), watched(60.0, 1.0f), kNoChange));
    CHECK(watchSees(lod, watched(5.0, 1.0f), watched(5.0, 20.0f), kNoChange));
    CHECK_FALSE(watchSees(lod, watched(5.0, 1.0f), watched(5.5, 1.0f), kNoChange));
}

TEST_CASE("nodes: what turns to the view or moves with it shows in the hash, other things do not",
          "[bridge]")
{
    const auto changes = [](osg::Node* node)
    {
        const auto hash = [&](const osg::Vec3d& up) {
            return graphHash(*node, conditionsOf(viewedFrom(node, {5.0, 6.0, 7.0}, up)));
        };
        const bool changed = hash({0, 0, 1}) != hash({0, 1, 0});
        const auto upright = [&](const osg::Vec3d& up) {
            return conditionsOf(viewedFrom(node, {5.0, 6.0, 7.0}, up));
        };
        CHECK(watchSees(node, upright({0, 0, 1}), upright({0, 1, 0}), kNoChange) == changed);
        return changed;
    };
    osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
    billboard->addDrawable(triangleGeometry());
    CHECK(changes(billboard));
    osg::ref_ptr<osg::AutoTransform> turning = new osg::AutoTransform;
    turning->setAutoRotateMode(osg::AutoTransform::ROTATE_TO_SCREEN);
    turning->addChild(triangleGeometry());
    CHECK(changes(turning));
    osg::ref_ptr<osg::MatrixTransform> absolute = new osg::MatrixTransform;
    absolute->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    absolute->addChild(triangleGeometry());
    CHECK(changes(absolute));
    osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
    clip->addClipPlane(new osg::ClipPlane(0, 1.0, 0.0, 0.0, 0.0));
    clip->addChild(triangleGeometry());
    CHECK_FALSE(changes(clip));
    clip->setReferenceFrame(osg::ClipNode::ABSOLUTE_RF);
    CHECK(changes(clip));
    CHECK_FALSE(changes(triangleGeometry()));

    osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
    levels->addChild(triangleGeometry(), 0.0f, 10.0f);
    levels->addChild(triangleGeometry(), 10.0f, 1e6f);
    ViewingConditions near, far;
    near.eye.set(0.0, 0.0, 9.0);
    far.eye.set(0.0, 0.0, 11.0);
    CHECK(watchSees(levels, near, far, kNoChange));

    const uint64_t before = graphHash(*clip, ViewingConditions());
    clip->getClipPlane(0)->setClipPlane(1.0, 0.0, 0.0, 0.1);
    CHECK(graphHash(*clip, ViewingConditions()) != before);
    CHECK(
        watchSees(clip, {}, {}, [&] { clip->getClipPlane(0)->setClipPlane(1.0, 0.0, 0.0, 0.2); }));
}

TEST_CASE("nodes: what hides things from a view only hides nothing", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::OccluderNode> occluder = new osg::OccluderNode;
    osg::ref_ptr<osg::ConvexPlanarOccluder> wall = new osg::ConvexPlanarOccluder;
    for (const osg::Vec3& p :
         {osg::Vec3(-9, -1, -9), osg::Vec3(9, -1, -9), osg::Vec3(9, -1, 9), osg::Vec3(-9, -1, 9)})
        wall->getOccluder().add(p);
    occluder->setOccluder(wall);
    occluder->addChild(triangleGeometry());
    root->addChild(occluder);
    osg::ref_ptr<osg::OcclusionQueryNode> query = new osg::OcclusionQueryNode;
    query->addChild(triangleGeometry());
    root->addChild(query);
    struct CullAll : osg::NodeCallback
    {
        void operator()(osg::Node*, osg::NodeVisitor*) override {}
    };
    osg::ref_ptr<osg::Group> culled = new osg::Group;
    culled->setCullCallback(new CullAll); // without a viewer it is not run
    culled->addChild(triangleGeometry());
    root->addChild(culled);
    osg::ref_ptr<osgSim::VisibilityGroup> volume = new osgSim::VisibilityGroup;
    volume->addChild(triangleGeometry());
    root->addChild(volume);
    const ConversionResult result = convertFrom(viewedFrom(root, {0.0, -50.0, 0.0}));
    CHECK(result.scene->instances.size() == 4);
    CHECK(countOf(result, "approximated.cull-traversal") == 1);
    CHECK(countOf(result, "approximated.occluder") == 1);
    // The node is behind the eye.
    CHECK(convertFrom(viewedFrom(root, {0.0, 0.0, 9.0}, {0, 1, 0})).scene->instances.size() == 4);
}

TEST_CASE("nodes: of other kits are traced, or left to OSG and counted", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgSim::Impostor> impostor = new osgSim::Impostor;
    impostor->addChild(triangleGeometry(), 0.0f, 1e6f);
    root->addChild(impostor);
    osg::ref_ptr<osgSim::OverlayNode> overlay = new osgSim::OverlayNode;
    overlay->addChild(triangleGeometry());
    root->addChild(overlay);
    osg::ref_ptr<osgShadow::ShadowedScene> shadowed =
        new osgShadow::ShadowedScene(new osgShadow::ShadowMap);
    shadowed->addChild(triangleGeometry());
    root->addChild(shadowed);
    root->addChild(new osgSim::LightPointNode);
    osg::ref_ptr<osgFX::Scribe> effect = new osgFX::Scribe;
    effect->addChild(triangleGeometry());
    root->addChild(effect);
    root->addChild(new osgVolume::VolumeTile);

    const ConversionResult headless = convertGraph(root);
    CHECK(headless.scene->instances.size() == 4);
    CHECK(countOf(headless, "not-traced.light-points") == 1);
    CHECK(countOf(headless, "approximated.effect") == 1);
    CHECK(countOf(headless, "not-traced.volume") == 1);

    ConversionInput input = inputFor(root);
    input.rasterizesRest = true;
    const ConversionResult viewed = convertFrom(input);
    CHECK(viewed.scene->instances.size() == 3 + 1); // with the effect's child as a proxy
    CHECK(countOf(viewed, "converted.geometry") == 3);
    CHECK(countOf(viewed, "rasterized.effect") == 1);
    CHECK(countOf(viewed, "rasterized.volume") == 1);
    REQUIRE(viewed.rasterized);
    CHECK(viewed.rasterized->size() == 3);

    for (unsigned int i = 0; i < root->getNumChildren(); ++i)
        osgRayTrace::RayTracedScene::setHint(root->getChild(i), osgRayTrace::RayTracedScene::TRACE);
    const ConversionResult hinted = convertFrom(input);
    CHECK(hinted.scene->instances.size() == 4);
    CHECK(countOf(hinted, "approximated.effect") == 1);
    CHECK(countOf(hinted, "rasterized.effect") == 0);
    CHECK(countOf(hinted, "rasterized.volume") == 1);
    CHECK(countOf(hinted, "warned.trace-hint") == 2); // for the light points and the volume
}

TEST_CASE("nodes: a billboard is left to OSG as a whole if anything in it is", "[bridge]")
{
    osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
    osg::ref_ptr<osg::Geometry> special = triangleGeometry();
    billboard->addDrawable(triangleGeometry(), osg::Vec3(1.0f, 0.0f, 0.0f));
    billboard->addDrawable(special, osg::Vec3(2.0f, 0.0f, 0.0f));
    ConversionInput input = viewedFrom(billboard, {0.0, -5.0, 0.0});
    input.rasterizesRest = true;
    const auto partsLeft = [&]
    {
        const ConversionResult result = convertFrom(input);
        const bool whole = countOf(result, "rasterized.billboard") == 1;
        CHECK(countOf(result, "converted.geometry") == (whole ? 0 : 2));
        CHECK(countOf(result, "traced.proxy") == (whole ? 2 : 0));
        return whole ? result.rasterized->size() : 0;
    };
    CHECK(partsLeft() == 0);
    osgRayTrace::RayTracedScene::setHint(special, osgRayTrace::RayTracedScene::RASTERIZE);
    CHECK(partsLeft() == 1);
    osgRayTrace::RayTracedScene::setHint(special, osgRayTrace::RayTracedScene::AUTOMATIC);
    CHECK(partsLeft() == 0);
    special->addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, 2));
    CHECK(partsLeft() == 1);
}

TEST_CASE("nodes: graphs with pages say so", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangleGeometry());
    CHECK_FALSE(convertGraph(root).paged);
    osg::ref_ptr<osg::ProxyNode> proxy = new osg::ProxyNode;
    proxy->setFileName(0, "missing.osgt");
    root->addChild(proxy);
    CHECK(convertGraph(root).paged);
    proxy->addChild(triangleGeometry());
    CHECK_FALSE(convertGraph(root).paged);
    root->addChild(new osg::PagedLOD);
    CHECK(convertGraph(root).paged);
}

TEST_CASE("nodes: draws on the GPU alone are left to OSG, instanced ones are traced", "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::ref_ptr<osg::DrawArraysIndirect> indirect = new osg::DrawArraysIndirect(GL_TRIANGLES);
    osg::ref_ptr<osg::DefaultIndirectCommandDrawArrays> commands =
        new osg::DefaultIndirectCommandDrawArrays;
    commands->push_back(osg::DrawArraysIndirectCommand(3, 1, 0));
    indirect->setIndirectCommandArray(commands);
    geometry->addPrimitiveSet(indirect);
    geometry->getPrimitiveSet(0)->setNumInstances(3);
    ConversionInput input = inputFor(geometry);
    input.rasterizesRest = true;
    const ConversionResult result = convertFrom(input);
    CHECK(soleMesh(result).triangles.size() == 1);
    CHECK(countOf(result, "approximated.instanced-draw") == 1);
    CHECK(countOf(result, "not-traced.indirect-draw") == 1);
    REQUIRE(result.rasterized);
    REQUIRE(result.rasterized->size() == 1);
    CHECK(result.rasterized->front().inPlace->asGeometry()->getNumPrimitiveSets() == 1);
}

TEST_CASE("poses: a rig that the hardware or no update has posed is posed by its bones", "[bridge]")
{
    Rigged scene;
    const bool hardware = GENERATE(true, false);
    if (hardware) scene.rig->setRigTransformImplementation(new osgAnimation::RigTransformHardware);
    const auto moved = [&](const osg::Matrix& matrix)
    {
        scene.bone->setMatrixInSkeletonSpace(matrix);
        scene.bone->setMatrix(matrix);
    };
    SceneConverter converter;
    const ConversionResult first = converter.convert(inputFor(scene.skeleton));
    CHECK(firstCorner(*first.scene, 0) == Vec3(0.0f, 0.0f, 2.0f));
    CHECK(converter.convert(inputFor(scene.skeleton)).scene == first.scene);
    moved(osg::Matrix::translate(1.0, 0.0, 0.0));
    CHECK(firstCorner(*converter.convert(inputFor(scene.skeleton)).scene, 0) ==
          Vec3(1.0f, 0.0f, 0.0f));
    CHECK_FALSE(scene.rig->getVertexArray()); // the application's array is left alone

    // The rig is below a transform between skeleton and rig, and its vertices are in the
    // coordinates of this transform.
    scene.skeleton->removeChild(scene.rig);
    osg::ref_ptr<osg::MatrixTransform> between =
        new osg::MatrixTransform(osg::Matrixd::translate(0.0, 5.0, 0.0));
    between->addChild(scene.rig);
    scene.skeleton->addChild(between);
    moved(osg::Matrix::rotate(osg::PI_2, osg::Vec3d(0, 0, 1)));
    const Vec3 corner = firstCorner(*converter.convert(inputFor(scene.skeleton)).scene, 0);
    CHECK(glm::length(corner - Vec3(-5.0f, 0.0f, 0.0f)) < 1e-5f);
}

TEST_CASE("poses: a rig with weights beyond its vertices is left as it is", "[bridge]")
{
    Rigged scene(900);
    scene.rig->setRigTransformImplementation(new osgAnimation::RigTransformHardware);
    const ConversionResult result = convertGraph(scene.skeleton);
    CHECK(result.scene->instances.empty());
    CHECK(countOf(result, "approximated.hardware-pose") == 1);
    CHECK(countOf(result, "not-traced.no-vertices") == 1);
}

TEST_CASE("poses: a morph of the hardware has the shape of its weights", "[bridge]")
{
    osg::ref_ptr<osgAnimation::MorphGeometry> morph =
        new osgAnimation::MorphGeometry(*triangleGeometry());
    const auto target = triangleGeometry();
    for (osg::Vec3& p : *static_cast<osg::Vec3Array*>(target->getVertexArray()))
        p += osg::Vec3(0.0f, 0.0f, 4.0f);
    morph->addMorphTarget(target, 0.5f);
    morph->setMorphTransformImplementation(new osgAnimation::MorphTransformHardware);
    SceneConverter converter;
    const auto height = [&] { return firstCorner(*converter.convert(inputFor(morph)).scene, 0).z; };
    CHECK(height() == 2.0f);
    const uint64_t before = graphHash(*morph, ViewingConditions());
    morph->setWeight(0, 0.25f);
    CHECK(graphHash(*morph, ViewingConditions()) != before);
    CHECK(watchSees(morph, {}, {}, [&] { morph->setWeight(0, 0.3f); }));
    morph->setWeight(0, 0.25f);
    CHECK(height() == 1.0f);
    CHECK(static_cast<osg::Vec3Array*>(morph->getVertexArray())->front().z() == 0.0f);

    morph->addMorphTarget(curveGeometry(2, new osg::DrawArrays(GL_TRIANGLES, 0, 2)),
                          1.0f); // the array is too short
    CHECK(countOf(converter.convert(inputFor(morph)), "approximated.hardware-pose") == 1);
}
