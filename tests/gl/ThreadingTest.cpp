// ThreadingTest.cpp - all of osgViewer's threading models, several contexts. Layer: tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/Geometry>
#include <osg/Material>
#include <osg/MatrixTransform>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

const osg::Vec4 kGreen(0.0f, 1.0f, 0.0f, 1.0f);
constexpr int kSize = 48;

osg::ref_ptr<FrameCapture> addCamera(osgViewer::Viewer& viewer, const osg::Matrixd& viewOffset)
{
    osg::ref_ptr<osg::GraphicsContext> context = createOSMesaContext(kSize, kSize);
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    osg::ref_ptr<FrameCapture> capture = new FrameCapture;
    camera->setGraphicsContext(context.get());
    camera->setViewport(0, 0, kSize, kSize);
    camera->addFinalDrawCallback(capture.get());
    viewer.addSlave(camera.get(), osg::Matrixd(), viewOffset);
    return capture;
}

/// Makes changes of all kinds as an application does: in callbacks of the update traversal, with
/// DataVariance DYNAMIC.
class EditAll : public osg::NodeCallback
{
public:
    explicit EditAll(osg::Group* root) : _spare(sphere(osg::Vec3(1.0f, 1.0f, -2.0f), 0.3f, kGreen))
    {
        _moving->setDataVariance(osg::Object::DYNAMIC);
        _moving->addChild(sphere(osg::Vec3(-1.5f, 0.0f, -2.0f), 0.3f, kGreen));
        _deforming->setDataVariance(osg::Object::DYNAMIC);
        _deforming->getVertexArray()->setDataVariance(osg::Object::DYNAMIC);
        _material->setDataVariance(osg::Object::DYNAMIC);
        osg::StateSet* state = _moving->getOrCreateStateSet();
        state->setDataVariance(osg::Object::DYNAMIC);
        state->setAttributeAndModes(_material);
        root->addChild(_moving);
        root->addChild(_deforming);
    }

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        osg::Group& root = *node->asGroup();
        const int frame = ++_frame;
        _moving->setMatrix(osg::Matrixd::translate(0.02 * frame, 0.0, 0.0));
        auto& vertices = static_cast<osg::Vec3Array&>(*_deforming->getVertexArray());
        for (osg::Vec3& v : vertices)
            v.z() = -2.0f + 0.1f * float((frame + int(10.0f * v.x())) % 5);
        vertices.dirty();
        if (frame % 3 == 0)
            _material->setDiffuse(osg::Material::FRONT_AND_BACK,
                                  osg::Vec4(0.1f * float(frame % 10), 0.5f, 0.5f, 1.0f));
        if (frame % 8 == 4) root.addChild(_spare);
        if (frame % 8 == 0) root.removeChild(_spare);
        traverse(node, visitor);
    }

private:
    osg::ref_ptr<osg::MatrixTransform> _moving = new osg::MatrixTransform;
    osg::ref_ptr<osg::Geometry> _deforming = osg::createTexturedQuadGeometry(
        osg::Vec3(-2.0f, -2.0f, -2.0f), osg::Vec3(1.0f, 0.0f, 0.0f), osg::Vec3(0.0f, 1.0f, 0.0f));
    osg::ref_ptr<osg::Material> _material = new osg::Material;
    osg::ref_ptr<osg::Node> _spare;
    int _frame = 0;
};

} // namespace

TEST_CASE("threading: 50 frames of a moving scene in three contexts", "[gl]")
{
    const auto model = GENERATE(osgViewer::ViewerBase::SingleThreaded,
                                osgViewer::ViewerBase::CullDrawThreadPerContext,
                                osgViewer::ViewerBase::DrawThreadPerContext,
                                osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext);
    osg::ref_ptr<osg::MatrixTransform> moving = new osg::MatrixTransform;
    moving->setDataVariance(osg::Object::DYNAMIC);
    moving->addChild(unlitSquare(1.0f, kGreen));
    osg::ref_ptr<RayTracedScene> scene = tracedScene(moving.get());
    scene->addChild(sphere(osg::Vec3(0.0f, 0.0f, -3.0f), 0.5f, osg::Vec4(1, 1, 1, 1)));
    osg::ref_ptr<osg::Group> edited = new osg::Group;
    edited->setDataVariance(osg::Object::DYNAMIC);
    edited->setUpdateCallback(new EditAll(edited.get()));
    scene->addChild(edited);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(scene);

    osgViewer::Viewer viewer;
    viewer.getCamera()->setProjectionMatrixAsPerspective(40.0, 1.0, 1.0, 100.0);
    viewer.getCamera()->setViewMatrixAsLookAt(osg::Vec3d(0, 0, 10), osg::Vec3d(),
                                              osg::Vec3d(0, 1, 0));
    const osg::ref_ptr<FrameCapture> captures[] = {
        addCamera(viewer, osg::Matrixd()), addCamera(viewer, osg::Matrixd::rotate(0.1, 0, 1, 0)),
        addCamera(viewer, osg::Matrixd::rotate(-0.1, 0, 1, 0))};
    viewer.setThreadingModel(model);
    viewer.setSceneData(root.get());
    viewer.realize();
    for (int i = 0; i < 50; ++i)
    {
        moving->setMatrix(osg::Matrix::translate(i % 2 ? 0.0 : 50.0, 0.0, 0.0));
        if (i == 20) scene->setEnabled(false);
        if (i == 30) scene->setEnabled(true);
        viewer.frame();
    }
    const bool traced = scene->getDrawable()->getStatistics().ok;
    viewer.stopThreading();

    CHECK(traced);
    for (const osg::ref_ptr<FrameCapture>& capture : captures)
    {
        int green = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x)
                green += pixel(*capture->getColorImage(), x, y) == osg::Vec4(0, 255, 0, 255);
        CHECK(green > 50);
    }
    const Statistics statistics = scene->getDrawable()->getStatistics();
    CHECK(statistics.passes >= 1);
    CHECK(statistics.patches > 10); // nodes that come and go are patched, too
    CHECK(statistics.conversions >= 1);
    CHECK(statistics.refitMeshes > 5);
}
