// ApplicationDrawingTest.cpp - rigs, lights, handles, overlays and media as applications draw them.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "CullNodes.h"
#include "CullView.h"
#include "RawOverlay.h"
#include "tests/Catch.h"

#include <osgRayTrace/Medium>
#include <osgRayTrace/MediumVolume>
#include <osgRayTrace/RayIntersector>

#include <osg/Program>
#include <osg/ValueObject>
#include <osgManipulator/Dragger>

using namespace osgRayTrace;
using namespace osgRayTrace::test;
using namespace application;

namespace
{

/// Returns a lit grey square above the wall, with normals.
osg::ref_ptr<osg::MatrixTransform> litSquare()
{
    const osg::ref_ptr<osg::Geometry> square = plainSquare(0.8f);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.8f, 0.8f, 0.8f, 1.0f));
    square->getOrCreateStateSet()->setAttributeAndModes(material.get());
    square->getStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    return raised(square.get(), 0.5f);
}

/// Returns a camera that draws over the whole picture.
osg::ref_ptr<osg::Camera> hud()
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setRenderOrder(osg::Camera::POST_RENDER);
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setProjectionMatrixAsOrtho2D(-1, 1, -1, 1);
    camera->setClearMask(GL_DEPTH_BUFFER_BIT);
    camera->setAllowEventFocus(false);
    return camera;
}

/// Knows no material, and notes the geometry with a kind that it was asked for.
class SilentHook : public MaterialHook
{
public:
    osg::ref_ptr<PhysicalMaterial> materialFor(const osg::NodePath& path,
                                               const std::vector<const osg::StateSet*>&) override
    {
        std::string kind;
        if (path.back()->getUserValue("kind", kind)) asked = kind + " " + path.back()->getName();
        return nullptr;
    }
    std::string asked;
};

} // namespace

TEST_CASE("application drawing: a rig that chooses its geometry in cull", "[gl][cull]")
{
    const osg::ref_ptr<RigDrawable> rig = new RigDrawable(*unlitSquare(0.8f, kRed));
    const osg::ref_ptr<osg::MatrixTransform> content = raised(rig.get(), 0.5f);
    SECTION("is traced, and at rest once")
    {
        View view(content.get());
        checkPicture(view);
        CHECK(view.count("converted.culled") == 1);
        CHECK(view.count("not-traced.custom-drawable") == 0);
        CHECK(view.count("traced.proxy") == 0);
        view.viewer.frames(2);
        const uint64_t conversions = view.conversions();
        view.viewer.frames(5);
        CHECK(view.conversions() == conversions);
    }
    SECTION("is traced, and at rest once, when a hook is asked in vain")
    {
        const osg::ref_ptr<SilentHook> hook = new SilentHook;
        for (unsigned int frame : {0u, 1u})
        {
            rig->pose(frame).setName("skin");
            rig->pose(frame).setUserValue("kind", std::string("cloth"));
        }
        View view(content.get());
        view.scene->getSettings()->setMaterialHook(hook.get());
        view.viewer.frames(3);
        CHECK(view.count("converted.culled") == 1);
        CHECK(hook->asked == "cloth skin");
        const uint64_t conversions = view.conversions();
        view.viewer.frames(5);
        CHECK(view.conversions() == conversions);
    }
    SECTION("is traced in each of its poses")
    {
        View view(content.get());
        view.viewer.frames(2);
        for (const float shift : {0.4f, -0.5f})
        {
            rig->shift.set(shift, 0.2f, 0.1f);
            checkPicture(view);
            CHECK(view.count("converted.culled") == 1);
        }
        content->setMatrix(osg::Matrix::translate(-0.3, 0.1, 0.8));
        checkPicture(view);
    }
    SECTION("with a program is OSG's")
    {
        const osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(
            osg::Shader::FRAGMENT, "void main() { gl_FragColor = vec4(0.9, 0.1, 0.9, 1.0); }"));
        content->getOrCreateStateSet()->setAttributeAndModes(program.get());
        View view(content.get());
        checkPicture(view);
        CHECK(view.count("not-traced.custom-drawable") == 1);
        CHECK(view.count("converted.culled") == 0);
    }
    SECTION("is found when it begins to draw, and is gone when it ends")
    {
        rig->hidden = true;
        View view(content.get());
        view.viewer.frames(3);
        CHECK(view.count("converted.culled") == 0);
        rig->hidden = false;
        checkPicture(view);
        CHECK(view.count("converted.culled") == 1);
        rig->hidden = true;
        view.viewer.frames(2);
        CHECK(view.count("converted.culled") == 0);
    }
    SECTION("is picked")
    {
        View view(content.get());
        view.viewer.frames(2);
        osg::ref_ptr<RayIntersector> ray =
            new RayIntersector(osg::Vec3d(0.1, 0.2, 5.0), osg::Vec3d(0.1, 0.2, -5.0));
        osgUtil::IntersectionVisitor picks(ray.get());
        view.scene->accept(picks);
        REQUIRE(ray->containsIntersections());
        CHECK(ray->getFirstIntersection().drawable == rig);
    }
}

TEST_CASE("application drawing: lights of a manager, applied in cull", "[gl][cull]")
{
    const osg::ref_ptr<LightManager> manager = new LightManager;
    const osg::ref_ptr<osg::Light> light = new osg::Light(1);
    light->setPosition(osg::Vec4(0.5f, 0.3f, 2.0f, 1.0f));
    light->setDiffuse(kBlue);
    const osg::ref_ptr<osg::Node> source = new osg::Node;
    source->setUpdateCallback(new ManagedLight(*manager, *light));
    manager->addChild(source.get());
    const osg::ref_ptr<osg::MatrixTransform> lit = litSquare();
    lit->setCullCallback(new LightListCallback(*manager));
    manager->addChild(lit.get());
    View view(manager.get());
    checkPicture(view);
    CHECK(view.count("rasterized.pushed-light") == 1);
    CHECK(view.count("rasterized.cull-callback") == 1);
    light->setPosition(osg::Vec4(-0.7f, 0.3f, 1.0f, 1.0f));
    light->setDiffuse(kRed);
    checkPicture(view);
}

TEST_CASE("application drawing: handles for the mouse alone are not seen", "[gl][cull]")
{
    const osg::ref_ptr<osg::Geometry> handle = unlitSquare(0.8f, kRed);
    osgManipulator::setDrawableToAlwaysCull(*handle);
    const osg::ref_ptr<osg::Group> content = new osg::Group;
    const osg::ref_ptr<osg::MatrixTransform> place = raised(handle.get(), 0.5f);
    content->addChild(place.get());
    content->addChild(raised(unlitSquare(0.6f, kBlue).get(), 0.3f));
    View view(content.get());
    checkPicture(view);
    CHECK(view.count("not-traced.mouse-handle") == 1);
    CHECK(view.count("converted.instance") == 2);
    place->setMatrix(osg::Matrix::translate(0.2, 0.1, 0.6));
    checkPicture(view);
    osg::ref_ptr<RayIntersector> ray =
        new RayIntersector(osg::Vec3d(0.5, 0.5, 5.0), osg::Vec3d(0.5, 0.5, -5.0));
    osgUtil::IntersectionVisitor picks(ray.get());
    view.scene->accept(picks);
    REQUIRE(ray->containsIntersections());
    CHECK(ray->getFirstIntersection().drawable == handle);
}

TEST_CASE("application drawing: raw OpenGL over the picture", "[gl][cull]")
{
    const osg::ref_ptr<osg::Group> content = new osg::Group;
    content->addChild(raised(unlitSquare(0.6f, kBlue).get(), 0.5f));
    Setup setup;
    const char* reason = nullptr;
    SECTION("a callback of a camera over the scene")
    {
        const osg::ref_ptr<osg::Camera> camera = hud();
        camera->setPostDrawCallback(new RawDrawCallback);
        content->addChild(camera.get());
        reason = "not-traced.hud-camera";
    }
    SECTION("a drawable without bound below a camera over the scene")
    {
        const osg::ref_ptr<osg::Camera> camera = hud();
        camera->addChild(new RawDrawable);
        content->addChild(camera.get());
        reason = "not-traced.hud-camera";
    }
    SECTION("a drawable without bound in the scene")
    {
        content->addChild(new RawDrawable);
        reason = "not-traced.custom-drawable";
    }
    SECTION("a callback of the view's own camera")
    {
        setup = [](TestViewer& viewer)
        { viewer.camera().setPostDrawCallback(new RawDrawCallback); };
    }
    View view(content.get(), setup);
    checkPicture(view);
    if (reason) CHECK(view.count(reason) == 1);
    CHECK(view.count("converted.instance") == 2);
}

TEST_CASE("cull content: a box of haze below a callback, which nothing draws", "[gl][cull]")
{
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(raised(plainSquare(0.8f).get(), 0.5f));
    group->setCullCallback(new StatePusher(unlitColor(kRed), unlitColor(kRed)));
    const auto triangles = [&]
    {
        View view(group.get());
        view.viewer.frames(3);
        CHECK(view.count("converted.culled") == 1);
        return view.scene->getDrawable()->getStatistics().triangles;
    };
    const auto before = triangles();
    const osg::ref_ptr<Medium> haze = new Medium;
    haze->setScattering({0.1f, 0.1f, 0.1f});
    const osg::ref_ptr<MediumVolume> box = new MediumVolume(haze.get());
    box->setShape(MediumVolume::BOX);
    group->addChild(box.get());
    CHECK(triangles() == before + 12);
}
